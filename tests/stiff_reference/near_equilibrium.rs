//! The orifice law has infinite slope at equal pressures, where explicit methods chatter. At any step of the loop the device's own does not, and it
//! pays no more for that than its sub-steps. (tests/equations/equilibrium.rs does the same with wall heat and a line, and shows that it could fail.)

use std::cell::Cell;

use idc_cell::device::{Device, DeviceParameters, Load, PistonMotion};
use idc_cell::physics::push_only::PushOnly;

use super::usual;

const SET: f64 = 2e5;
const POSITION: f64 = 0.04;
const LOAD: PushOnly = PushOnly {
    stiffness: 1.5e5,
    damping: 400.0,
};
/// Steps of the loop [s].
const STEPS: [f64; 6] = [1e-4, 2.5e-4, 5e-4, 1e-3, 2e-3, 5e-3];

/// The usual device, and one whose air settles within microseconds.
fn devices() -> [(&'static str, DeviceParameters); 2] {
    let small = DeviceParameters {
        dead_volume: 3e-7,
        supply_orifice: 5e-6,
        exhaust_orifice: 5e-6,
        ..usual()
    };
    [("usual", usual()), ("0.3 cm3 and 5 mm2", small)]
}

fn still(stroke: f64) -> PistonMotion {
    PistonMotion { stroke, speed: 0.0 }
}

// Catches: sub-steps too long for the linear part of the law, a linear part that is left out or leads beyond equilibrium.
#[test]
fn pressures_settle_from_one_side_at_every_step_of_the_loop() {
    for (name, parameters) in devices() {
        let device = Device::new(parameters.clone());
        let gas = &parameters.gas;
        let chambers = parameters.chambers();
        let goal = [gas.atmosphere + SET, gas.atmosphere];
        for dt in STEPS {
            for (stroke, off) in [(0.0, -3e4), (0.0, 3e4), (0.05, -3e4), (0.05, 3e4)] {
                let mut state = device.at_rest(stroke, SET);
                state.air.masses =
                    [0, 1].map(|i| gas.mass(goal[i] + off, chambers[i].volume(stroke)));
                let mut last = [off; 2];
                for _ in 0..(1.0 / dt).round() as usize {
                    device.advance(&mut state, SET, still(stroke), dt, 1);
                    let pressures = device.pressures(&state, stroke);
                    for i in 0..2 {
                        let left = pressures[i] - goal[i];
                        // Rounding of the masses: 1e-15 of the pressure, a few times over.
                        let side = left * off > 0.0 || left.abs() < 1e-8;
                        let nearer = left.abs() <= last[i].abs() + 1e-8;
                        assert!(
                            side && nearer,
                            "{name}, {dt} s, {stroke} m: {left:e} after {:e}",
                            last[i]
                        );
                        last[i] = left;
                    }
                }
                assert!(
                    last.iter().all(|left| left.abs() < 1e-6),
                    "{name}, {dt} s: {last:?}"
                );
            }
        }
    }
}

/// A load that counts how often it is asked for its force: four times a sub-step.
struct Counting {
    moving_mass: f64,
    asked: Cell<usize>,
}

impl Load for Counting {
    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, (): &(), motion: PistonMotion, touching: bool) -> f64 {
        self.asked.set(self.asked.get() + 1);
        let push = -LOAD.linear(motion.stroke - POSITION, motion.speed);
        if touching { push } else { 0.0 }
    }

    fn touches(&self, (): &(), motion: PistonMotion) -> bool {
        LOAD.pushes(motion.stroke - POSITION, motion.speed)
    }

    fn rate(&self) -> f64 {
        (LOAD.stiffness / self.moving_mass).sqrt()
    }
}

// Catches: a contact or a flow that changes to and fro in every sub-step, which bisection would make 25 times as dear; sub-steps without bound.
#[test]
fn a_tool_that_presses_costs_the_same_few_substeps_at_every_step_of_the_loop() {
    for ((name, parameters), most) in devices().into_iter().zip([3.0, 8.0]) {
        let device = Device::new(parameters);
        for dt in STEPS {
            let load = Counting {
                moving_mass: device.parameters().moving_mass,
                asked: Cell::new(0),
            };
            let (mut state, mut motion) = (device.at_rest(0.0, 0.0), still(0.0));
            let per_millisecond = |from: f64, to: f64, state: &mut _, motion: &mut _| {
                load.asked.set(0);
                let steps = ((to - from) / dt).round();
                for _ in 0..steps as usize {
                    device.advance_loaded::<_, true>(state, motion, SET, &load, dt, 1);
                }
                load.asked.get() as f64 / 4.0 / ((to - from) * 1e3)
            };
            let all = per_millisecond(0.0, 3.0, &mut state, &mut motion);
            let pressing = per_millisecond(3.0, 4.0, &mut state, &mut motion);
            println!(
                "{name}, steps of {dt} s: {all:.2} sub-steps a millisecond on the way, {pressing:.2} pressing"
            );
            let fewest = 1e-3 / dt;
            assert!(pressing <= fewest.max(most), "{name}, {dt} s: {pressing}");
        }
    }
}
