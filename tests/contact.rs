//! The contact's stiffness, damping and friction are those that were given, once per true contact.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;
use idc_cell::arm::chain::{BodyInertia, Joint, JointKind, KinematicChain};
use idc_cell::control::law::{DriveLimit, JointLaw};
use idc_cell::device::{Device, DeviceParameters, DeviceState, PistonMotion};
use idc_cell::physics::seal_friction::SealFriction;
use idc_cell::plant::{
    ContactParameters, PistonLoad, PlantParameters, Relief, RunningDevice, Touch,
};
use idc_cell::simulation::contact::ContactReading;
use idc_cell::simulation::contact::ToolBall;
use idc_cell::simulation::slide;
use idc_cell::simulation::world::{World, WorldDescription};
use idc_cell::workpiece::{TriangleMesh, load_mesh};

use crate::common::project;

const GRAVITY: f64 = 9.81;
const STEP: f64 = 1e-3;
const BALL: f64 = 0.005;
/// Travel of the vertical slide at which the ball just touches [m].
const TOUCH: f64 = 0.02;

fn slide(kind: JointKind, axis: DVec3, mass: f64, parent_from_joint: DPose3) -> Joint {
    Joint {
        name: "slide".into(),
        kind,
        parent_from_joint,
        axis,
        lower: -1.0,
        upper: 1.0,
        effort: f64::INFINITY,
        velocity: f64::INFINITY,
        damping: 0.0,
        friction: 0.0,
        body: BodyInertia {
            mass,
            centre_of_mass: DVec3::ZERO,
            inertia: DMat3::from_diagonal(DVec3::splat(0.01)),
        },
    }
}

/// Stiffness [N/m], damping [N s/m] and friction [1] of a contact.
#[derive(Clone, Copy)]
struct Law {
    stiffness: f64,
    damping: f64,
    friction: f64,
}

/// A press above the part: a stiff cross slide along x that carries a vertical slide with the ball, on which a force acts and no air to speak of.
struct Press {
    world: World,
    device: Device,
    state: DeviceState,
    plant: PlantParameters,
    relief: Relief,
    touches: Vec<Touch>,
    pressed: Vec<(DVec3, f64)>,
    carried: f64,
    time: f64,
}

impl Press {
    fn new(part: &TriangleMesh, mass: f64, law: Law) -> Self {
        let down = DQuat::from_rotation_x(PI);
        let cross = slide(JointKind::Prismatic, DVec3::X, 20.0, DPose3::IDENTITY);
        let vertical = slide(JointKind::Prismatic, DVec3::Z, mass, DPose3::IDENTITY);
        let chain = KinematicChain {
            joints: vec![cross, vertical],
            tip_from_last: DPose3::IDENTITY,
        };
        let world = World::new(&WorldDescription {
            chain,
            world_from_base: DPose3::from_parts(DVec3::new(0.0, 0.0, BALL + TOUCH), down),
            gravity: DVec3::new(0.0, 0.0, -GRAVITY),
            step: STEP,
            tool: ToolBall {
                radius: BALL,
                centre_in_link: DVec3::ZERO,
            },
            part,
            friction: law.friction,
            most_held: 1,
        });
        // A piston that the air does not feel.
        let device = Device::new(DeviceParameters {
            bore: 1e-5,
            rod: 1e-6,
            moving_mass: mass,
            seal_friction: SealFriction::NONE,
            ..DeviceParameters::default()
        });
        Self {
            state: device.at_rest(TOUCH, 0.0),
            world,
            plant: PlantParameters {
                device: device.parameters().clone(),
                contact: ContactParameters::linear(law.stiffness, law.damping),
                ..PlantParameters::default()
            },
            device,
            relief: Relief::default(),
            touches: Vec::new(),
            pressed: Vec::new(),
            carried: GRAVITY,
            time: 0.0,
        }
    }

    fn put(&mut self, positions: &[f64]) {
        self.world.set_positions(positions);
        self.world.touches(&self.relief, &mut self.touches);
    }

