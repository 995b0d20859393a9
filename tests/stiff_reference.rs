//! The loop's integrator against an adaptive stiff solver, in process, on devices for which there is no golden file.
//!
//! The reference is Radau IIA of the crate `differential-equations` on the equations written once more (benches/solver/model.rs): another method, of
//! implicit kind, that chooses its own steps at a relative tolerance of 1e-10. An explicit method of order 8 vouches for it.

use std::f64::consts::PI;

use idc_cell::device::{Device, DeviceParameters, Load, PistonMotion};
use idc_cell::physics::gas::Gas;
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::regulator::RegulatorParameters;
use idc_cell::physics::seal_friction::SealFriction;
use idc_cell::physics::valve::ValvePosition;
use idc_cell::scenario::load_bench;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use legs::{Run, Stepper, Stops, Timetable};
use model::{Model, State};

#[path = "../benches/solver/adaptive.rs"]
#[expect(
    dead_code,
    reason = "shared with the bench, which measures more methods"
)]
mod adaptive;
#[path = "../benches/solver/legs.rs"]
#[expect(
    dead_code,
    reason = "shared with the bench, which also stops every step"
)]
mod legs;
#[path = "../benches/solver/model.rs"]
mod model;

mod dry_seals;
mod near_equilibrium;

/// Requirement: error over full scale [1].
const ASKED: f64 = 1e-4;
/// Allowed differences between the references.
const DOUBT: f64 = 3e-5;
/// Tolerance of the references.
const TOLERANCE: f64 = 1e-10;
const DEVICES: usize = 60;
const STEPS: usize = 600;
const STEP: f64 = 1e-3;
const SUPPLY: f64 = 6e5;

/// A device, gravity along extension [m/s2], a load cell at a position [m], and set pressures: time [s], pressure [Pa gauge].
struct Bench {
    parameters: DeviceParameters,
    gravity: f64,
    position: f64,
    law: PushOnly,
    commands: [(f64, f64); 2],
    /// When the valve reverses [s].
    reverses: f64,
}

/// The device of models/device.toml.
fn usual() -> DeviceParameters {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/paper_step.toml");
    let mut parameters = load_bench(path.as_ref()).unwrap().nominal.0.device;
    parameters.regulator.time_constant = 0.15;
    parameters.regulator.dead_time = 0.02;
    parameters
}

/// A number between two, every order of magnitude alike.
fn between(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low * (high / low).powf(rng.random_range(0.0..1.0))
}

impl Bench {
    fn random(rng: &mut ChaCha8Rng) -> Self {
        let cylinder_count = rng.random_range(1u32..=4);
        let bore = between(rng, 0.012, 0.04);
        let full_stroke = between(rng, 0.02, 0.2);
        let moving_mass = between(rng, 1.0, 20.0);
        let swept = f64::from(cylinder_count) * 0.25 * PI * bore * bore * full_stroke;
        let stop = between(rng, 2e5, 2e6);
        let load = between(rng, 3e4, 5e5);
        // Damping as a share of critical.
        let damped = |stiffness: f64, share: f64| PushOnly {
            stiffness,
            damping: share * 2.0 * (stiffness * moving_mass).sqrt(),
        };
        let parameters = DeviceParameters {
            cylinder_count,
            bore,
            rod: bore * rng.random_range(0.2..0.6),
            full_stroke,
            dead_volume: between(rng, 0.05, 1.0) * swept,
            moving_mass,
            supply_orifice: between(rng, 3e-7, 5e-6),
            exhaust_orifice: between(rng, 3e-7, 5e-6),
            discharge_coefficient: rng.random_range(0.6..1.0),
            regulator: RegulatorParameters {
                gain: rng.random_range(0.9..1.1),
                time_constant: between(rng, 0.02, 0.5),
                dead_time: rng.random_range(0.0..0.03),
                supply: SUPPLY,
                ..RegulatorParameters::default()
            },
            end_stop: damped(stop, rng.random_range(0.2..0.8)),
            seal_friction: SealFriction {
                viscous: f64::from(rng.random_range(0u8..=1)) * between(rng, 1.0, 300.0),
                ..SealFriction::NONE
            },
            gas: Gas::default(),
            gas_process: GasProcess::Isothermal,
            hose: None,
            lock_stiffness: 1e8,
            ..DeviceParameters::default()
        };
        Self {
            gravity: rng.random_range(-9.81..9.81),
            position: full_stroke * rng.random_range(0.2..1.1),
            law: damped(load, rng.random_range(0.1..0.8)),
            commands: [
                (0.01, rng.random_range(0.5e5..SUPPLY)),
                (0.3, rng.random_range(0.0..SUPPLY)),
            ],
            reverses: 0.45,
            parameters,
        }
    }

    fn start(&self) -> PistonMotion {
        let weight = self.parameters.moving_mass * self.gravity;
        PistonMotion {
            stroke: weight.min(0.0) / self.parameters.end_stop.stiffness,
            speed: 0.0,
        }
    }

