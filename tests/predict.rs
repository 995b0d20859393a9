//! `idc predict`: a rig file and inputs give columns; what is wrong with either is one line, exit code 2, and nothing is written.

use std::fmt::Write as _;

use crate::program::{Bench, Outcome};

pub const RIG: &str = r"schema = 1

[cylinder]
count = 2
bore_m = 0.025
rod_m = 0.01
stroke_m = 0.05
dead_volume_m3 = { value = 1.454e-05, tolerance = 0.1 }
moving_mass_kg = 5.0
gravity_along_axis_m_per_s2 = -9.81

[end_stop]
stiffness_n_per_m = 1000000
damping_n_s_per_m = 2000

[regulator]
gain = 1
time_constant_s = 0.1

[valve]
supply_orifice_m2 = 1.6e-06
exhaust_orifice_m2 = 1.3e-06
discharge_coefficient = 0.95

[gas]
specific_gas_constant_j_per_kg_k = 287.05
heat_capacity_ratio = 1.4
temperature_k = 293.15
atmosphere_pa = 101325.0

[contact]
stiffness_n_per_m = 200000
damping_n_s_per_m = 400

[sensors]
rate_hz = 250
force_n = 0.8
stroke_m = 2e-05
regulator_pressure_pa = 400.0
acceleration_m_per_s2 = 0.15
";

/// 2 bar from the start against a surface that stands at 20 mm, for two seconds, without measured columns.
fn inputs() -> String {
    let mut text = "time_s,set_pressure_pa,solenoid,surface_m\n".to_owned();
    for i in 0..500 {
        writeln!(text, "{:.4},200000,1,0.02", 0.004 * f64::from(i)).unwrap();
    }
    text
}

/// A folder with a rig and its inputs.
fn folder() -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("rig.toml", RIG);
    bench.write("inputs.csv", inputs());
    bench
}

/// Inputs of which nothing was recorded for a while before a sample.
fn with_gap(sample: usize, seconds: f64) -> String {
    let mut text = "time_s,set_pressure_pa,solenoid,surface_m\n".to_owned();
    for i in 0..500 {
        let time = 0.004 * i as f64 + if i < sample { 0.0 } else { seconds };
        writeln!(text, "{time:.4},200000,1,0.02").unwrap();
    }
    text
}

#[test]
fn a_gap_is_refused_with_where_it_is_and_what_to_do() {
    let bench = folder();
    bench.write(
        "rig.toml",
        format!("{RIG}\n[recordings]\nfit = [\"inputs.csv\"]\n"),
    );
    bench.write("inputs.csv", with_gap(200, 3600.0));
    for command in [
        &["predict", "rig.toml", "inputs.csv", "--out", "out.csv"][..],
        &["check", "."],
        &["diagnose", ".", "--out", "found"],
    ] {
        let outcome = bench.idc(command, &[]);
        let line = outcome.only_line("error: ");
        for words in [
            "inputs.csv: nothing is recorded from 0.796 to 3600.800 s",
            "the 200 samples before it and the 300 samples after it into a file each",
            "`idc import --split`",
        ] {
            assert!(line.contains(words), "{line}\nlacks {words}");
        }
        assert_eq!(outcome.code, 2);
        assert!(!bench.path("out.csv").exists() && !bench.path("found").exists());
    }
    // Some dropped samples are none.
    bench.write("inputs.csv", with_gap(200, 0.9));
    assert_eq!(predict(&bench).code, 0);
    let parquet = ["predict", "rig.toml", "inputs.csv", "--out", "out.parquet"];
    let outcome = bench.idc(&parquet, &[]);
    assert!(outcome.only_line("error: ").contains("out.parquet"));
    assert_eq!(outcome.code, 2);
}

fn predict(bench: &Bench) -> Outcome {
    bench.idc(
        &[
            "predict",
            "rig.toml",
            "inputs.csv",
            "--out",
            "out.csv",
            "--force",
        ],
        &[],
    )
}

/// Columns of the prediction: time, regulator pressure, stroke, force, acceleration. Each lies within its band, on ground that is known as long as nobody says what is not.
fn columns(bench: &Bench) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(bench.path("out.csv")).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let channels = "regulator_pressure_pa,stroke_m,force_n,acceleration_m_per_s2";
    let bands = channels
        .split(',')
        .flat_map(|c| [format!("{c}_low"), format!("{c}_high")]);
    let bands = bands.collect::<Vec<String>>().join(",");
    assert_eq!(header, format!("time_s,{channels},{bands},known_ground"));
    let row = |row: &str| -> Vec<f64> {
        let mut all: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
        for channel in 0..4 {
            let [low, high] = [5, 6].map(|place| all[place + 2 * channel]);
            assert!(low < all[1 + channel] && all[1 + channel] < high, "{row}");
        }
        assert_eq!(all[13], 1.0);
        all.truncate(5);
        all
    };
    rows.lines().map(row).collect()
}