    /// Load on the slide at a stroke [m], without an axial force.
    fn load(&self, stroke: f64) -> PistonLoad<'_> {
        let mass = self.device.parameters().moving_mass;
        let mut load = PistonLoad::new(&self.plant.contact, mass, &self.touches, self.time);
        load.stroke.0[0] = stroke;
        load
    }

    /// One step as the simulation takes it, the cross slide held at a place [m], the vertical one pushed with a force [N].
    fn step(&mut self, cross: f64, force: f64) {
        let mass = self.device.parameters().moving_mass;
        let (stroke, speed) = (self.world.positions()[1], self.world.velocities()[1]);
        let mut load = self.load(stroke);
        load.axial.0[0] = mass * self.carried + force;
        let motion = PistonMotion { stroke, speed };
        let mut device = RunningDevice::new(
            &self.plant,
            Device::new(&self.plant.device),
            (motion, self.state.clone()),
        );
        let mut pressed = Vec::new();
        let moved = slide::advance(&mut device, &load, 0.0, (STEP, 1), &mut pressed);
        self.state = device.state;
        self.pressed = pressed;
        let pushed = moved.device + force;
        let laws = [hold_cross_slide(cross), JointLaw::constant(pushed)];
        self.world.set_laws(&laws);
        self.world.step(&self.pressed, Some(moved.motion));
        let gained = (self.world.velocities()[1] - speed) / STEP;
        self.carried = gained - (pushed - moved.load) / mass;
        self.time += STEP;
        self.world.touches(&self.relief, &mut self.touches);
    }

    /// Penetration of the deepest touch [m] and the sum of the forces now [N].
    fn touched(&self) -> (f64, f64) {
        let motion = PistonMotion {
            stroke: self.world.positions()[1],
            speed: self.world.velocities()[1],
        };
        let force = self.load(motion.stroke).contact_force(0.0, motion);
        let deepest = self.touches.iter().map(|touch| touch.penetration);
        (deepest.fold(f64::NEG_INFINITY, f64::max), force)
    }

    /// Force that the contact carried, by Rapier.
    fn carried_by_rapier(&self) -> ContactReading {
        *self.world.contact()
    }
}

/// The plate with its edge along x at the origin, its bisector up.
fn knife_edge() -> TriangleMesh {
    turned(
        &plate(),
        DPose3::from_rotation(DQuat::from_rotation_x(-FRAC_PI_4)),
    )
}

fn plate() -> TriangleMesh {
    load_mesh(&project("assets/plate.stl"), 1e-3).unwrap()
}

fn turned(mesh: &TriangleMesh, pose: DPose3) -> TriangleMesh {
    let vertices = mesh
        .vertices()
        .iter()
        .map(|&v| pose.transform_point(v))
        .collect();
    TriangleMesh::new(vertices, mesh.triangles().to_vec()).unwrap()
}

