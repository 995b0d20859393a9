//! Air is neither made nor lost: what entered less what left is what the chambers gained.

use idc_cell::device::{Device, DeviceParameters, DeviceState, PistonMotion};
use idc_cell::physics::valve::ValvePosition;
use idc_cell::recording::{RecordedChannel, Recording, schema};

use crate::common::{run, scenario};

/// Gap that is accepted, of the mass in the chambers [1].
const TOLERANCE: f64 = 1e-9;

/// Largest gap in the balance against the first sample, of the mass in the chambers [1].
fn gap(recording: &Recording) -> f64 {
    let values = |name| recording.values(name).unwrap();
    let (first, second) = (
        values(schema::CHAMBER_1_MASS),
        values(schema::CHAMBER_2_MASS),
    );
    let (entered, left) = (values(schema::MASS_ENTERED), values(schema::MASS_LEFT));
    let inside = |i: usize| first[i] + second[i];
    let brought = |i: usize| entered[i] - left[i];
    let gap = |i: usize| ((inside(i) - inside(0)) - (brought(i) - brought(0))).abs() / inside(i);
    (0..recording.sample_count()).map(gap).fold(0.0, f64::max)
}

/// The recording with one channel changed.
fn tampered(recording: &Recording, name: &str, change: fn(f64) -> f64) -> Recording {
    let channels = recording.channels().iter().map(|channel| RecordedChannel {
        values: match channel.quantity == name {
            true => channel.values.iter().map(|&value| change(value)).collect(),
            false => channel.values.clone(),
        },
        ..channel.clone()
    });
    Recording::new(
        recording.time().to_vec(),
        channels.collect(),
        recording.phases().to_vec(),
    )
    .unwrap()
}

#[test]
fn air_balances_at_every_sample_of_a_run() {
    for name in ["plate_edge_ideal", "burred_edge"] {
        let finished = run(scenario(name));
        let recording = &finished.recording;
        let found = gap(recording);
        println!("{name}: air balances within {found:.1e} of the mass in the chambers");
        assert!(found < TOLERANCE, "{name}: {found:e}");
        let reported = finished.summary.air_mass_balance_relative.unwrap();
        assert!(
            reported < TOLERANCE && (reported > 0.0) == (found > 0.0),
            "{name}: {reported:e}"
        );

        // Air did move: the test is not of two empty columns.
        let moved = |channel: &str| {
            recording.values(channel).unwrap().last().unwrap()
                / recording.values(schema::CHAMBER_1_MASS).unwrap()[0]
        };
        assert!(
            moved(schema::MASS_ENTERED) > 0.01 && moved(schema::MASS_LEFT) > 0.01,
            "{name}"
        );

        // A contribution that is left out, or short by a millionth of it, is seen.
        for channel in [
            schema::MASS_ENTERED,
            schema::MASS_LEFT,
            schema::CHAMBER_1_MASS,
            schema::CHAMBER_2_MASS,
        ] {
            assert!(
                gap(&tampered(recording, channel, |_| 0.0)) > 1e-2,
                "{name}: {channel}"
            );
            assert!(
                gap(&tampered(recording, channel, |mass| mass * (1.0 - 1e-6))) > TOLERANCE,
                "{name}: {channel}"
            );
        }
    }
}

#[test]
fn recorded_masses_are_those_of_the_recorded_pressures_and_stroke() {
    let job = scenario("plate_edge_ideal");
    let parameters = job.nominal.device.clone();
    let recording = run(job).recording;
    let values = |name| recording.values(name).unwrap();
    let stroke = values(schema::STROKE);
    let names = [
        (schema::CHAMBER_1_PRESSURE, schema::CHAMBER_1_MASS),
        (schema::CHAMBER_2_PRESSURE, schema::CHAMBER_2_MASS),
    ];
    for (index, (pressure, mass)) in names.into_iter().enumerate() {
        for ((&pressure, &mass), &stroke) in values(pressure).iter().zip(values(mass)).zip(stroke) {
            let expected = mass_of(&parameters, index, pressure, stroke);
            assert!(
                (mass / expected - 1.0).abs() < 1e-12,
                "{mass} against {expected}"
            );
        }
    }
}