#[test]
fn a_nominal_rig_comes_to_rest_on_the_balance_of_its_forces() {
    let bench = folder();
    let outcome = predict(&bench);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert_eq!(outcome.out, "500 samples written to out.csv\n");
    let rows = columns(&bench);
    assert_eq!(rows.len(), 500);
    let [time, pressure, stroke, force, acceleration] = rows[499][..] else {
        panic!("{:?}", rows[499]);
    };
    assert_eq!(time, 1.996);
    assert!((pressure - 2e5).abs() < 10.0);
    // Two pistons of 25 mm under 2 bar, less the weight.
    let expected = 2.0 * std::f64::consts::PI / 4.0 * 0.025f64.powi(2) * 2e5 - 5.0 * 9.81;
    assert!((force / expected - 1.0).abs() < 1e-3, "{force} {expected}");
    assert!((stroke - 0.02 - force / 2e5).abs() < 1e-6);
    assert!(acceleration.abs() < 0.02);
}

#[test]
fn an_improved_rig_predicts_with_its_effects() {
    let bench = folder();
    predict(&bench);
    let nominal = columns(&bench)[499][3];
    bench.write(
        "rig.toml",
        RIG.to_owned() + "\n[effect.axial_force_offset]\nforce_n = { value = -20, low = -21, high = -19 }\n[effect.force_sensor_bias_drift]\nbias_n = 5\ndrift_n_per_s = 0\n",
    );
    assert_eq!(predict(&bench).code, 0);
    let improved = columns(&bench)[499][3];
    assert!(
        (improved - nominal + 15.0).abs() < 0.05,
        "{improved} {nominal}"
    );
}

#[test]
fn measured_columns_are_compared_in_standard_deviations_of_their_noise() {
    let bench = folder();
    predict(&bench);
    let rows = columns(&bench);
    let mut text = "time_s,set_pressure_pa,solenoid,surface_m,force_n\n".to_owned();
    for (i, row) in rows.iter().enumerate() {
        let error = if i % 2 == 0 { 1.6 } else { -1.6 };
        writeln!(text, "{},200000,1,0.02,{}", row[0], row[3] + error).unwrap();
    }
    bench.write("inputs.csv", text);
    let outcome = predict(&bench);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(
        outcome.out.contains(
            "force_n                  measured less predicted: RMS 2.000 standard deviations"
        ),
        "{}",
        outcome.out
    );
    assert!(!outcome.out.contains("stroke_m"), "{}", outcome.out);
}

#[test]
fn bad_input_is_one_line() {
    let refusals: [(&str, &str, &str, &str); 9] = [
        (
            "rig.toml",
            "atmosphere_pa = 101325.0",
            "atmosphere_pa = 1.01325",
            "rig.toml:29:1: `gas.atmosphere_pa` is 1.01325 Pa, expected 50000 to 110000 Pa (it looks like bar",
        ),
        (
            "rig.toml",
            "bore_m = 0.025",
            "bore_mm = 25",
            "rig.toml:5:1: unknown key `cylinder.bore_mm`; the key is `bore_m`, in m",
        ),
        (
            "rig.toml",
            "[valve]",
            "[valve",
            "rig.toml:20:7: not valid TOML",
        ),
        (
            "rig.toml",
            "[sensors]",
            "[effect.friction]\nforce_n = 3\n\n[sensors]",
            "rig.toml:35:9: unknown key `effect.friction`",
        ),
        (
            "inputs.csv",
            "200000,",
            "2,",
            "inputs.csv:2: column `set_pressure_pa`",
        ),
        (
            "inputs.csv",
            "solenoid",
            "valve",
            "column `solenoid` is missing",
        ),
        (
            "inputs.csv",
            "0.0080,",
            "0.0030,",
            "inputs.csv:4: column `time_s` is 0.003 s, expected more than the 0.004 s of the sample before it",
        ),
        (
            "inputs.csv",
            "0.0080,200000",
            "0.0080,2e5 Pa",
            "inputs.csv:4: column `set_pressure_pa` is \"2e5 Pa\"",
        ),
        (
            "inputs.csv",
            "0.02\n0.0080",
            "0.02,7\n0.0080",
            "inputs.csv:3: 5 fields, expected 4",
        ),
    ];
    for (file, from, to, says) in refusals {
        let bench = folder();
        if to == "2," {
            bench.write("inputs.csv", inputs().replace("200000", "2"));
        } else {
            bench.replace(file, from, to);
        }
        let before = bench.contents();
        let outcome = predict(&bench);
        let line = outcome.only_line("error: ");
        assert!(line.contains(says), "{line}\nlacks {says:?}");
        assert_eq!((outcome.code, outcome.out.as_str()), (2, ""), "{line}");
        assert!(before == bench.contents(), "files changed: {line}");
    }
}

#[test]
fn an_input_is_never_written_over() {
    let bench = folder();
    let before = bench.contents();
    let outcome = bench.idc(
        &["predict", "rig.toml", "inputs.csv", "--out", "./inputs.csv"],
        &[],
    );
    assert_eq!(outcome.code, 2);
    assert!(
        outcome
            .only_line("error: ")
            .contains("--out is ./inputs.csv, which is read here")
    );
    assert!(before == bench.contents());
}
