//! Eq. (1), the force on the piston, and eqs. (2) to (6), the air in a chamber.

use idc_cell::device::{Device, DeviceParameters, PistonMotion, PressureMap};
use idc_cell::physics::gas::Gas;
use idc_cell::physics::orifice::FlowFunction;
use idc_cell::physics::push_only::PushOnly;

use super::devices::{Outside, filled, reached, rt, still, usual, volumes};

/// Advances by whole milliseconds under one command.
fn rest(
    device: &Device,
    outside: &Outside,
    start: PistonMotion,
    set: f64,
    ms: usize,
) -> PistonMotion {
    let mut state = device.at_rest(start.stroke, 0.0);
    let mut motion = start;
    for _ in 0..ms {
        device.advance_loaded::<_, true>(&mut state, &mut motion, set, outside, 1e-3, 1);
    }
    motion
}

// Catches: the atmosphere's term left out of `PistonAreas::gas_force`, or taken on another area than the rods'.
#[test]
fn eq_1_as_printed_pushes_a_device_that_is_open_to_the_air_by_23_n() {
    let device = Device::new(usual());
    let areas = device.parameters().areas();
    let atmosphere = device.parameters().gas.atmosphere;
    let printed = atmosphere * areas.extending - atmosphere * areas.retracting;
    println!("eq. (1) as printed pushes an open device with {printed:.2} N");
    assert!((printed - 22.9).abs() < 0.05, "{printed}");
    let end = rest(&device, &Outside::NOTHING, still(0.025), 0.0, 2000);
    reached(
        "open device, drift in 2 s over stroke",
        (end.stroke / 0.025 - 1.0).abs(),
        1e-12,
    );
    // With the load set from outside, the piston leaves: the test would see it.
    let pushed = rest(&device, &Outside::force(printed), still(0.025), 0.0, 2000);
    assert!(pushed.stroke > 0.05);
}

// Catches: contact force taken for M x'', absolute for gauge pressure in the map, a wrong area.
#[test]
fn eq_1_f_act_is_zero_where_the_contact_force_is_not_and_levels_are_gauge() {
    let device = Device::new(usual());
    let outside = Outside::load_cell(0.04);
    let area = 2.0 * std::f64::consts::FRAC_PI_4 * 0.032 * 0.032;
    let mut largest = 0.0f64;
    for set in [1.2e5, 1.8e5, 2.1e5, 3.0e5] {
        let end = rest(&device, &outside, still(0.0), set, 8000);
        let state = filled(&device, end.stroke, [set + 101_325.0, 101_325.0], set);
        let contact = outside.contact(end);
        let f_act = device.gas_force(&state, end.stroke) - contact;
        println!("{set} Pa: contact {contact:.3} N, M x'' {f_act:.1e} N");
        largest = largest.max((contact / (set * area) - 1.0).abs());
        assert!(f_act.abs() < 1e-6 * contact);
    }
    reached(
        "contact force at rest against gauge pressure times area",
        largest,
        1e-9,
    );
}

// Catches: a fixed sign of the weight in the pressure map (78.5 N between up and down).
#[test]
fn eq_1_weight_goes_with_the_tilt() {
    let device = Device::new(usual());
    let map = PressureMap::new(device.parameters());
    let (mut largest, mut printed_error) = (0.0f64, 0.0f64);
    for degrees in [0.0, 60.0, 90.0, 135.0, 180.0f64] {
        // 0: the tool hangs down, so that its weight presses; 180: it extends upwards, as eq. (1) has it.
        let along = 9.81 * degrees.to_radians().cos();
        let outside = Outside {
            force: 4.0 * along,
            ..Outside::load_cell(0.03)
        };
        let start = still((4.0 * along).min(0.0) / 1e6);
        let end = rest(
            &device,
            &outside,
            start,
            map.set_pressure(200.0, along),
            8000,
        );
        largest = largest.max((outside.contact(end) / 200.0 - 1.0).abs());
        let as_printed = rest(
            &device,
            &outside,
            start,
            map.set_pressure(200.0, -9.81),
            8000,
        );
        printed_error = printed_error.max((outside.contact(as_printed) - 200.0).abs());
    }
    println!(
        "with the sign of eq. (1) whatever the tilt, force is off by up to {printed_error:.1} N"
    );
    assert!((printed_error - 78.48).abs() < 0.01, "{printed_error}");
    reached("200 N asked for at five tilts", largest, 1e-9);
}

