//! Seals that bend, break away, slide and reverse, with their bristles as a fifth differential equation:
//!
//! ```text
//! M dv/dt = F - F_c w,   dw/dt = v / z_p (1 - sign(v) F_c w / g(v))              (F_c w is the force; see `physics::seal_friction`)
//! ```
//!
//! The loop's integrator follows the bristles in closed form instead.

use differential_equations::ivp::IVP;
use differential_equations::methods::ImplicitRungeKutta;
use differential_equations::ode::ODE;
use idc_cell::device::{Device, DeviceParameters, Load, PistonMotion};
use idc_cell::physics::seal_friction::SealFriction;
use idc_cell::physics::valve::ValvePosition;

use super::legs::Timetable;
use super::model::{Leg, Model};
use super::{ASKED, STEP, usual};

const SET: f64 = 1.2e5;
const REVERSES: f64 = 0.2;
const END: f64 = 0.45;
const START: f64 = 0.05;

struct Rubbing<'a> {
    model: &'a Model,
    leg: Leg,
    seals: SealFriction,
    moving_mass: f64,
}

impl ODE<f64, [f64; 5]> for Rubbing<'_> {
    fn diff(&self, time: f64, y: &[f64; 5], rates: &mut [f64; 5]) {
        let [m1, m2, x, speed, bent] = *y;
        rates[..4].copy_from_slice(&self.model.rates(&self.leg, time, &[m1, m2, x, speed]));
        let SealFriction {
            coulomb,
            static_force,
            stribeck_velocity,
            presliding_displacement,
            ..
        } = self.seals;
        let stribeck = (-(speed / stribeck_velocity).powi(2)).exp();
        let steady = coulomb + (static_force - coulomb) * stribeck;
        rates[3] -= coulomb * bent / self.moving_mass;
        rates[4] = (speed - speed.abs() * coulomb * bent / steady) / presliding_displacement;
    }
}

/// Nothing but the device on its piston.
struct Free;

impl Load for Free {
    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, (): &(), _: PistonMotion, _: bool) -> f64 {
        0.0
    }

    fn touches(&self, (): &(), _: PistonMotion) -> bool {
        false
    }

    fn rate(&self) -> f64 {
        0.0
    }
}

fn motion_at_start() -> PistonMotion {
    PistonMotion {
        stroke: START,
        speed: 0.0,
    }
}

/// Both pressures [Pa], stroke [m] and the bristles' force [N] after each millisecond.
type Trajectory = Vec<[f64; 4]>;

fn reference(parameters: &DeviceParameters) -> Trajectory {
    let model = &Model::new(parameters, 0.0, None);
    let device = Device::new(parameters.clone());
    let timetable = Timetable {
        arrivals: vec![(parameters.regulator.dead_time, SET)],
        valve: vec![(REVERSES, ValvePosition::Retract)],
        end: END,
    };
    let masses = device.at_rest(START, 0.0).air.masses;
    let [m1, m2, x, speed] = model.state(&device, masses, motion_at_start());
    let mut y = [m1, m2, x, speed, 0.0];
    let mut before: Option<Leg> = None;
    let mut trajectory = Trajectory::new();
    for window in timetable.breaks().windows(2) {
        let start = [y[0], y[1], y[2], y[3]];
        let leg = timetable.leg(model, before.as_ref(), window[0], &start);
        let seals = parameters.seal_friction;
        let moving_mass = parameters.moving_mass;
        let equations = Rubbing {
            model,
            leg,
            seals,
            moving_mass,
        };
        let first = (window[0] / STEP).round() as usize + 1;
        let last = (window[1] / STEP).round() as usize;
        let times: Vec<f64> = (first..=last)
            .map(|i| (i as f64 * STEP).min(window[1]))
            .collect();
        let solution = IVP::ode(&equations, window[0], window[1], y)
            .t_eval(&times)
            .method(
                ImplicitRungeKutta::radau5()
                    .rtol([1e-10; 5])
                    .atol([1e-12; 5])
                    .max_steps(1_000_000),
            )
            .solve()
            .unwrap();
        assert_eq!(solution.y.len(), times.len());
        for y in &solution.y {
            let state = [y[0], y[1], y[2], y[3]];
            let [p1, p2] = model.pressures(&state);
            let stroke = model.motion(&state).stroke;
            trajectory.push([p1, p2, stroke, seals.coulomb * y[4]]);
        }
        y = *solution.y.last().unwrap();
        before = Some(leg);
    }
    trajectory
}

fn ours(parameters: &DeviceParameters, substeps: usize) -> Trajectory {
    let device = Device::new(parameters.clone());
    let (mut state, mut motion) = (device.at_rest(START, 0.0), motion_at_start());
    let step = |index: usize| {
        if index as f64 * STEP >= REVERSES - 1e-9 {
            state.valve = ValvePosition::Retract;
        }
        device.advance_loaded::<_, true>(&mut state, &mut motion, SET, &Free, STEP, substeps);
        let [p1, p2] = device.pressures(&state, motion.stroke);
        let seals = &parameters.seal_friction;
        [
            p1,
            p2,
            motion.stroke,
            seals.force(state.seal_deflection, 0.0),
        ]
    };
    (0..(END / STEP).round() as usize).map(step).collect()
}

// Catches: a wrong branch of the bristles, their state not carried from step to step, a reversal that is met late.
#[test]
fn a_piston_breaks_away_slides_and_reverses_in_its_seals_as_radau_says() {
    for (static_force, viscous) in [(10.0, 0.0), (10.0, 80.0), (16.0, 30.0)] {
        let parameters = DeviceParameters {
            full_stroke: 0.2,
            seal_friction: SealFriction {
                coulomb: 10.0,
                static_force,
                viscous,
                ..SealFriction::NONE
            },
            ..usual()
        };
        let radau = reference(&parameters);
        let farthest = radau.iter().map(|at| at[2]).fold(0.0, f64::max);
        let last = radau.last().unwrap()[2];
        assert!(
            farthest < 0.19 && last < farthest - 0.01 && last > 0.01,
            "{farthest} {last}"
        );
        let bent = |sign: f64| radau.iter().any(|at| sign * at[3] > 9.99);
        assert!(bent(1.0) && bent(-1.0));
        for substeps in [1, 2, 4, 8, 16] {
            let ours = ours(&parameters, substeps);
            assert_eq!(ours.len(), radau.len());
            let mut worst = [0.0f64; 4];
            for (ours, radau) in ours.iter().zip(&radau) {
                for (i, full_scale) in [6e5, 6e5, 0.2, 490.3].into_iter().enumerate() {
                    worst[i] = worst[i].max((ours[i] - radau[i]).abs() / full_scale);
                }
            }
            println!(
                "static {static_force} N, viscous {viscous} N s/m, {substeps} sub-steps: {:.1e}, {:.1e}, {:.1e}, {:.1e}",
                worst[0], worst[1], worst[2], worst[3]
            );
            assert!(worst.iter().all(|error| *error < ASKED), "{worst:?}");
        }
    }
}
