//! Near equal pressures the slope of eq. (10) is infinite. Nothing chatters: the flow is linear there, and the sub-steps are short enough for it.

use std::cell::Cell;

use idc_cell::device::{Device, DeviceParameters, Load, PistonMotion};
use idc_cell::physics::gas::Gas;
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::hose::Hose;

use super::devices::{Outside, filled, printed_flow, reached, rt, still, usual, volumes};

const ATMOSPHERE: f64 = 101_325.0;
const SET: f64 = 2e5;

/// Small volumes behind large orifices: 1 kHz and more where the usual device has 100 Hz.
fn nervous() -> DeviceParameters {
    DeviceParameters {
        dead_volume: 3e-7,
        supply_orifice: 5e-6,
        exhaust_orifice: 5e-6,
        ..usual()
    }
}

/// Number of sign changes of a quantity; below `rounding` it has none.
fn sign_changes(values: &[f64], rounding: f64) -> usize {
    let signs = values
        .iter()
        .filter(|v| v.abs() > rounding)
        .map(|v| v.signum());
    let signs: Vec<f64> = signs.collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// Differences of both chambers from where they go [Pa], the piston standing still: by steps [s] that are about the device's longest sub-step, so that
/// each is seen, and then by milliseconds.
fn approach(
    parameters: &DeviceParameters,
    step: f64,
    stroke: f64,
    start: [f64; 2],
    substeps: usize,
) -> [Vec<f64>; 2] {
    let device = Device::new(parameters.clone());
    let mut state = filled(&device, stroke, start, SET);
    let mut differences = [Vec::new(), Vec::new()];
    for index in 0..4000 {
        let [first, second] = device.pressures(&state, stroke);
        differences[0].push(first - (SET + ATMOSPHERE));
        differences[1].push(second - ATMOSPHERE);
        let dt = if index < 3000 { step } else { 1e-3 };
        device.advance(&mut state, SET, still(stroke), dt, substeps);
    }
    differences
}

/// The approach of both chambers by one sub-step and by eight: monotonic, without a change of sign. Returns the largest difference of the two [Pa].
fn check_approach(
    name: &str,
    parameters: &DeviceParameters,
    step: f64,
    stroke: f64,
    start: [f64; 2],
) -> f64 {
    // Below this a pressure of some bar is rounded, in its mass and its volume; and a wall takes seconds to cool the air.
    let rounding = 1e-7;
    let left = match parameters.gas_process {
        GasProcess::Isothermal => rounding,
        GasProcess::WallHeat { .. } => 100.0,
    };
    let mut halving = 0.0f64;
    let coarse = approach(parameters, step, stroke, start, 1);
    let fine = approach(parameters, step, stroke, start, 8);
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert_eq!(sign_changes(coarse, rounding), 0, "{name}, {start:?}");
        let last = coarse.last().unwrap().abs();
        assert!(last < left, "{name}, {start:?}: {last} Pa left");
        let rises = |p: &[f64]| p[1].abs() > p[0].abs() + rounding;
        let rises = coarse.windows(2).filter(|p| rises(p)).count();
        assert_eq!(rises, 0, "{name}, {start:?}: not monotonic");
        for (a, b) in coarse.iter().zip(fine) {
            halving = halving.max((a - b).abs());
        }
    }
    halving
}

// Catches: no linear part, one too short for the sub-step, sub-steps too long for the smallest volume.
#[test]
fn pressures_come_to_rest_without_a_change_of_sign_and_shorter_steps_agree() {
    let hose = Some(Hose::tube(1.0, 0.004, &Gas::default()));
    let heated = GasProcess::WallHeat { conductance: 0.5 };
    for (name, step, most, device) in [
        ("usual", 5e-4, 1e-4, usual()),
        ("0.3 cm3 and 5 mm2", 5e-6, 1e-4, nervous()),
    ] {
        let variants = [
            ("isothermal", device.clone()),
            (
                "with a line",
                DeviceParameters {
                    hose,
                    ..device.clone()
                },
            ),
            (
                "wall heat",
                DeviceParameters {
                    gas_process: heated,
                    ..device
                },
            ),
        ];
        for (variant, parameters) in variants {
            let mut halving = 0.0f64;
            // From below and from above, where chamber 1, or chamber 2, has no more than its dead volume.
            for (stroke, start) in [
                (0.0, [2.7e5, 1.3e5]),
                (0.05, [3.3e5, 0.8e5]),
                (0.0, [1e5, 1e5]),
                (0.05, [7e5, 7e5]),
            ] {
                halving = halving.max(check_approach(name, &parameters, step, stroke, start));
            }
            let what = format!("{name}, {variant}: by one sub-step against eight, of full scale");
            reached(&what, halving / 6e5, most);
        }
    }
}

