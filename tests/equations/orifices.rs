//! Eqs. (9) to (11): flow through an orifice.

use idc_cell::device::Device;
use idc_cell::physics::gas::Gas;
use idc_cell::physics::orifice::{FlowFunction, LAMINAR_RATIO};

use super::devices::{
    filled, printed_critical_ratio, printed_flow, printed_flow_function, reached, still, usual,
};

// Catches: any exponent or factor of eqs. (9) to (11), the discharge coefficient left out or squared.
#[test]
fn eqs_9_to_11_are_the_paper_s_wherever_it_has_a_value_but_next_to_equal_pressures() {
    let function = FlowFunction::new(&Gas::default());
    let supply = usual().valve().supply_conductance;
    assert!((supply / (2.5e-6 * 0.95) - 1.0).abs() < 1e-15, "C_s = 0.95");
    let (mut largest, mut laminar) = (0.0f64, 0.0f64);
    for i in 1..1_000_000 {
        let u = f64::from(i) * 1e-6;
        let error = function.mass_flow(supply, 6e5, 6e5 * u) - printed_flow(supply, 6e5, 6e5 * u);
        let error = error.abs() / printed_flow(supply, 6e5, 1e5);
        // The product 6e5 u and back rounds.
        if u <= LAMINAR_RATIO - 1e-9 {
            largest = largest.max(error);
        } else {
            laminar = laminar.max(error);
        }
    }
    println!(
        "above a ratio of {LAMINAR_RATIO} the flow is up to {laminar:.1e} of the choked flow less than eq. (10)"
    );
    assert!(laminar < 0.02);
    reached(
        "flow against eqs. (9) to (11), of the choked flow",
        largest,
        1e-12,
    );
}

// Catches: a critical ratio that is not where the subsonic branch peaks, so that the flow jumps or decreases.
#[test]
fn eq_10_both_branches_meet_level_at_eq_11_so_either_inequality_does() {
    let r = printed_critical_ratio(1.4);
    let function = FlowFunction::new(&Gas::default());
    assert!((function.critical_ratio() / r - 1.0).abs() < 1e-15);
    let choked = printed_flow_function(1.4, 0.0);
    let jump = |by: f64| (function.value(r + by) / choked - 1.0).abs();
    reached("jump at the critical ratio", jump(1e-15), 1e-14);
    // Level: a hundredth of the distance is a ten-thousandth of the fall.
    let order = (jump(1e-3) / jump(1e-4)).log10();
    assert!((order - 2.0).abs() < 0.01, "order {order}");
}

// Catches: no flow, or flow the wrong way, when the chamber has the higher pressure.
#[test]
fn eq_9_has_no_value_backwards_and_the_regulator_relieves() {
    assert!(printed_flow(2e-6, 2e5, 2.1e5).is_nan());
    let function = FlowFunction::new(&Gas::default());
    let mut largest = 0.0f64;
    for (from, to) in [(2e5, 2.1e5), (1e5, 7e5), (3e5, 3.0001e5)] {
        let back = function.mass_flow(2e-6, from, to);
        largest = largest.max((back / function.mass_flow(2e-6, to, from) + 1.0).abs());
    }
    reached("flow backwards against forwards", largest, 1e-15);

    let device = Device::new(usual());
    let mut state = device.at_rest(0.04, 3e5);
    for _ in 0..6000 {
        device.advance(&mut state, 1e5, still(0.04), 1e-3, 1);
    }
    let gauge = device.pressures(&state, 0.04)[0] - 101_325.0;
    println!(
        "set pressure from 3 to 1 bar: chamber 1 at {gauge:.3} Pa; with eq. (9) as printed it would stay at 3 bar"
    );
    reached("relieved to 1 bar", (gauge / 1e5 - 1.0).abs(), 1e-9);
    assert!(state.air.left > 1e-4 && state.air.entered == 0.0);
}

// Catches: the valve's positions swapped, or the exhaust orifice's area used for the supply.
#[test]
fn eq_6_flows_of_chamber_2_that_the_paper_does_not_give_are_those_of_the_exhaust() {
    let device = Device::new(usual());
    let valve = device.parameters().valve();
    let (supply, exhaust) = (valve.supply_conductance, valve.exhaust_conductance);
    for (position, areas) in [
        (
            idc_cell::physics::valve::ValvePosition::Extend,
            [supply, exhaust],
        ),
        (
            idc_cell::physics::valve::ValvePosition::Retract,
            [exhaust, supply],
        ),
    ] {
        let mut state = filled(&device, 0.02, [5e5, 5e5], 0.0);
        state.valve = position;
        let before = state.air.masses;
        device.advance(&mut state, 0.0, still(0.02), 1e-6, 1);
        for i in 0..2 {
            let flow = (before[i] - state.air.masses[i]) / 1e-6;
            let choked = printed_flow(areas[i], 5e5, 1e5);
            // Over a microsecond the pressure falls by a few parts in a million.
            assert!(
                (flow / choked - 1.0).abs() < 1e-5,
                "{position:?} {i}: {flow}"
            );
        }
    }
}
