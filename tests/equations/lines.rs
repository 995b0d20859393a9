//! The line between regulator and valve: a tube in the device, and its cost and accuracy whatever its size.

use std::cell::Cell;

use idc_cell::device::{Device, DeviceParameters, Load, PistonMotion};
use idc_cell::physics::gas::Gas;
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::hose::Hose;
use idc_cell::physics::valve::ValvePosition;

use super::devices::{Outside, filled, printed_flow, reached, rt, still, usual, volumes};

const ATMOSPHERE: f64 = 101_325.0;

fn with_tube(length: f64, diameter: f64) -> DeviceParameters {
    DeviceParameters {
        hose: Some(Hose::tube(length, diameter, &Gas::default())),
        ..usual()
    }
}

/// A load that counts how often it is asked for its force: six times a sub-step of a device with a line.
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

/// Runs out onto a load cell at 4 bar, is pulled back and let out again. Chamber pressures over 6 bar and stroke over 50 mm by milliseconds, and the
/// sub-steps that it took for each.
fn trajectory(parameters: &DeviceParameters, substeps: usize) -> (Vec<[f64; 3]>, f64) {
    let device = Device::new(parameters.clone());
    let load = Counting {
        outside: Outside::load_cell(0.04),
        asked: Cell::new(0),
    };
    let (mut state, mut motion) = (device.at_rest(0.0, 0.0), still(0.0));
    let first = state.air.held();
    let mut rows = Vec::new();
    for ms in 0..1400 {
        state.valve = match ms {
            600..1000 => ValvePosition::Retract,
            _ => ValvePosition::Extend,
        };
        device.advance_loaded::<_, true>(&mut state, &mut motion, 4e5, &load, 1e-3, substeps);
        let [one, two] = device.pressures(&state, motion.stroke);
        rows.push([one / 6e5, two / 6e5, motion.stroke / 0.05]);
        let gap = state.air.held() - first - (state.air.entered - state.air.left);
        assert!(gap.abs() < 1e-11 * first, "{ms} ms: {gap:e} kg");
    }
    let asked = load.asked.get() as f64;
    (rows, asked / 6.0 / 1400.0)
}

// Catches: sub-steps that follow a fast line down to nothing; an implicit line that is stable and wrong.
#[test]
fn a_line_of_any_size_is_accurate_in_few_substeps() {
    let heated = GasProcess::WallHeat { conductance: 0.5 };
    let (mut worst, mut dearest) = (0.0f64, 0.0f64);
    for (length, diameter) in [
        (0.001, 0.025),
        (0.01, 0.025),
        (0.1, 0.01),
        (0.1, 0.004),
        (0.3, 0.006),
        (1.0, 0.004),
        (1.0, 0.01),
        (3.0, 0.004),
        (10.0, 0.006),
        (50.0, 0.004),
    ] {
        // The air's own temperature makes no difference that hangs on the line's size.
        let processes = [GasProcess::Isothermal, heated];
        for gas_process in processes
            .into_iter()
            .take(if length == 0.1 { 2 } else { 1 })
        {
            let parameters = DeviceParameters {
                gas_process,
                ..with_tube(length, diameter)
            };
            let (coarse, cost) = trajectory(&parameters, 2);
            let (fine, _) = trajectory(&parameters, 40);
            let off = |i: usize| {
                let pairs = coarse.iter().zip(&fine);
                pairs.map(|(a, b)| (a[i] - b[i]).abs()).fold(0.0, f64::max)
            };
            println!(
                "{length} m x {:.0} mm, {gas_process:?}: {cost:.1} sub-steps a millisecond; pressures off by {:.1e} and {:.1e}, stroke by {:.1e}",
                1e3 * diameter,
                off(0),
                off(1),
                off(2)
            );
            worst = worst.max(off(0)).max(off(1)).max(off(2));
            dearest = dearest.max(cost);
        }
    }
    reached(
        "default sub-steps against forty, of full scale",
        worst,
        1e-4,
    );
    reached("sub-steps of a millisecond", dearest, 6.0);
}

