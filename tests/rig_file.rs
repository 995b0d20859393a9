//! A rig file as the device of `idc run`'s bench moves and reads as the same rig does in a prediction.

use idc_cell::plant::{InitialState, PlantInputs, simulate};
use idc_cell::recording::schema;
use idc_cell::rig::Rig;
use idc_cell::scenario::load_bench;
use idc_cell::scenario::rig_file::load_rig;

use crate::predict::RIG;

const EFFECTS: &str = "
[effect.coulomb_viscous_friction]
coulomb_force_n = 12
viscous_coefficient_n_s_per_m = 90
presliding_displacement_m = 4e-5
[effect.heat_transfer]
wall_conductance_w_per_k = 0.1
[effect.hertzian_contact]
stiffness_n_per_m15 = 2e7
[effect.surface_offset]
offset_m = 0.001
[effect.surface_waviness]
frequency_hz = 2
sine_m = 2e-4
cosine_m = 1e-4
[effect.force_sensor_gain_error]
gain = 1.05
[effect.force_sensor_bias_drift]
bias_n = 3
drift_n_per_s = 0.5
[effect.inertial_crosstalk]
mass_kg = 0.3
[effect.stroke_sensor_gain_error]
gain = 1.02
";

const BENCH: &str = r#"
schema = 1
kind = "bench"
title = "a rig"
[device]
model = "rig.toml"
[bench]
duration_s = 2
[load]
kind = "load_cell"
position_mm = 20
[[command]]
at_s = 0
set_pressure_bar_gauge = 2
"#;

/// Laws as a diagnosis writes them, one for each kind of port.
const LAWS: [(&str, &str, &str); 10] = [
    ("piston_force", "c * max(v, 0)", "c = -250"),
    (
        "friction",
        "height + gain * x",
        "height = 3\ngain = 400\nbristle_stiffness = 1e5",
    ),
    ("set_pressure", "-min(p_set, limit)", "limit = 11000"),
    (
        "outlet_pressure",
        "height * sin(2 * pi * frequency * t)",
        "height = 1750\nfrequency = 3.5",
    ),
    (
        "first_chamber_leak",
        "area * min(max((x_0 - x) / width, 0), 1)",
        "area = 1.2e-6\nx_0 = 0.0112\nwidth = 0.002",
    ),
    ("supply_orifice", "gain * t", "gain = -4e-7"),
    ("exhaust_orifice", "gain * x", "gain = -3e-5"),
    ("surface", "gain * t", "gain = 2e-4"),
    ("contact_stiffness", "gain * t", "gain = -2e4"),
    ("force_reading", "-min(max(f, -limit), limit)", "limit = 10"),
];

/// What a diagnosis ends with is a law in a file: a bench that runs it and a prediction from it are one computation.
#[test]
fn bench_and_prediction_of_a_law_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let bench = BENCH.to_owned() + "[simulation]\ndevice_substeps = 1\n";
    std::fs::write(path("bench.toml"), bench).unwrap();
    let readings = |law: &str| {
        std::fs::write(path("rig.toml"), RIG.to_owned() + law).unwrap();
        let rig = Rig::new(load_bench(&path("bench.toml")).unwrap()).unwrap();
        let (recording, _) = rig.run(&mut |_| ()).unwrap();
        let plant = load_rig(&path("rig.toml")).unwrap().plant;
        let predicted = simulate(&plant, &inputs(recording.time().to_vec())).readings;
        (recording, predicted, plant.device.gas.atmosphere)
    };
    let (_, bare, _) = readings("");
    for (port, is, constants) in LAWS {
        let law = format!(
            "\n[[effect]]\nname = \"unlisted\"\nacts_on = \"{port}\"\nis = \"{is}\"\n{constants}\n"
        );
        let (recording, predicted, atmosphere) = readings(&law);
        let mut moved = 0.0f64;
        for (channel, quantity, offset) in [
            (0, schema::MEASURED_REGULATOR_PRESSURE, atmosphere),
            (1, schema::MEASURED_STROKE, 0.0),
            (2, schema::MEASURED_FORCE, 0.0),
        ] {
            let size = predicted[channel]
                .iter()
                .fold(0.0f64, |m, v| m.max(v.abs()));
            let ran = recording.values(quantity).unwrap();
            for ((ran, predicted), bare) in ran.iter().zip(&predicted[channel]).zip(&bare[channel])
            {
                let apart = (ran - offset - predicted).abs() / size;
                assert!(apart < 1e-6, "{port}, {quantity}: {apart}");
                moved = moved.max((predicted - bare).abs() / size);
            }
        }
        assert!(moved > 1e-4, "{port}: {moved}");
    }
}

fn inputs(time: Vec<f64>) -> PlantInputs {
    PlantInputs {
        set_pressure: vec![2e5; time.len()],
        extends: vec![true; time.len()],
        surface: vec![0.02; time.len()],
        time,
        cell: None,
        motion: None,
        initial: InitialState::AtRest,
        place: 0,
    }
}

#[test]
fn bench_and_prediction_agree_with_every_effect_that_both_have() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("rig.toml"), RIG.to_owned() + EFFECTS).unwrap();
    std::fs::write(path("bench.toml"), BENCH).unwrap();
    let rig = Rig::new(load_bench(&path("bench.toml")).unwrap()).unwrap();
    let (recording, stop) = rig.run(&mut |_| ()).unwrap();
    assert_eq!(stop, None);

    let inputs = inputs(recording.time().to_vec());
    let plant = load_rig(&path("rig.toml")).unwrap().plant;
    let readings = simulate(&plant, &inputs).readings;
    let atmosphere = plant.device.gas.atmosphere;
    for (channel, quantity, offset, tolerance) in [
        (0, schema::MEASURED_REGULATOR_PRESSURE, atmosphere, 1.0),
        (1, schema::MEASURED_STROKE, 0.0, 2e-6),
        (2, schema::MEASURED_FORCE, 0.0, 0.5),
    ] {
        let measured = recording.values(quantity).unwrap();
        let worst = measured
            .iter()
            .zip(&readings[channel])
            .map(|(measured, predicted)| (measured - offset - predicted).abs())
            .fold(0.0, f64::max);
        assert!(worst < tolerance, "{quantity}: {worst}");
    }
    // The waviness shows, so it was there to be missed.
    let last = &recording.values(schema::MEASURED_FORCE).unwrap()[1500..];
    let span = |f: fn(f64, f64) -> f64| last.iter().copied().reduce(f).unwrap();
    assert!(span(f64::max) - span(f64::min) > 10.0);
}