/// A flat block whose top at z = 0 is cut into small, uneven triangles.
fn block_of_many_triangles() -> TriangleMesh {
    let (cells, size) = (40, 0.2);
    let at = |i: usize| size * (i as f64 / cells as f64 - 0.5);
    let mut vertices = Vec::new();
    for z in [0.0, -0.02] {
        for i in 0..=cells {
            for j in 0..=cells {
                let inner = i > 0 && i < cells && j > 0 && j < cells;
                let shift = if inner {
                    0.0011 * ((7 * i + 3 * j) as f64).sin()
                } else {
                    0.0
                };
                vertices.push(DVec3::new(at(i) + shift, at(j) - shift, z));
            }
        }
    }
    let row = cells + 1;
    let index = |layer: usize, i: usize, j: usize| (layer * row * row + i * row + j) as u32;
    let mut triangles = Vec::new();
    let mut quad = |a: u32, b: u32, c: u32, d: u32| triangles.extend([[a, b, c], [a, c, d]]);
    for i in 0..cells {
        for j in 0..cells {
            quad(
                index(0, i, j),
                index(0, i + 1, j),
                index(0, i + 1, j + 1),
                index(0, i, j + 1),
            );
            quad(
                index(1, i, j),
                index(1, i, j + 1),
                index(1, i + 1, j + 1),
                index(1, i + 1, j),
            );
        }
        quad(
            index(0, i, 0),
            index(1, i, 0),
            index(1, i + 1, 0),
            index(0, i + 1, 0),
        );
        quad(
            index(0, i + 1, cells),
            index(1, i + 1, cells),
            index(1, i, cells),
            index(0, i, cells),
        );
        quad(
            index(0, 0, i + 1),
            index(1, 0, i + 1),
            index(1, 0, i),
            index(0, 0, i),
        );
        quad(
            index(0, cells, i),
            index(1, cells, i),
            index(1, cells, i + 1),
            index(0, cells, i + 1),
        );
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn hold_cross_slide(position: f64) -> JointLaw {
    JointLaw {
        force: 0.0,
        stiffness: 1e9,
        rest: position,
        damping: 1e5,
    }
}

#[test]
fn a_drive_beyond_its_limit_moves_its_joint_with_the_limit_and_one_within_it_as_its_law_says() {
    let law = Law {
        stiffness: 1e5,
        damping: 100.0,
        friction: 0.0,
    };
    let (wanted, mass) = (0.01, 3.0);
    let speed_of = |effort: f64| {
        let mut press = Press::new(&plate(), mass, law);
        // Away from the part.
        press.put(&[0.0, 0.5 * TOUCH]);
        let losses = JointLaw {
            damping: 40.0,
            ..JointLaw::default()
        };
        let limit = DriveLimit { effort, losses };
        let drive = hold_cross_slide(wanted);
        let total = JointLaw {
            damping: drive.damping + losses.damping,
            ..drive
        };
        press.world.set_limits(&[Some(limit), None]);
        press
            .world
            .set_laws(&[total, JointLaw::constant(-mass * GRAVITY)]);
        press.world.step(&[], None);
        (press.world.velocities()[0], press.world.drive(0))
    };
    // The cross slide of 20 kg carries the vertical one; from rest the losses are small.
    let (speed, (force, cut)) = speed_of(50.0);
    assert_eq!((force, cut), (50.0, true));
    let expected = 50.0 / (20.0 + mass) * STEP;
    assert!((speed / expected - 1.0).abs() < 2e-3, "{speed} {expected}");
    let (free, (force, cut)) = speed_of(f64::INFINITY);
    assert!(!cut && force > 1e4 && free > 10.0 * speed, "{force} {free}");
    // A limit just above what the law takes changes nothing.
    assert_eq!(speed_of(1.01 * force).0, free);
}

/// Presses with `force` beyond the ball's own weight until at rest.
fn settle(press: &mut Press, force: f64, steps: usize) {
    for _ in 0..steps {
        press.step(0.0, force);
    }
}

#[test]
fn static_penetration_is_force_over_stiffness() {
    let contact = Law {
        stiffness: 1.5e5,
        damping: 400.0,
        friction: 0.15,
    };
    let mut worst: f64 = 0.0;
    for mass in [1.0, 4.0] {
        for part in [knife_edge(), block_of_many_triangles()] {
            let mut press = Press::new(&part, mass, contact);
            press.put(&[0.0, TOUCH]);
            for total in [20.0, 60.0, 150.0, 400.0] {
                settle(&mut press, total - mass * GRAVITY, 1500);
                let penetration = press.world.positions()[1] - TOUCH;
                let reading = press.carried_by_rapier();
                let touched = press.touched();
                worst = worst.max((penetration / (total / contact.stiffness) - 1.0).abs());
                assert!(
                    (reading.normal_force / total - 1.0).abs() < 1e-4,
                    "{reading:?}"
                );
                assert!((touched.0 - penetration).abs() < 1e-9, "{touched:?}");
                assert!((touched.1 / total - 1.0).abs() < 1e-6, "{touched:?}");
            }
        }
    }
    println!("static penetration: within {worst:.2e} of F/k");
    assert!(worst < 1e-9, "{worst}");
}

/// Frequency of the ringing after a tap on a loaded contact [Hz], from its zero crossings.
fn ringing(mass: f64, contact: Law, preload: f64) -> f64 {
    let part = knife_edge();
    let mut press = Press::new(&part, mass, contact);
    press.put(&[0.0, TOUCH]);
    settle(&mut press, preload - mass * GRAVITY, 4000);
    let rest = press.world.positions()[1];
    // The tap: 20 N for one step.
    settle(&mut press, preload - mass * GRAVITY + 20.0, 1);
    let (mut crossings, mut before) = (Vec::new(), press.world.positions()[1] - rest);
    for step in 1..400 {
        settle(&mut press, preload - mass * GRAVITY, 1);
        let now = press.world.positions()[1] - rest;
        if before < 0.0 && now >= 0.0 {
            crossings.push(f64::from(step) - now / (now - before));
        }
        before = now;
        if crossings.len() == 4 {
            break;
        }
    }
    assert!(crossings.len() >= 3, "it does not ring: {crossings:?}");
    (crossings.len() - 1) as f64 / (1e-3 * (crossings[crossings.len() - 1] - crossings[0]))
}

#[test]
fn ringing_after_a_tap_has_the_closed_form_frequency() {
    for (mass, stiffness, damping) in [
        (4.0, 1.5e5, 100.0),
        (1.0, 1.5e5, 50.0),
        (4.0, 1e6, 200.0),
        (2.0, 5e4, 40.0),
    ] {
        let contact = Law {
            stiffness,
            damping,
            friction: 0.0,
        };
        let natural = (stiffness / mass).sqrt();
        let ratio = damping / (2.0 * mass * natural);
        let expected = natural * (1.0 - ratio * ratio).sqrt() / TAU;
        let measured = ringing(mass, contact, 100.0);
        println!(
            "ringing at {mass} kg, {stiffness} N/m, {damping} N s/m: {measured:.2} Hz, closed form {expected:.2} Hz"
        );
        assert!(
            (measured / expected - 1.0).abs() < 1e-3,
            "{measured} Hz, expected {expected} Hz"
        );
    }
}

#[test]
fn ringing_decays_as_the_damper_says() {
    // Amplitude falls by exp(-c/(2 m) T) a period; 0.3 s hold about nine periods of 31 Hz.
    let (mass, contact) = (
        4.0,
        Law {
            stiffness: 1.5e5,
            damping: 100.0,
            friction: 0.0,
        },
    );
    let part = knife_edge();
    let mut press = Press::new(&part, mass, contact);
    press.put(&[0.0, TOUCH]);
    settle(&mut press, 100.0 - mass * GRAVITY, 4000);
    let rest = press.world.positions()[1];
    settle(&mut press, 120.0 - mass * GRAVITY, 1);
    let mut swing = [0.0f64; 2];
    for step in 0..250 {
        settle(&mut press, 100.0 - mass * GRAVITY, 1);
        let size = (press.world.positions()[1] - rest).abs();
        if step < 33 {
            swing[0] = swing[0].max(size);
        } else if (196..229).contains(&step) {
            swing[1] = swing[1].max(size);
        }
    }
    // Six periods of 32.6 ms lie between the two windows.
    let natural = (contact.stiffness / mass).sqrt();
    let ratio = contact.damping / (2.0 * mass * natural);
    let period = TAU / (natural * (1.0 - ratio * ratio).sqrt());
    let expected = (-contact.damping / (2.0 * mass) * 6.0 * period).exp();
    assert!(
        (swing[1] / swing[0] / expected - 1.0).abs() < 0.01,
        "{} against {expected}",
        swing[1] / swing[0]
    );
}

/// Drags the pressed ball along x and returns normal and friction forces at each step once it slides.
fn drag(part: &TriangleMesh, friction: f64, speed: f64) -> Vec<(f64, f64, f64)> {
    let contact = Law {
        stiffness: 1.5e5,
        damping: 400.0,
        friction,
    };
    let mass = 4.0;
    let mut press = Press::new(part, mass, contact);
    press.put(&[-0.05, TOUCH]);
    let mut out = Vec::new();
    for step in 0..4000 {
        let along = -0.05 + speed * 1e-3 * (f64::from(step) - 1000.0).max(0.0);
        press.step(along, 150.0 - mass * GRAVITY);
        if step > 1200 {
            let reading = press.carried_by_rapier();
            let friction = reading.friction;
            out.push((reading.normal_force, friction.length(), friction.x));
        }
    }
    out
}

#[test]
fn sliding_over_many_triangles_meets_no_ghosts() {
    for (name, part) in [("block", block_of_many_triangles()), ("edge", knife_edge())] {
        let forces = drag(&part, 0.0, 0.02);
        let worst = forces
            .iter()
            .map(|f| (f.0 - 150.0).abs())
            .fold(0.0, f64::max);
        println!("{name}: largest deviation from 150 N while sliding {worst:.2e} N");
        assert!(worst < 1e-9, "{name}: {worst}");
    }
}

#[test]
fn friction_is_its_coefficient_times_the_normal_force_against_the_motion() {
    for friction in [0.15, 0.4] {
        for (normal, tangential, x) in drag(&block_of_many_triangles(), friction, 0.02) {
            assert!(
                (tangential / normal - friction).abs() < 0.01 * friction,
                "{tangential} of {normal}"
            );
            assert!(x < 0.0, "friction pushes along the motion: {x}");
        }
    }
}

/// A burr is not in the mesh, so a high one on a flat face stands out of the box by which Rapier finds the pair: the engine's margin of 40 mm must cover it.
#[test]
fn a_high_burr_is_met_where_it_begins() {
    let contact = Law {
        stiffness: 1.5e5,
        damping: 400.0,
        friction: 0.0,
    };
    let (part, mass, lift, total) = (block_of_many_triangles(), 4.0, 8e-3, 100.0);
    let mut press = Press::new(&part, mass, contact);
    press.relief.height = lift;
    // Half a millimetre above the burr.
    press.put(&[0.0, TOUCH - lift - 0.5e-3]);
    let mut peak: f64 = 0.0;
    for _ in 0..2000 {
        settle(&mut press, total - mass * GRAVITY, 1);
        peak = peak.max(press.touched().1);
    }
    let penetration = press.world.positions()[1] - (TOUCH - lift);
    assert!(
        (penetration / (total / contact.stiffness) - 1.0).abs() < 1e-3,
        "{penetration} m"
    );
    // Falling 0.5 mm under 100 N onto the spring; a pair found at the mesh, 8 mm too deep, would be pushed out with 1200 N.
    assert!(peak < 400.0, "{peak} N");
}
