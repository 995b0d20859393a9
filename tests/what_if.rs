//! `idc run --with`: an effect of the catalogue by its name is what the cell's or the device's own keys say, where there are any; others say what they should.

use idc_cell::recording::Recording;
use idc_cell::recording::parquet::read_parquet;

use crate::program::Bench;

/// A short stretch of the plate's edge.
fn plate() -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    bench.replace("scenario.toml", "end_mm = 290", "end_mm = 40");
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    bench.write("scenario.toml", text.split("[expect]").next().unwrap());
    bench
}

fn samples(bench: &Bench, file: &str, with: &[&str]) -> Recording {
    let mut arguments = vec![
        "run",
        file,
        "--out",
        "out",
        "--force",
        "--quiet",
        "--no-recording",
    ];
    for effect in with {
        arguments.extend(["--with", effect]);
    }
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{with:?}");
    read_parquet(&bench.path("out/samples.parquet"))
        .unwrap()
        .recording
}

/// Largest difference of all signals, of their largest size.
fn difference(one: &Recording, other: &Recording) -> f64 {
    let mut worst = 0.0f64;
    assert_eq!(one.time(), other.time());
    for (a, b) in one.channels().iter().zip(other.channels()) {
        let (a, b) = (&a.values, &b.values);
        let size = a.iter().fold(1e-9f64, |most, v| most.max(v.abs()));
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        worst = worst.max(off.fold(0.0, f64::max) / size);
    }
    worst
}

#[test]
fn an_effect_of_a_cell_by_its_name_is_what_the_cell_s_keys_say() {
    let bench = plate();
    let nominal = samples(&bench, "scenario.toml", &[]);
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let arm = "flange_link = \"flange\"\n";
    for (with, key) in [
        (
            "joint_friction:joint=2,friction_n_m=20",
            "[[arm.drives]]\njoint = \"shoulder_lift\"\nfriction_n_m = 20\n",
        ),
        (
            "joint_backlash:joint=2,play_deg=0.04",
            "[[arm.drives]]\njoint = \"shoulder_lift\"\nstiffness_n_m_per_rad = 1e6\nbacklash_deg = 0.04\ndamping_time_ms = 2.5\n",
        ),
        ("servo_lag", "[arm.servo]\nlag_bandwidth_hz = 25\n"),
        (
            "tool_runout:sine_um=-50,cosine_mm=0,frequency_hz=20",
            "[contact]\nrunout_um = 50\nrunout_frequency_hz = 20\n",
        ),
        (
            "coulomb_viscous_friction:coulomb_force_n=8,presliding_displacement_um=50",
            "[device.override]\nseal_coulomb_force_n = 8\nseal_static_force_n = 8\nseal_viscous_coefficient_n_s_per_m = 60\nseal_presliding_displacement_um = 50\n",
        ),
    ] {
        let keyed = text.replacen(arm, &format!("{arm}{key}"), 1);
        bench.write("keyed.toml", keyed);
        let by_name = samples(&bench, "scenario.toml", &[with]);
        let by_key = samples(&bench, "keyed.toml", &[]);
        let off = difference(&by_name, &by_key);
        assert!(off < 1e-9, "{with}: {off}");
        let shown = difference(&by_name, &nominal);
        assert!(shown > 1e-4, "{with} does nothing: {shown}");
    }
}

#[test]
fn what_is_off_is_off_by_as_much_as_was_said() {
    let bench = plate();
    let mean = |recording: &Recording, quantity: &str| {
        let values = recording.values(quantity).unwrap();
        let late = &values[values.len() / 2..values.len() * 3 / 4];
        late.iter().sum::<f64>() / late.len() as f64
    };
    let nominal = samples(&bench, "scenario.toml", &[]);
    let stroke = |recording: &Recording| mean(recording, "stroke");
    let moved = samples(
        &bench,
        "scenario.toml",
        &["part_misplaced:shift_mm=0.8,tilt_m_per_m=0"],
    );
    assert!((stroke(&moved) - stroke(&nominal) + 8e-4).abs() < 1e-6);
    // A heavier slide presses with its weight, of which the controller knows nothing.
    let scenario = idc_cell::scenario::load(&bench.path("scenario.toml")).unwrap();
    let heavier = scenario.nominal.device.moving_mass + 1.0;
    let with = format!("moving_mass_error:mass_kg={heavier}");
    let heavy = samples(&bench, "scenario.toml", &[&with]);
    let more = mean(&heavy, "contact_force") - mean(&nominal, "contact_force");
    let slope = std::f64::consts::FRAC_1_SQRT_2;
    assert!((more - 9.81 * slope).abs() < 0.02, "{more}");
    let biased = samples(
        &bench,
        "scenario.toml",
        &["force_sensor_gain_error:gain=1.1"],
    );
    let read = mean(&biased, "measured_force") / mean(&nominal, "measured_force");
    assert!((read - 1.1).abs() < 1e-6, "{read}");
    // What an encoder reads too much the arm stands off by: both are in the recording.
    let off = samples(
        &bench,
        "scenario.toml",
        &["joint_encoder_offset:joint=3,offset_rad=0.001"],
    );
    let encoder = mean(&off, "joint_3_encoder") - mean(&off, "joint_3_position");
    assert!((encoder - 1e-3).abs() < 1e-9, "{encoder}");
    let reference = mean(&off, "joint_3_encoder") - mean(&off, "joint_3_reference");
    assert!(reference.abs() < 2e-5, "{reference}");
}

#[test]
fn on_a_bench_a_controller_knows_nothing_of_an_effect() {
    let bench = Bench::new("paper_step");
    let nominal = samples(&bench, "scenario.toml", &[]);
    let weaker = samples(&bench, "scenario.toml", &["regulator_gain_error:gain=0.9"]);
    let ends = |recording: &Recording| *recording.values("contact_force").unwrap().last().unwrap();
    let share = ends(&weaker) / ends(&nominal);
    assert!((0.85..0.95).contains(&share), "{share}");
    let set = |recording: &Recording| recording.values("set_pressure").unwrap().to_vec();
    assert_eq!(set(&weaker), set(&nominal));
}

#[test]
fn what_does_not_fit_is_refused_in_one_line() {
    let bench = plate();
    for (with, said) in [
        ("tool_runot", "did you mean `tool_runout`?"),
        ("joint_friction:joint=7", "the arm has 6 joints"),
        ("tool_runout:amplitude_ms=1", "no number `amplitude_ms`"),
        (
            "channel_time_offset:offset_ms=-5",
            "no force before it is there",
        ),
    ] {
        let outcome = bench.idc(
            &["run", "scenario.toml", "--with", with, "--out", "out"],
            &[],
        );
        assert_eq!(outcome.code, 2, "{with}");
        assert!(outcome.err.contains(said), "{with}: {}", outcome.err);
        assert!(!bench.path("out").exists(), "{with}");
    }
    let both = [
        "run",
        "scenario.toml",
        "--with",
        "stribeck_friction",
        "--with",
        "coulomb_viscous_friction",
        "--out",
        "out",
    ];
    let outcome = bench.idc(&both, &[]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome.err.contains("stands in its place"),
        "{}",
        outcome.err
    );
    let stand = Bench::new("paper_step");
    let outcome = stand.idc(
        &["run", "scenario.toml", "--with", "burr", "--out", "out"],
        &[],
    );
    assert_eq!(outcome.code, 2);
    assert!(
        outcome.err.contains("a bench has no part"),
        "{}",
        outcome.err
    );
}