/// m = p V / (R T) with V = V_0 + A x and V_0 + A (L - x), from the bore and the rod [kg].
fn mass_of(parameters: &DeviceParameters, chamber: usize, pressure: f64, stroke: f64) -> f64 {
    let disc = |diameter: f64| std::f64::consts::FRAC_PI_4 * diameter * diameter;
    let count = f64::from(parameters.cylinder_count);
    let displaced = match chamber {
        0 => count * disc(parameters.bore) * stroke,
        _ => {
            count
                * (disc(parameters.bore) - disc(parameters.rod))
                * (parameters.full_stroke - stroke)
        }
    };
    let gas = &parameters.gas;
    pressure * (parameters.dead_volume + displaced) / (gas.specific_gas_constant * gas.temperature)
}

/// Without friction and at constant temperature, as Boyle's law has it.
fn parameters() -> DeviceParameters {
    DeviceParameters::default()
}

fn inside(state: &DeviceState) -> f64 {
    state.air.masses.iter().sum()
}

/// Advances by steps of 1 ms, the stroke swinging about the middle, and returns the largest gap in the balance.
fn gap_over(
    device: &Device,
    state: &mut DeviceState,
    set_pressure: f64,
    seconds: f64,
    swing: f64,
) -> f64 {
    let start = inside(state);
    let (entered, left) = (state.air.entered, state.air.left);
    let mut worst = 0.0f64;
    for step in 0..(seconds * 1e3) as usize {
        let phase = 1e-3 * step as f64 * std::f64::consts::TAU;
        let motion = PistonMotion {
            stroke: 0.025 + swing * phase.sin(),
            speed: swing * std::f64::consts::TAU * phase.cos(),
        };
        device.advance(state, set_pressure, motion, 1e-3, 2);
        let brought = (state.air.entered - entered) - (state.air.left - left);
        worst = worst.max((inside(state) - start - brought).abs() / inside(state));
    }
    worst
}

#[test]
fn a_closed_chamber_keeps_its_air_and_follows_boyle() {
    let closed = DeviceParameters {
        supply_orifice: 0.0,
        exhaust_orifice: 0.0,
        ..parameters()
    };
    let device = Device::new(closed.clone());
    let mut state = device.at_rest(0.025, 2e5);
    let before = state.clone();
    gap_over(&device, &mut state, 2e5, 1.3, 0.02);
    assert_eq!(
        (state.air.masses, state.air.entered, state.air.left),
        (before.air.masses, 0.0, 0.0)
    );
    // Compressed to the far end: p V stays.
    for stroke in [0.001, 0.049] {
        for chamber in 0..2 {
            let pressure = device.pressures(&state, stroke)[chamber];
            let mass = mass_of(&closed, chamber, pressure, stroke);
            assert!((mass / before.air.masses[chamber] - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn chambers_filled_from_empty_and_vented_keep_count() {
    let parameters = parameters();
    let device = Device::new(parameters.clone());
    let mut state = device.at_rest(0.025, 2e5);
    state.air.masses = [1e-12; 2];
    let filled = gap_over(&device, &mut state, 2e5, 2.0, 0.0);
    let gas = &parameters.gas;
    let full = |chamber, gauge: f64| mass_of(&parameters, chamber, gas.atmosphere + gauge, 0.025);
    for (chamber, gauge) in [(0, 2e5), (1, 0.0)] {
        assert!(
            (state.air.masses[chamber] / full(chamber, gauge) - 1.0).abs() < 1e-6,
            "chamber {chamber}"
        );
    }
    assert_eq!(state.air.left, 0.0);
    // The valve turned round: chamber 1 vents, chamber 2 fills, and the slide pumps meanwhile.
    state.valve = ValvePosition::Retract;
    let vented = gap_over(&device, &mut state, 2e5, 2.0, 0.0);
    for (chamber, gauge) in [(0, 0.0), (1, 2e5)] {
        assert!(
            (state.air.masses[chamber] / full(chamber, gauge) - 1.0).abs() < 1e-6,
            "chamber {chamber}"
        );
    }
    let pumped = gap_over(&device, &mut state, 2e5, 3.0, 0.02);
    assert!(state.air.left > full(0, 1e5));
    for gap in [filled, vented, pumped] {
        assert!(gap < TOLERANCE, "{gap:e}");
    }
}
