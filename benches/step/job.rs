//! The job that is timed: the scenario's following phase.

use std::error::Error;
use std::path::Path;
use std::time::{Duration, Instant};

use glam::DVec3;
use idc_cell::arm::chain::MAX_JOINTS;
use idc_cell::arm::dynamics::{inverse_dynamics, mass_matrix};
use idc_cell::arm::kinematics::{jacobian_at, link_poses};
use idc_cell::cell::Cell;
use idc_cell::control::law::JointLaw;
use idc_cell::path::{Phase, Reference};
use idc_cell::plant::Touch;
use idc_cell::plant::{ContactParameters, Relief};
use idc_cell::scenario::{Scenario, load};
use idc_cell::simulation::world::{World, WorldDescription};
use idc_cell::simulation::{Simulation, StepTimes};

/// Time at the start of the following phase that is not timed, so that the motion is under way [s].
const LEAD: f64 = 0.5;

/// A scenario of the project.
pub fn scenario(name: &str) -> Result<Scenario, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios")
        .join(name);
    Ok(load(&path)?)
}

/// The cell of a scenario of the project.
pub fn cell(name: &str) -> Result<Cell, Box<dyn Error>> {
    Ok(Cell::new(scenario(name)?)?)
}

/// When the following phase starts and ends [s].
pub fn follow_span(cell: &Cell) -> (f64, f64) {
    let phases = cell.plan.phases();
    let (_, start, end) = phases
        .into_iter()
        .find(|(phase, ..)| *phase == Phase::Follow)
        .expect("every job follows its edge");
    (start, end)
}

/// A simulation that is always somewhere in its following phase.
pub struct Following<'a> {
    cell: &'a Cell,
    simulation: Simulation<'a>,
    first: usize,
    last: usize,
}

impl<'a> Following<'a> {
    /// Runs up to the following phase.
    pub fn new(cell: &'a Cell) -> Self {
        let step = cell.setup.scenario.simulation.step;
        let (start, end) = follow_span(cell);
        let first = ((start + LEAD) / step).ceil() as usize;
        let last = (end / step).floor() as usize;
        assert!(first < last, "the following phase is too short to be timed");
        let mut following = Self {
            cell,
            simulation: Simulation::new(cell),
            first,
            last,
        };
        following.restart();
        following
    }

    fn restart(&mut self) {
        self.simulation = Simulation::new(self.cell);
        while self.simulation.steps() < self.first {
            self.simulation
                .step()
                .unwrap_or_else(|error| panic!("{error}"));
        }
    }

    /// Time for a number of steps; when the phase runs out the job starts anew, outside of the time.
    pub fn run(&mut self, steps: usize, mut times: Option<&mut StepTimes>) -> Duration {
        let mut spent = Duration::ZERO;
        let mut left = steps;
        while left > 0 {
            if self.simulation.steps() >= self.last {
                self.restart();
            }
            let count = left.min(self.last - self.simulation.steps());
            let clock = Instant::now();
            for _ in 0..count {
                let stepped = self.simulation.step_timed(times.as_deref_mut());
                stepped.unwrap_or_else(|error| panic!("{error}"));
            }
            spent += clock.elapsed();
            left -= count;
        }
        spent
    }
}

/// Constant joint forces with which the reference's motion carries the desired contact force: axes, then the slide [N m, N].
pub fn feed_forward(cell: &Cell, reference: &Reference) -> [f64; MAX_JOINTS] {
    let chain = &cell.setup.arm_with_slide;
    let scenario = &cell.setup.scenario;
    let (count, base) = (chain.len(), scenario.arm.world_from_base);
    let mut position = reference.position;
    position[count - 1] = scenario.process.working_stroke;
    let mut torque = [0.0; MAX_JOINTS];
    inverse_dynamics(
        chain,
        base.rotation,
        scenario.simulation.gravity,
        &position[..count],
        &reference.velocity[..count],
        &reference.acceleration[..count],
        &mut torque[..count],
    );
    let mut links = [glamx::DPose3::IDENTITY; MAX_JOINTS];
    link_poses(chain, base, &position[..count], &mut links[..count]);
    let jacobian = jacobian_at(chain, &links[..count], reference.centre);
    let force = (reference.normal * scenario.process.force).to_array();
    for (joint, torque) in torque.iter_mut().enumerate().take(count) {
        *torque -= (0..3)
            .map(|row| jacobian[(row, joint)] * force[row])
            .sum::<f64>();
    }
    torque
}

