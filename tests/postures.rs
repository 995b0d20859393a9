//! Still postures of a wrench sensor are a case: of a real sensor, and of one by formulas of the test's own; what cannot be such a case is refused.

use std::fmt::Write as _;

use idc_cell::case::PosturesCase;
use idc_cell::diagnosis::postures::Posture;
use idc_cell::diagnosis::postures::diagnosed::diagnose;
use idc_cell::diagnosis::postures::found::PosturesInput;
use serde_json::Value;

use crate::common::shared;
use crate::program::Bench;

const FILE: &str = r#"schema = 1
kind = "wrench_postures"

[recordings]
fit = ["stills.csv"]
"#;

/// Uniform from 0 to 1.
fn uniform(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// Postures of a sensor with a tool of 10 N, its centre 0.05 m away along z, and a zero of (1, 2, 3) N; the readings are those of a sensor that is turned by
/// `turn` about z.
fn stills(seed: u64, count: usize, turn: f64, force_unit: f64) -> String {
    let mut text = String::from(
        "quaternion_x,quaternion_y,quaternion_z,quaternion_w,force_x_n,force_y_n,force_z_n,torque_x_n_m,torque_y_n_m,torque_z_n_m\n",
    );
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    for _ in 0..count {
        let q: [f64; 4] =
            std::array::from_fn(|_| (0..6).map(|_| uniform(&mut state)).sum::<f64>() - 3.0);
        let norm = q.iter().map(|v| v * v).sum::<f64>().sqrt();
        let [x, y, z, w] = q.map(|v| v / norm);
        // The base's -z in the axes of the link: the third row of the pose's matrix.
        let down = [
            -(2.0 * (x * z - y * w)),
            -(2.0 * (y * z + x * w)),
            -(1.0 - 2.0 * (x * x + y * y)),
        ];
        let load = down.map(|d| 10.0 * d);
        let moment = [-0.05 * load[1], 0.05 * load[0], 0.0];
        let (s, c) = turn.sin_cos();
        let read = |v: [f64; 3]| [c * v[0] + s * v[1], -s * v[0] + c * v[1], v[2]];
        let mut noise = |size: f64| {
            let sum: f64 = (0..12).map(|_| uniform(&mut state)).sum();
            size * (sum - 6.0)
        };
        let force = read(load);
        let torque = read(moment);
        let zero = [1.0, 2.0, 3.0];
        let _ = write!(text, "{x:.7},{y:.7},{z:.7},{w:.7}");
        for axis in 0..3 {
            let value = (force[axis] + zero[axis] + noise(0.1)) / force_unit;
            let _ = write!(text, ",{value:.6}");
        }
        for value in torque {
            let _ = write!(text, ",{:.6}", value + noise(0.005));
        }
        text.push('\n');
    }
    text
}

fn bench(file: &str, rows: &str) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    std::fs::create_dir_all(bench.path("wrist")).unwrap();
    bench.write("wrist/postures.toml", file);
    bench.write("wrist/stills.csv", rows);
    bench
}

fn diagnosed(bench: &Bench, folder: &str) -> Value {
    let arguments = ["diagnose", folder, "--out", "found", "--force", "--quiet"];
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let text = std::fs::read_to_string(bench.path("found/diagnosis.json")).unwrap();
    crate::statements::hold_together(&serde_json::from_str(&text).unwrap());
    serde_json::from_str(&text).unwrap()
}

fn names(answer: &Value) -> Vec<&str> {
    let effects = answer["effects"].as_array().unwrap().iter();
    effects.map(|e| e["name"].as_str().unwrap()).collect()
}

