//! Eq. (8), the regulator, and the line behind it.

use idc_cell::device::{Device, DeviceParameters};
use idc_cell::physics::hose::Hose;
use idc_cell::physics::regulator::RegulatorParameters;

use super::devices::{filled, printed_flow, reached, rt, still, usual};

/// The paper's regulator: about a second late.
fn paper() -> DeviceParameters {
    DeviceParameters {
        regulator: RegulatorParameters {
            gain: 0.97,
            time_constant: 0.5,
            dead_time: 0.5,
            supply: 6e5,
            ..RegulatorParameters::default()
        },
        ..usual()
    }
}

/// Outlet [Pa gauge] at each millisecond under commands (time [s], set pressure [Pa gauge]).
fn outlets(parameters: DeviceParameters, commands: &[(f64, f64)], duration: f64) -> Vec<f64> {
    let device = Device::new(parameters);
    let mut state = device.at_rest(0.02, 0.0);
    let mut outlets = vec![0.0];
    for step in 0..(duration * 1e3) as usize {
        let time = step as f64 * 1e-3 + 1e-9;
        let due = commands.iter().rev().find(|c| c.0 <= time);
        let set = due.map_or(0.0, |c| c.1);
        device.advance(&mut state, set, still(0.02), 1e-3, 1);
        outlets.push(state.regulator.outlet);
    }
    outlets
}

// Catches: a lag by difference quotient, a dead time that is lost, doubled or rounded to steps, a gain applied twice.
#[test]
fn eq_8_with_its_dead_time_answers_a_stairstep_in_closed_form() {
    let commands = [(0.5, 1.2e5), (5.5, 2.1e5), (10.5, 3e5)];
    // The dead time ends within a step.
    for dead_time in [0.5, 0.0, 0.1234] {
        let mut parameters = paper();
        parameters.regulator.dead_time = dead_time;
        let outlets = outlets(parameters, &commands, 16.0);
        let mut largest = 0.0f64;
        for (ms, outlet) in outlets.iter().enumerate() {
            let time = ms as f64 * 1e-3;
            let mut before = 0.0;
            let mut expected = 0.0;
            for (at, set) in commands {
                let since = (time - at - dead_time).max(0.0);
                expected += 0.97 * (set - before) * (1.0 - (-since / 0.5).exp());
                before = set;
            }
            largest = largest.max((outlet - expected).abs() / 3e5);
        }
        reached(&format!("eq. (8), dead time {dead_time} s"), largest, 1e-9);
    }
}

// Catches: the dead time dropped: eq. (8) alone is on its way at once.
#[test]
fn eq_8_as_printed_is_never_a_second_late_and_does_not_stop_at_the_supply() {
    let response = outlets(paper(), &[(0.0, 1.8e5)], 2.0);
    let level = 0.97 * 1.8e5;
    assert_eq!(response[499], 0.0);
    let at_one_second = response[1000] / level;
    reached(
        "63.2 % after dead time and time constant, a second",
        (at_one_second - (1.0 - (-1.0f64).exp())).abs(),
        1e-9,
    );
    // A first-order lag that is as slow has given a fifth of a second's worth long before.
    let printed = 1.0 - (-0.2f64).exp();
    println!(
        "0.2 s after the command: {:.0} % by eq. (8) with 1 s, none with a dead time",
        100.0 * printed
    );

    let beyond = outlets(paper(), &[(0.0, 9e5)], 20.0);
    assert!(
        (beyond[20_000] / 6e5 - 1.0).abs() < 1e-12,
        "eq. (8) as printed gives 8.73 bar from a supply of 6"
    );
}

// Catches: resistance or volume of the line wrong, its flow counted once only, a line that is passed by.
#[test]
fn a_line_into_a_choked_chamber_drops_in_closed_form() {
    // R_h and the choked flow are both linear in the line's pressure: one exponential.
    let resistance = 128.0 * 1.82e-5 * 2.0 / (std::f64::consts::PI * 0.004f64.powi(4) * 3.0);
    let volume = std::f64::consts::FRAC_PI_4 * 0.004 * 0.004 * 2.0;
    let mut parameters = usual();
    parameters.hose = Some(Hose::lumped(volume, resistance));
    let device = Device::new(parameters);
    let before = 6e5 + 101_325.0;
    let mut state = filled(&device, 0.05, [2e4, 101_325.0], 6e5);
    // The line starts half as full.
    state.air.hose_mass *= 0.5;
    let start = 0.5 * before;
    let choked = printed_flow(2.5e-6 * 0.95, 1.0, 0.0);
    let steady = before / (1.0 + resistance * choked);
    let rate = rt() / volume * (1.0 / resistance + choked);
    let (mut largest, mut flow_error) = (0.0f64, 0.0f64);
    for ms in 1..=30 {
        let entered = state.air.entered;
        device.advance(&mut state, 6e5, still(0.05), 1e-3, 1);
        let t = f64::from(ms) * 1e-3;
        let expected = steady + (start - steady) * (-rate * t).exp();
        let pressure = state.air.hose_mass * rt() / volume;
        assert!(
            device.pressures(&state, 0.05)[0] < 0.52 * pressure,
            "choked"
        );
        largest = largest.max((pressure / expected - 1.0).abs());
        flow_error = (state.air.entered - entered) / 1e-3 / (steady * choked) - 1.0;
    }
    println!(
        "line of 2 m x 4 mm: steady drop {:.0} Pa at {:.2} g/s",
        before - steady,
        1e3 * steady * choked
    );
    reached(
        "pressure in the line against its exponential",
        largest,
        1e-4,
    );
    reached("steady flow through the line", flow_error.abs(), 1e-4);
}