// Catches: half a segment at the wrong end, or a whole one: the end of the line would be late by an eighth.
#[test]
fn a_closed_line_of_evenly_spread_resistance_fills_as_the_heat_equation_says() {
    use std::f64::consts::PI;
    let hose = Hose::evenly_spread(1.2e-4, 8e7);
    let parameters = DeviceParameters {
        hose: Some(hose),
        supply_orifice: 1e-15,
        ..usual()
    };
    let device = Device::new(parameters);
    let gas = device.parameters().gas;
    let (before, start) = (5e5 + ATMOSPHERE, 2e5);
    let mut state = device.at_rest(0.02, 5e5);
    state.air.hose_mass = gas.mass(start, hose.last_volume());
    let upstream = hose.segments() - 1;
    state.air.upstream[..upstream].fill(gas.mass(start, hose.segment_volume()));
    // p = p_0 - (p_0 - p_s) 4/pi sum (-1)^k/(2k + 1) exp(-(2k + 1)^2 pi^2 t/(4 T)),  T = V R_h/(R T_gas)      (Carslaw and Jaeger, 3.3)
    let constant = 1.2e-4 * 8e7 / rt();
    let closed = |time: f64| {
        let term = |k: i32| {
            let odd = f64::from(2 * k + 1);
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            sign / odd * (-(odd * PI).powi(2) * time / (4.0 * constant)).exp()
        };
        let sum: f64 = (0..50).map(term).sum();
        before - (before - start) * 4.0 / PI * sum
    };
    let mut largest = 0.0f64;
    for ms in 1..=300 {
        device.advance(&mut state, 5e5, still(0.02), 1e-3, 2);
        let end = gas.pressure(state.air.hose_mass, hose.last_volume());
        let off = (end - closed(f64::from(ms) * 1e-3)).abs() / (before - start);
        largest = largest.max(off);
    }
    reached("eight segments against the heat equation", largest, 5e-3);
}

// Catches: air lost between segments; segments that exchange it faster than a sub-step and swing; a step of no length that a segment divides by.
#[test]
fn a_line_in_segments_keeps_its_air_and_many_are_one_tube_of_evenly_spread_resistance() {
    let in_segments = |segments| DeviceParameters {
        hose: Some(Hose::in_segments(1.2e-4, 8e7, segments)),
        ..usual()
    };
    let even = DeviceParameters {
        hose: Some(Hose::evenly_spread(1.2e-4, 8e7)),
        ..usual()
    };
    let (coarse, _) = trajectory(&even, 2);
    let (fine, _) = trajectory(&even, 40);
    let apart = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max)
    };
    reached(
        "segments, default sub-steps against forty",
        apart(&coarse, &fine),
        1e-4,
    );
    // The error of lumps falls in proportion to their number: four have a quarter of it.
    let (one, _) = trajectory(&in_segments(1), 2);
    let (four, _) = trajectory(&in_segments(4), 2);
    let (far, near) = (apart(&one, &coarse), apart(&four, &coarse));
    println!("one segment off by {far:.1e}, four by {near:.1e}");
    assert!(
        (3.0..5.0).contains(&(far / near)) && near > 1e-3,
        "{far} {near}"
    );
}