// Catches: end stops lost from the equation of motion.
#[test]
fn eq_1_without_stops_runs_past_the_stroke() {
    let stopped = rest(
        &Device::new(usual()),
        &Outside::NOTHING,
        still(0.0),
        1.8e5,
        4000,
    );
    let endless = DeviceParameters {
        end_stop: PushOnly {
            stiffness: 0.0,
            damping: 0.0,
        },
        ..usual()
    };
    let unstopped = rest(
        &Device::new(endless),
        &Outside::NOTHING,
        still(0.0),
        1.8e5,
        4000,
    );
    println!(
        "1.8 bar, no load: {:.2} mm with stops, {:.2} mm as printed, of 50 mm",
        stopped.stroke * 1e3,
        unstopped.stroke * 1e3
    );
    assert!((stopped.stroke - (0.05 + 1.8e5 * 1.6085e-3 / 1e6)).abs() < 1e-6);
    assert!(unstopped.stroke > 0.06);
}

// Catches: the universal gas constant, dead volume on one side only, V_2 counted from the wrong end, A_1 for A_2.
#[test]
fn eqs_2_to_4_with_the_specific_gas_constant_and_both_volumes() {
    let density = Gas::default().mass(101_325.0, 1.0);
    assert!(
        (density - 1.204).abs() < 5e-4,
        "air at 20 degrees Celsius: {density} kg/m3"
    );
    assert!((101_325.0 / (8.314 * 293.15) / density - 34.5).abs() < 0.1);
    let device = Device::new(usual());
    let mut largest = 0.0f64;
    for stroke in [0.0, 0.013, 0.05] {
        let by_hand = volumes(device.parameters(), stroke);
        let mut state = device.at_rest(stroke, 0.0);
        state.air.masses = [2e-4, 3e-4];
        let pressures = device.pressures(&state, stroke);
        for i in 0..2 {
            largest =
                largest.max((pressures[i] * by_hand[i] / (state.air.masses[i] * rt()) - 1.0).abs());
        }
    }
    reached(
        "P V = m R T of both chambers along the stroke",
        largest,
        1e-14,
    );
}

// Catches: the sign of P dV/dt, a flow into the wrong chamber, the flow of eq. (3) taken for rho V.
#[test]
fn eqs_3_5_and_6_hold_for_each_chamber_while_it_moves() {
    let device = Device::new(usual());
    let parameters = device.parameters();
    let function = FlowFunction::new(&parameters.gas);
    let conductances = parameters.valve();
    let growth = [parameters.areas().extending, -parameters.areas().retracting];
    let (h, mut largest, mut flow_error) = (1e-6, 0.0f64, 0.0f64);
    for (speed, pressures) in [
        (0.2, [1.6e5, 2.4e5]),
        (-0.3, [3.3e5, 0.9e5]),
        (0.1, [2e5, 1.2e5]),
    ] {
        let set = 2e5;
        let mut state = filled(&device, 0.02, pressures, set);
        let samples: Vec<_> = (0..3)
            .map(|i| {
                let stroke = 0.02 + speed * h * f64::from(i);
                let sample = (
                    device.pressures(&state, stroke),
                    state.air.masses,
                    volumes(parameters, stroke),
                );
                device.advance(&mut state, set, PistonMotion { stroke, speed }, h, 1);
                sample
            })
            .collect();
        let (middle, volumes) = (samples[1].0, samples[1].2);
        let flows = [
            function.mass_flow(conductances.supply_conductance, set + 101_325.0, middle[0]),
            function.mass_flow(conductances.exhaust_conductance, 101_325.0, middle[1]),
        ];
        for i in 0..2 {
            let slope = (samples[2].0[i] - samples[0].0[i]) / (2.0 * h);
            let eq_6 = (rt() * flows[i] - middle[i] * growth[i] * speed) / volumes[i];
            largest = largest.max((slope / eq_6 - 1.0).abs());
            let rho_v = |s: usize| samples[s].0[i] / rt() * samples[s].2[i];
            flow_error = flow_error.max(((rho_v(2) - rho_v(0)) / (2.0 * h) / flows[i] - 1.0).abs());
        }
    }
    reached("dP/dt against eq. (6), both chambers", largest, 1e-5);
    reached(
        "d(rho V)/dt against the flow, eqs. (3) and (5)",
        flow_error,
        1e-5,
    );
}