/// Stiffness and damping of each axis's servo, as the simulation sets them [N m/rad, N m s/rad].
pub fn servo_gains(cell: &Cell) -> Vec<(f64, f64)> {
    let servo = &cell.setup.scenario.arm.servo;
    let frequency = servo.natural_frequency * std::f64::consts::TAU;
    let chain = &cell.setup.arm_with_slide;
    let mut position = cell.plan.start();
    position.push(cell.setup.scenario.process.working_stroke);
    let mut masses = nalgebra::DMatrix::zeros(chain.len(), chain.len());
    mass_matrix(chain, &position, &mut masses);
    let gains = |inertia: f64| {
        (
            inertia * frequency.powi(2),
            2.0 * servo.damping_ratio * frequency * inertia,
        )
    };
    (0..chain.len() - 1)
        .map(|axis| gains(masses[(axis, axis)]))
        .collect()
}

/// The rigid-body world alone, holding the arm where following is under way; the ball on the edge, or `lift` [m] off it.
pub fn holding_world(cell: &Cell, lift: f64) -> Holding {
    let scenario = &cell.setup.scenario;
    let mut world = World::new(&WorldDescription {
        most_held: 1,
        ..WorldDescription::of(cell)
    });
    let reference = cell.plan.reference(follow_span(cell).0 + LEAD);
    let count = cell.setup.arm_with_slide.len();
    let stroke = scenario.process.working_stroke - lift;
    let mut positions = reference.position[..count].to_vec();
    positions[count - 1] = stroke;
    world.set_positions(&positions);
    let force = feed_forward(cell, &reference);
    let mut laws: Vec<_> = servo_gains(cell)
        .into_iter()
        .enumerate()
        .map(|(axis, (stiffness, damping))| JointLaw {
            force: force[axis],
            stiffness,
            rest: positions[axis],
            damping,
        })
        .collect();
    let slide = if lift > 0.0 {
        let stiffness = scenario.nominal.device.lock_stiffness;
        JointLaw {
            force: 0.0,
            stiffness,
            rest: stroke,
            damping: 0.0,
        }
    } else {
        JointLaw::constant(force[count - 1])
    };
    laws.push(slide);
    let mut holding = Holding {
        world,
        laws,
        contact: cell.setup.actual.contact,
        touches: Vec::new(),
        pressed: Vec::new(),
    };
    for _ in 0..2000 {
        holding.step();
    }
    holding
}

/// A world that is held, its contact a spring and damper at the start of each step.
pub struct Holding {
    world: World,
    laws: Vec<JointLaw>,
    contact: ContactParameters,
    touches: Vec<Touch>,
    pressed: Vec<(DVec3, f64)>,
}

impl Holding {
    pub fn step(&mut self) {
        self.world.touches(&Relief::default(), &mut self.touches);
        let speed = self.world.velocities()[self.laws.len() - 1];
        self.pressed.clear();
        for touch in &self.touches {
            let rate = touch.rate + touch.share * speed;
            let force = self.contact.force(touch.penetration, rate);
            self.pressed.push((touch.normal, force));
        }
        self.world.set_laws(&self.laws);
        self.world.step(&self.pressed, None);
    }

    /// Force of the tool on the part [N].
    pub fn force(&self) -> f64 {
        self.world.contact().normal_force
    }

    /// Depth of the ball in the part [m].
    pub fn penetration(&self) -> f64 {
        let depths = self.touches.iter().map(|touch| touch.penetration);
        depths.fold(f64::NEG_INFINITY, f64::max)
    }
}