    fn timetable(&self) -> Timetable {
        let regulator = &self.parameters.regulator;
        let arrival = |(time, set): (f64, f64)| {
            let outlet = (regulator.gain * set).clamp(0.0, regulator.supply);
            (time + regulator.dead_time, outlet)
        };
        Timetable {
            arrivals: self.commands.map(arrival).to_vec(),
            valve: vec![(self.reverses, ValvePosition::Retract)],
            end: STEPS as f64 * STEP,
        }
    }

    /// States at the end of each step by a reference solver.
    fn reference(&self, model: &Model, solver: &mut dyn Stepper) -> Vec<State> {
        let device = Device::new(self.parameters.clone());
        let motion = self.start();
        let masses = device.at_rest(motion.stroke, 0.0).air.masses;
        let samples: Vec<f64> = (1..=STEPS).map(|i| i as f64 * STEP).collect();
        let run = Run {
            model,
            timetable: &self.timetable(),
            start: model.state(&device, masses, motion),
            stops: Stops::Free,
            samples: &samples,
        };
        let mut states = Vec::new();
        run.go(solver, &mut |_, state| states.push(*state));
        states
    }

    /// The same by the loop's integrator.
    fn ours(&self, model: &Model, substeps: usize) -> Vec<State> {
        let device = Device::new(self.parameters.clone());
        let mut motion = self.start();
        let mut state = device.at_rest(motion.stroke, 0.0);
        (0..STEPS)
            .map(|step| {
                let time = step as f64 * STEP;
                let due = |at: f64| at <= time + 1e-9;
                let command = self.commands.iter().rev().find(|command| due(command.0));
                if due(self.reverses) {
                    state.valve = ValvePosition::Retract;
                }
                let set_pressure = command.map_or(0.0, |command| command.1);
                device.advance_loaded::<_, true>(
                    &mut state,
                    &mut motion,
                    set_pressure,
                    self,
                    STEP,
                    substeps,
                );
                model.state(&device, state.air.masses, motion)
            })
            .collect()
    }

    /// Largest difference of pressures, stroke and contact force over full scale; of force what the load cell of the default device has for its area,
    /// or the peak of an impact that would break it.
    fn difference(&self, model: &Model, ours: &[State], reference: &[State]) -> f64 {
        let peak = reference.iter().map(|state| model.load_force(state));
        let force_scale = peak.fold(self.parameters.areas().extending * 3.05e5, f64::max);
        let mut largest = 0.0f64;
        for (ours, reference) in ours.iter().zip(reference) {
            let (p, q) = (model.pressures(ours), model.pressures(reference));
            let stroke = model.motion(ours).stroke - model.motion(reference).stroke;
            let force = model.load_force(ours) - model.load_force(reference);
            let shares = [
                (p[0] - q[0]) / SUPPLY,
                (p[1] - q[1]) / SUPPLY,
                stroke / self.parameters.full_stroke,
                force / force_scale,
            ];
            for share in shares {
                assert!(share.is_finite());
                largest = largest.max(share.abs());
            }
        }
        largest
    }
}

impl Load for Bench {
    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, (): &(), motion: PistonMotion, touching: bool) -> f64 {
        let weight = self.parameters.moving_mass * self.gravity;
        if !touching {
            return weight;
        }
        weight - self.law.linear(motion.stroke - self.position, motion.speed)
    }

    fn touches(&self, (): &(), motion: PistonMotion) -> bool {
        let penetration = motion.stroke - self.position;
        self.law.pushes(penetration, motion.speed)
    }

    fn rate(&self) -> f64 {
        let mass = self.parameters.moving_mass;
        let undamped = (self.law.stiffness / mass).sqrt();
        undamped.max(self.law.damping / mass)
    }
}

// Catches: a wrong force, flow or mode in the loop's integrator for any geometry; sub-steps too long for some; contacts met late.
#[test]
fn sixty_random_devices_move_as_radau_says() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let (mut touched, mut worst, mut finest, mut doubts) = (0, 0.0f64, 0.0f64, 0.0f64);
    for index in 0..DEVICES {
        let bench = Bench::random(&mut rng);
        let load = Some((bench.position, bench.law));
        let model = Model::new(&bench.parameters, bench.gravity, load);
        let radau = bench.reference(&model, &mut *adaptive::radau5(&model, TOLERANCE));
        let explicit = bench.reference(&model, &mut *adaptive::dop853(&model, TOLERANCE));
        assert_eq!((radau.len(), explicit.len()), (STEPS, STEPS));
        let doubt = bench.difference(&model, &explicit, &radau);
        let [error, fine] =
            [2, 16].map(|n| bench.difference(&model, &bench.ours(&model, n), &radau));
        touched += usize::from(radau.iter().any(|state| model.load_force(state) > 0.0));
        println!(
            "{index}: {error:.1e}, {fine:.1e} by 16 sub-steps, {doubt:.1e} between the references"
        );
        worst = worst.max(error);
        finest = finest.max(fine);
        doubts = doubts.max(doubt);
    }
    println!("{touched} touch; {worst:.1e}, {finest:.1e}, {doubts:.1e}");
    assert!(touched > DEVICES / 2);
    assert!(
        doubts < DOUBT && worst < ASKED && finest < DOUBT,
        "{doubts:e} {worst:e} {finest:e}"
    );
}