/// Pressure in a chamber of fixed volume and in its line [Pa absolute] at a time [s], by Runge-Kutta of the two equations in microseconds.
fn filled_by_hand(parameters: &DeviceParameters, outlet: f64, start: f64, time: f64) -> [f64; 2] {
    let hose = parameters.hose.unwrap();
    let volume = volumes(parameters, 0.02)[0];
    let area = parameters.valve().supply_conductance;
    let slope = printed_flow(area, 1.0, 0.999) / 0.001;
    let valve = |from: f64, to: f64| match to / from > 0.999 {
        true => slope * (from - to),
        false => printed_flow(area, from, to),
    };
    let rates = |[chamber, line]: [f64; 2]| {
        let on = valve(line, chamber);
        let inward = hose.mass_flow(outlet, line);
        [on * rt() / volume, (inward - on) * rt() / hose.volume]
    };
    let h = 1e-6;
    let mut p = [start; 2];
    for _ in 0..(time / h).round() as usize {
        let at = |k: [f64; 2], share: f64| [p[0] + share * h * k[0], p[1] + share * h * k[1]];
        let k1 = rates(p);
        let k2 = rates(at(k1, 0.5));
        let k3 = rates(at(k2, 0.5));
        let k4 = rates(at(k3, 1.0));
        p = [0, 1].map(|i| p[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    p
}

// Catches: a line whose flow is not the tube's, or that is stepped over; the regulator's outlet jumps, which no regulator does.
#[test]
fn a_chamber_fills_through_a_tube_as_by_hand() {
    let mut largest = 0.0f64;
    for (length, diameter) in [(1.0, 0.004), (3.0, 0.003), (0.3, 0.006)] {
        let parameters = with_tube(length, diameter);
        let device = Device::new(parameters.clone());
        let mut state = filled(&device, 0.02, [2e5, ATMOSPHERE], 5e5);
        state.air.hose_mass = device
            .parameters()
            .gas
            .mass(2e5, parameters.hose.unwrap().volume);
        for ms in 1..=40 {
            device.advance(&mut state, 5e5, still(0.02), 1e-3, 2);
            if ms % 5 == 0 {
                let by_hand =
                    filled_by_hand(&parameters, 5e5 + ATMOSPHERE, 2e5, f64::from(ms) * 1e-3);
                let chamber = device.pressures(&state, 0.02)[0];
                largest = largest.max((chamber - by_hand[0]).abs() / 6e5);
            }
        }
    }
    reached("filling through a tube, of full scale", largest, 1e-4);
}

// Catches: the laminar law at every flow: it would drop a twentieth of this.
#[test]
fn a_tube_into_a_choked_chamber_drops_as_colebrook_says() {
    let parameters = with_tube(2.0, 0.004);
    let area = parameters.valve().supply_conductance;
    let device = Device::new(parameters);
    let before = 6e5 + ATMOSPHERE;
    let mut state = filled(&device, 0.05, [2e4, ATMOSPHERE], 6e5);
    // A dozen time constants of line and drop.
    for _ in 0..95 {
        device.advance(&mut state, 6e5, still(0.05), 1e-3, 2);
    }
    let line = state.air.hose_mass * rt() / device.parameters().hose.unwrap().volume;
    assert!(device.pressures(&state, 0.05)[0] < 0.52 * line, "choked");
    // 1/sqrt(f) = 2 log10(Re sqrt(f)/2.51), by iteration at the choked flow.
    let flow = printed_flow(area, line, 0.0);
    let reynolds = 4.0 * flow / (std::f64::consts::PI * 0.004 * 1.82e-5);
    let mut f: f64 = 0.02;
    for _ in 0..100 {
        f = (2.0 * (reynolds * f.sqrt() / 2.51).log10()).powi(-2);
    }
    let flux = flow / (std::f64::consts::FRAC_PI_4 * 0.004 * 0.004);
    let mean_density = 0.5 * (before + line) / rt();
    let drop = f * 2.0 / 0.004 * flux * flux / (2.0 * mean_density);
    println!(
        "line of 2 m x 4 mm: drop {:.0} Pa at {:.2} g/s, Re {reynolds:.0}, f {f:.4}",
        before - line,
        1e3 * flow
    );
    reached("its drop", ((before - line) / drop - 1.0).abs(), 1e-4);
}

// Catches: a first stage or a solve that a fast line throws off where its equation changes: the valve's reversal, a state from outside.
#[test]
fn a_fast_line_takes_a_jump_of_its_pressure() {
    for (length, diameter) in [(0.001, 0.025), (0.05, 0.01)] {
        let device = Device::new(with_tube(length, diameter));
        for share in [0.1, 0.5, 2.0] {
            let mut state = filled(&device, 0.02, [3e5, ATMOSPHERE], 4e5);
            state.air.hose_mass *= share;
            let capacity = device.parameters().hose.unwrap().volume / rt();
            for ms in 0..50 {
                device.advance(&mut state, 4e5, still(0.02), 1e-3, 1);
                let pressures = device.pressures(&state, 0.02);
                let line = state.air.hose_mass / capacity;
                for pressure in [pressures[0], pressures[1], line] {
                    assert!(pressure > 5e4 && pressure < 1.1e6, "{ms} ms: {pressure} Pa");
                }
                assert!((line / 501_325.0 - 1.0).abs() < 0.02, "{ms} ms: {line} Pa");
            }
        }
    }
}