fn account(bench: &Bench) -> String {
    let text = std::fs::read_to_string(bench.path("found/account.txt")).unwrap();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Of an identified number [SI].
fn identified(answer: &Value, key: &str) -> f64 {
    let all = answer["identified"].as_array().unwrap();
    let number = all.iter().find(|number| number["key"] == key).unwrap();
    number["found"]["value"].as_f64().unwrap()
}

/// What `idc new` writes is a case as it stands: its readings are in the base's axes, and the improved file leaves nothing missing.
#[test]
fn a_new_file_is_checked_diagnosed_and_improved() {
    let bench = Bench::new("plate_edge_ideal");
    let new = bench.idc(&["new", "postures", "mine/postures.toml"], &[]);
    assert_eq!(new.code, 0, "{}", new.err);
    assert!(new.out.contains("next: idc diagnose mine"), "{}", new.out);
    let checked = bench.idc(&["check", "mine"], &[]);
    assert_eq!(checked.code, 0, "{}", checked.err);
    assert!(checked.out.contains("12 postures"), "{}", checked.out);
    let answer = diagnosed(&bench, "mine");
    assert_eq!(names(&answer), ["unlisted"]);
    assert_eq!(answer["effects"][0]["subsystem"], "wrench_sensor");
    assert!(answer["effects"][0]["confidence"].as_f64().unwrap() <= 0.98);
    let account = account(&bench);
    for words in ["in the base's axes", "set_payload(1.3", "idc predict"] {
        assert!(account.contains(words), "{account}");
    }
    for file in ["improved.toml", "report.html", "fit.svg"] {
        assert!(bench.path("found").join(file).is_file(), "{file}");
    }
    let improved = std::fs::read_to_string(bench.path("found/improved.toml")).unwrap();
    assert!(improved.contains("axes = \"base\""), "{improved}");
    let arguments = [
        "predict",
        "found/improved.toml",
        "mine/postures_stills.csv",
        "--json",
    ];
    let predicted = bench.idc(&arguments, &[]);
    assert_eq!(predicted.code, 0, "{}", predicted.err);
    let said: Value = serde_json::from_str(&predicted.out).unwrap();
    for axis in ["x", "y", "z"] {
        let rms = said["rms"][format!("force_{axis}_n")].as_f64().unwrap();
        assert!(rms < 0.25, "{said}");
    }
    let stills = std::fs::read(bench.path("mine/postures_stills.csv")).unwrap();
    std::fs::create_dir_all(bench.path("again")).unwrap();
    std::fs::write(bench.path("again/postures_stills.csv"), stills).unwrap();
    bench.write("again/postures.toml", improved);
    assert_eq!(diagnosed(&bench, "again")["verdict"], "nothing_missing");
}

#[test]
fn a_turned_sensor_is_named_whatever_columns_are_called() {
    let rows = stills(1, 14, 0.4, 1e3).replace("force_", "F_");
    let file = FILE.to_owned()
        + "[columns]\nforce_x = \"F_x_n\"\nforce_y = \"F_y_n\"\nforce_z = \"F_z_n\"\nforce_unit = \"kN\"\n";
    let bench = bench(&file, &rows);
    let answer = diagnosed(&bench, "wrist");
    assert_eq!(names(&answer), ["wrench_frame_turned"]);
    let angle = &answer["effects"][0]["parameters"]["angle_rad"];
    let [low, high] = ["low", "high"].map(|end| angle[end].as_f64().unwrap());
    assert!(low < 0.4 && 0.4 < high && high - low < 0.1, "{angle}");
    assert!((identified(&answer, "tool_weight_n") - 10.0).abs() < 0.2);
    assert!((identified(&answer, "zero_force_z_n") - 3.0).abs() < 0.2);
}

#[test]
fn what_is_no_case_is_refused_with_one_line_and_nothing_is_written() {
    let refused = |file: &str, rows: &str, expected: &[&str]| {
        let bench = bench(file, rows);
        let outcome = bench.idc(&["diagnose", "wrist", "--out", "found"], &[]);
        assert_eq!(outcome.code, 2, "{}", outcome.err);
        let line = outcome.only_line("error");
        for words in expected {
            assert!(line.contains(words), "{words}: {line}");
        }
        assert!(!bench.path("found").exists());
    };
    let rows = stills(2, 8, 0.0, 1.0);
    let lines: Vec<&str> = rows.lines().collect();
    let of = |first: &str, others: &[&str]| [&[first], others].concat().join("\n") + "\n";
    let row = "0.1,0.1,0.1,0.1,1,2,3,0,0,0";
    let norm = of(lines[0], &[&[row], &lines[1..]].concat());
    refused(FILE, &norm, &["line 2", "norm of 0.200", "expected 1"]);
    let word = norm.replace("0.1,0.1,0.1,0.1", "0,0,zero,1");
    refused(FILE, &word, &["line 2", "quaternion_z", "zero"]);
    let empty = norm.replace("0.1,0.1,0.1,0.1,1", "0,0,0,1,");
    refused(FILE, &empty, &["line 2", "force_x_n", "is empty"]);
    refused(
        FILE,
        &of(lines[0], &lines[1..4]),
        &["3 postures", "at least 4"],
    );
    let still: Vec<String> = (0..8)
        .map(|i| {
            let half = 0.2 * f64::from(i);
            format!("0,0,{:.7},{:.7},1,2,3,0,0,0", half.sin(), half.cos())
        })
        .collect();
    let still: Vec<&str> = still.iter().map(String::as_str).collect();
    refused(FILE, &of(lines[0], &still), &["two axes"]);
    let without = rows.replace("force_y_n", "lateral");
    refused(FILE, &without, &["no column `force_y_n`", "stills.csv"]);
    let millimetres = stills(2, 8, 0.0, 1e3);
    refused(FILE, &millimetres, &["N mm", "force_unit"]);
    let unit = FILE.to_owned() + "[columns]\ntorque_unit = \"lbf ft\"\n";
    refused(&unit, &rows, &["torque_unit", "lbf ft"]);
    let mistyped = FILE.to_owned() + "[wrench_sensor]\ntool_mas_kg = 1\n";
    refused(&mistyped, &rows, &["tool_mas_kg", "tool_mass_kg"]);
}

/// A table alone is no case, and the one message says what to write.
#[test]
fn a_table_alone_is_refused_with_what_to_write() {
    let bench = bench(FILE, &stills(3, 8, 0.0, 1.0));
    std::fs::remove_file(bench.path("wrist/postures.toml")).unwrap();
    let outcome = bench.idc(&["diagnose", "wrist", "--out", "found"], &[]);
    assert_eq!(outcome.code, 2, "{}", outcome.err);
    let line = outcome.only_line("error");
    for words in [
        "stills.csv",
        "postures.toml",
        "wrench_postures",
        "fit = [\"stills.csv\"]",
    ] {
        assert!(line.contains(words), "{line}");
    }
    assert!(!bench.path("found").exists());
}

/// A file of the real sensor beside the project.
fn real() -> Option<(tempfile::TempDir, PosturesCase)> {
    let table = shared("recordings/raw_wrench/stills.csv")?;
    let folder = tempfile::tempdir().unwrap();
    let file = FILE.replace("stills.csv", &table.display().to_string());
    std::fs::write(folder.path().join("postures.toml"), file).unwrap();
    let case = PosturesCase::from_folder(folder.path()).unwrap();
    Some((folder, case))
}

/// Weight, zero and what is left are those of a regression that knew the frame (its numbers stand in the recording's README).
#[test]
fn the_real_sensor_s_readings_are_in_the_base_s_axes() {
    let Some((_folder, case)) = real() else {
        return;
    };
    let found = diagnose(&case.input).unwrap();
    let effect = &found.answer.effects[0];
    assert_eq!(
        (found.answer.effects.len(), effect.name.as_str()),
        (1, "unlisted")
    );
    let headline = &found.answer.details.account.headline;
    assert!(headline.contains("in the base's axes"), "{headline}");
    assert!((0.9..=0.98).contains(&effect.confidence));
    assert!((found.numbers.weight[0] / 12.16 - 1.0).abs() < 0.01);
    for (zero, expected) in found.numbers.zero.iter().zip([-3.47, -4.58, -16.72]) {
        assert!((zero[0] - expected).abs() < 0.3, "{zero:?}");
    }
    let force =
        |m: &&idc_cell::diagnosis::answer::details::ChannelMisfit| m.channel.starts_with("force");
    let misfit = found.answer.details.misfit.iter().filter(force);
    let squares: f64 = misfit.map(|m| m.improved_rms.powi(2)).sum();
    assert!((squares / 3.0).sqrt() < 0.3);
}

/// Ten postures of the hundred, a hundred times.
#[test]
fn ten_postures_of_the_real_sensor_tell_weight_and_zero_within_their_intervals() {
    let Some((_folder, case)) = real() else {
        return;
    };
    let all = &case.input.recordings[0].postures;
    let whole = diagnose(&case.input).unwrap().numbers;
    let mut state = 0x9E37_79B9_7F4A_7C15;
    let (mut near, mut named) = (0, 0);
    let mut held = [0; 4];
    for _ in 0..100 {
        let mut left: Vec<&Posture> = all.iter().collect();
        let drawn = (0..10).map(|_| {
            let place = (uniform(&mut state) * left.len() as f64) as usize;
            *left.swap_remove(place)
        });
        let mut input = PosturesInput {
            nominal: case.input.nominal,
            recordings: case.input.recordings.clone(),
        };
        input.recordings[0].postures = drawn.collect();
        let found = diagnose(&input).unwrap();
        let headline = &found.answer.details.account.headline;
        named += usize::from(headline.contains("in the base's axes"));
        near += usize::from((found.numbers.weight[0] / whole.weight[0] - 1.0).abs() < 0.03);
        let pairs = [
            (found.numbers.weight, whole.weight),
            (found.numbers.zero[0], whole.zero[0]),
            (found.numbers.zero[1], whole.zero[1]),
            (found.numbers.zero[2], whole.zero[2]),
        ];
        for (held, ([_, low, high], [truth, ..])) in held.iter_mut().zip(pairs) {
            *held += usize::from(low <= truth && truth <= high);
        }
    }
    println!(
        "frame named in {named}, weight within 3 % in {near}, intervals of weight and zero hold {held:?} of 100"
    );
    assert!(near >= 95 && named >= 95, "{near}, {named}");
    assert!(held.iter().all(|held| *held >= 90), "{held:?}");
}