/// A piston at rest that counts how often it is asked for its force: four times a sub-step.
struct Counting {
    outside: Outside,
    asked: Cell<usize>,
}

impl Load for Counting {
    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, now: &(), motion: PistonMotion, touching: bool) -> f64 {
        self.asked.set(self.asked.get() + 1);
        self.outside.force(now, motion, touching)
    }

    fn touches(&self, now: &(), motion: PistonMotion) -> bool {
        self.outside.touches(now, motion)
    }

    fn rate(&self) -> f64 {
        self.outside.rate()
    }
}

// Catches: a mode that is met and left again in every sub-step, which the bisection would make 25 times as dear; sub-steps without bound.
#[test]
fn a_tool_at_rest_on_its_load_stays_and_costs_no_more_than_its_substeps() {
    for (name, parameters, most) in [
        ("usual", usual(), 3.0),
        ("0.3 cm3 and 5 mm2", nervous(), 200.0),
    ] {
        let device = Device::new(parameters);
        let load = Counting {
            outside: Outside::load_cell(0.04),
            asked: Cell::new(0),
        };
        let (mut state, mut motion) = (device.at_rest(0.0, 0.0), still(0.0));
        let mut strokes = Vec::new();
        let mut flows = Vec::new();
        for ms in 0..5000 {
            if ms == 3000 {
                load.asked.set(0);
            }
            device.advance_loaded::<_, true>(&mut state, &mut motion, SET, &load, 1e-3, 1);
            if ms >= 3000 {
                let last = strokes.last().map_or(motion.stroke, |&(stroke, _)| stroke);
                strokes.push((motion.stroke, motion.stroke - last));
                let outlet = state.regulator.outlet + ATMOSPHERE;
                flows.push(outlet - device.pressures(&state, motion.stroke)[0]);
            }
        }
        let substeps = load.asked.get() as f64 / 4.0 / 2000.0;
        let wander = strokes.iter().map(|s| s.1.abs()).fold(0.0, f64::max);
        println!(
            "{name}: {substeps:.2} sub-steps a millisecond at rest, stroke moves {wander:.1e} m in one"
        );
        assert!(substeps <= most, "{name}: {substeps}");
        assert_eq!(sign_changes(&flows, 1e-8), 0, "{name}");
        assert!(wander < 1e-9, "{name}");
    }
}

/// A chamber on eq. (10), linear above a pressure ratio, by 20 000 explicit Runge-Kutta steps of order four: how often the flow changed its sign from
/// one evaluation to the next, and how far the pressure stays off in the last tenth of the time [Pa].
fn changes_of_a_copy(volume: f64, conductance_area: f64, laminar: f64, h: f64) -> (usize, f64) {
    let outlet = SET + ATMOSPHERE;
    let one_way = |from: f64, to: f64| {
        let u = to / from;
        if u > laminar {
            printed_flow(conductance_area, from, laminar * from) * (1.0 - u) / (1.0 - laminar)
        } else {
            printed_flow(conductance_area, from, to)
        }
    };
    let mut asked_at = Vec::new();
    let mut rate = |p: f64| {
        asked_at.push(outlet - p);
        match p <= outlet {
            true => rt() / volume * one_way(outlet, p),
            false => -rt() / volume * one_way(p, outlet),
        }
    };
    let steps = 20_000;
    let (mut p, mut off) = (outlet - 3e4, 0.0f64);
    for step in 0..steps {
        let k1 = rate(p);
        let k2 = rate(p + 0.5 * h * k1);
        let k3 = rate(p + 0.5 * h * k2);
        let k4 = rate(p + h * k3);
        p += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
        if step > steps - steps / 10 {
            off = off.max((outlet - p).abs());
        }
    }
    (sign_changes(&asked_at, 1e-8), off)
}

// Catches: a test above that could not see chattering: eq. (10) as printed, in the same sub-steps, does.
#[test]
fn eq_10_as_printed_chatters_in_the_same_substeps() {
    for (name, parameters) in [("usual", usual()), ("0.3 cm3 and 5 mm2", nervous())] {
        let volume = volumes(&parameters, 0.0)[0];
        let area = parameters.valve().supply_conductance;
        let slope = printed_flow(area, 1.0, 0.999) / 0.001;
        let longest = 1.2 / (slope * rt() / volume);
        for share in [1.0, 0.5, 0.25] {
            let h = share * longest;
            let (none, rest) = changes_of_a_copy(volume, area, 0.999, h);
            let (many, off) = changes_of_a_copy(volume, area, 1.0, h);
            println!(
                "{name}, sub-steps of {:.1} us: with the linear part {none} changes of the flow's sign, {rest:.1e} Pa off in the end; \
                 without {many}, {off:.1} Pa",
                1e6 * h
            );
            assert!(none == 0 && rest < 1e-8);
            assert!(many > 20_000 && off > 0.1, "{many}, {off}");
        }
    }
}
