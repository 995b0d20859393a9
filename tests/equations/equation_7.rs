//! Eq. (7), which takes chamber 2's net inflow off chamber 1's.
//!
//! With V_2 = V_0 + A_2 (L - x) its numerator is P_2' V_2 - P_2 A_2 x' = d(P_2 V_2)/dt = R T m_2', so that eq. (7) says m_1' = m_v - m_2':
//! what leaves chamber 2 enters chamber 1. Both are eq. (6) when chamber 2 is closed. Integrated here as printed, by a program of its own.

use idc_cell::device::{Device, DeviceParameters};

use super::devices::{Outside, printed_flow, reached, rt, still, usual, volumes};

/// Pressures P_1 and P_2 [Pa absolute], stroke [m], speed [m/s].
type State = [f64; 4];

/// Which equation chamber 1 follows.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Chamber1 {
    /// Eq. (6), both ways.
    Equation6,
    /// Eq. (7), with flow both ways.
    Equation7,
    /// Eq. (7), and no flow back into the regulator, for eq. (9) has no value there.
    Equation7OneWay,
}

const ATMOSPHERE: f64 = 101_325.0;
const SET: f64 = 1.5e5;

/// Eq. (9) with the higher pressure upstream, and the linear part next to equal pressures.
fn flow(conductance_area: f64, from: f64, to: f64) -> f64 {
    if from < to {
        return -flow(conductance_area, to, from);
    }
    let laminar = 0.999;
    if to / from > laminar {
        let edge = printed_flow(conductance_area, from, laminar * from);
        return edge * (1.0 - to / from) / (1.0 - laminar);
    }
    printed_flow(conductance_area, from, to)
}

fn outlet(parameters: &DeviceParameters, time: f64) -> f64 {
    let regulator = &parameters.regulator;
    let late = (time - regulator.dead_time).max(0.0);
    ATMOSPHERE + SET * (1.0 - (-late / regulator.time_constant).exp())
}

fn rates(parameters: &DeviceParameters, chamber_1: Chamber1, time: f64, s: &State) -> State {
    let [p1, p2, x, v] = *s;
    let areas = parameters.areas();
    let (a1, a2) = (areas.extending, areas.retracting);
    let [v1, v2] = volumes(parameters, x);
    let valve = parameters.valve();
    let supply = flow(valve.supply_conductance, outlet(parameters, time), p1);
    let exhaust = flow(valve.exhaust_conductance, ATMOSPHERE, p2);
    let dp2 = (rt() * exhaust + p2 * a2 * v) / v2;
    let into_1 = match chamber_1 {
        Chamber1::Equation6 => supply,
        Chamber1::Equation7 => supply - (dp2 * v2 - p2 * a2 * v) / rt(),
        Chamber1::Equation7OneWay => supply.max(0.0) - (dp2 * v2 - p2 * a2 * v) / rt(),
    };
    let dp1 = -p1 * a1 * v / v1 + rt() / v1 * into_1;
    let (stop, end) = (&parameters.end_stop, parameters.full_stroke);
    let stops = stop.force(-x, -v) - stop.force(x - end, v);
    let force = p1 * a1 - p2 * a2 - ATMOSPHERE * (a1 - a2) + stops;
    [dp1, dp2, v, force / parameters.moving_mass]
}

/// Every millisecond of 3 s, from rest with chamber 2 at a pressure [Pa absolute] and chamber 1 at the atmosphere.
fn extension(parameters: &DeviceParameters, chamber_1: Chamber1, second: f64) -> Vec<State> {
    let h = 2.5e-5;
    let mut s = [ATMOSPHERE, second, 0.0, 0.0];
    let mut samples = vec![s];
    for step in 0..120_000 {
        let t = h * f64::from(step);
        let along = |k: &State, by: f64| std::array::from_fn(|i| s[i] + by * k[i]);
        let k1 = rates(parameters, chamber_1, t, &s);
        let k2 = rates(parameters, chamber_1, t + 0.5 * h, &along(&k1, 0.5 * h));
        let k3 = rates(parameters, chamber_1, t + 0.5 * h, &along(&k2, 0.5 * h));
        let k4 = rates(parameters, chamber_1, t + h, &along(&k3, h));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        if (step + 1) % 40 == 0 {
            samples.push(s);
        }
    }
    samples
}

/// Largest difference of two runs [1]: pressures over 6 bar, stroke over 50 mm.
fn difference(a: &[State], b: &[State]) -> f64 {
    let pair = |(a, b): (&State, &State)| {
        let pressure = (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) / 6e5;
        pressure.max((a[2] - b[2]).abs() / 0.05)
    };
    a.iter().zip(b).map(pair).fold(0.0, f64::max)
}

/// When the stroke first reaches 40 mm [ms].
fn arrival(samples: &[State]) -> usize {
    samples.iter().position(|s| s[2] >= 0.04).unwrap()
}

// Catches: this file's own integration, which then could show anything.
#[test]
fn eq_6_for_each_chamber_integrated_here_is_the_device() {
    let device = Device::new(usual());
    let mut state = device.at_rest(0.0, 0.0);
    let mut motion = still(0.0);
    let mut samples = vec![[ATMOSPHERE, ATMOSPHERE, 0.0, 0.0]];
    for _ in 0..3000 {
        device.advance_loaded::<_, true>(&mut state, &mut motion, SET, &Outside::NOTHING, 1e-3, 4);
        let [p1, p2] = device.pressures(&state, motion.stroke);
        samples.push([p1, p2, motion.stroke, motion.speed]);
    }
    let here = extension(device.parameters(), Chamber1::Equation6, ATMOSPHERE);
    reached(
        "free extension by eq. (6), another program against the device",
        difference(&samples, &here),
        1e-4,
    );
}

// Catches: a sign of P_2 A_2 x' other than the printed one, with which a closed chamber 2 would matter.
#[test]
fn eq_7_is_eq_6_while_chamber_2_is_closed() {
    let closed = DeviceParameters {
        exhaust_orifice: 0.0,
        ..usual()
    };
    let [six, seven] =
        [Chamber1::Equation6, Chamber1::Equation7].map(|c| extension(&closed, c, ATMOSPHERE));
    assert!(six.last().unwrap()[2] > 0.01, "it moved");
    reached(
        "eq. (7) against eq. (6), chamber 2 closed",
        difference(&six, &seven),
        1e-12,
    );
}

// Catches: a device that did what eq. (7) says.
#[test]
fn eq_7_adds_the_exhaust_to_chamber_1() {
    // As the piston first runs out, and as it does again after a retraction: chamber 2 full, the regulator long settled.
    for (name, second) in [
        ("first", ATMOSPHERE),
        ("after a retraction", ATMOSPHERE + SET),
    ] {
        let mut parameters = usual();
        if second > ATMOSPHERE {
            parameters.regulator.time_constant = 1e-9;
            parameters.regulator.dead_time = 0.0;
        }
        let run = |chamber_1| extension(&parameters, chamber_1, second);
        let six = run(Chamber1::Equation6);
        let gauge = |s: &State| (s[0] - ATMOSPHERE) / 1e5;
        let highest = |run: &[State]| run.iter().map(gauge).fold(0.0, f64::max);
        let mut found = Vec::new();
        for chamber_1 in [
            Chamber1::Equation6,
            Chamber1::Equation7,
            Chamber1::Equation7OneWay,
        ] {
            let run = run(chamber_1);
            let off = 100.0 * difference(&six, &run);
            let (ms, most, end) = (arrival(&run), highest(&run), gauge(run.last().unwrap()));
            println!(
                "{name}, {chamber_1:?}: 40 mm after {ms} ms, chamber 1 at most {most:.3} bar, {end:.3} bar in the end; off by up to {off:.1} % of full scale"
            );
            found.push((ms, most, end, off));
        }
        // The regulator gives 1.5 bar at most.
        assert!((found[0].1 - 1.5).abs() < 1e-3 && (found[0].2 - 1.5).abs() < 1e-6);
        assert!(
            found[1].0 + 20 < found[0].0 && found[1].3 > 10.0,
            "eq. (7) is too early"
        );
        if second > ATMOSPHERE {
            assert!(
                found[1].1 > 1.55 && found[2].1 > 1.55,
                "above the regulator"
            );
        }
    }
}
