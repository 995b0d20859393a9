//! `idc next` and `idc investigate`: experiments of the program's own choice, carried out by a rig that is a program.

use std::path::Path;

use idc_cell::recording::csv::read_csv;
use idc_cell::recording::parquet::read_parquet;
use idc_cell::recording::schema;
use idc_cell::scenario::rig_file::load_rig;

use crate::common::project;
use crate::program::Bench;

/// The first half second of one recording of a laboratory case: too little to know what is missing.
fn begun(case: &str, limits: &str) -> Bench {
    begun_with(case, limits, 120)
}

/// As much of it as so many lines hold: of fewer than 90 of case-10 the tool touches nothing.
fn begun_with(case: &str, limits: &str, lines: usize) -> Bench {
    let bench = Bench::new("paper_step");
    let from = project(&format!("assets/proof/cases/{case}"));
    let rig = std::fs::read_to_string(from.join("rig.toml")).unwrap();
    let kept = rig.lines().filter(|line| !line.starts_with("predict"));
    let kept = kept.map(|line| match line.starts_with("fit") {
        true => "fit = [\"stairs.csv\"]",
        false => line,
    });
    let rig = kept.collect::<Vec<_>>().join("\n") + "\n" + limits;
    let stairs = std::fs::read_to_string(from.join("stairs.csv")).unwrap();
    let stairs: Vec<&str> = stairs.lines().take(lines).collect();
    std::fs::create_dir(bench.path("case")).unwrap();
    bench.write("case/rig.toml", rig);
    bench.write("case/stairs.csv", stairs.join("\n") + "\n");
    bench
}

/// A rig that is a shell script.
pub fn rig(bench: &Bench, script: &str) {
    use std::os::unix::fs::PermissionsExt as _;
    let program = env!("CARGO_BIN_EXE_idc");
    bench.write("rig.sh", format!("#!/bin/sh\nIDC={program}\n{script}\n"));
    let mode = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(bench.path("rig.sh"), mode).unwrap();
}

/// The device of a laboratory case.
fn laboratory(case: &str) -> String {
    format!("exec \"$IDC\" laboratory --rig {case} \"$1\" \"$2\"")
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The bench that is written does what the inputs ask for, sample by sample, and keeps the limits of the rig file, which are narrower than the recording.
#[test]
fn an_experiment_is_written_as_something_that_runs_within_limits() {
    let limits = "\n[limits]\nset_pressure_pa = 90000.0\nset_pressure_rate_pa_per_s = 1e6\nsurface_least_m = 0.021\nsurface_most_m = 0.028\nsurface_speed_m_per_s = 0.05\nsurface_acceleration_m_per_s2 = 1.0\nsolenoid = true\nforce_n = 160.0\nduration_s = 3.0\n";
    let bench = begun("case-10", limits);
    let words = [
        "next",
        "case",
        "--out",
        "next",
        "--programmes",
        "24",
        "--seed",
        "4",
        "--quiet",
    ];
    let done = bench.idc(&words, &[]);
    assert_eq!((done.code, done.out.as_str()), (0, ""), "{}", done.err);
    assert_eq!(
        bench.names_in("next"),
        [
            "bench.toml",
            "device.toml",
            "expected.svg",
            "inputs.csv",
            "instructions.txt",
            "next.json",
            "report.html"
        ]
    );
    let inputs = read_csv(&bench.path("next/inputs.csv")).unwrap().recording;
    let time = inputs.time();
    assert!(time[time.len() - 1] <= 3.0 + 1e-9);
    let asked = |quantity: &str| inputs.values(quantity).unwrap();
    let pressures = asked(schema::SET_PRESSURE_GAUGE);
    assert!(pressures.iter().all(|p| (0.0..=9e4).contains(p)));
    // A pressure is held for 50 ms.
    let steps = pressures.windows(2).map(|two| (two[1] - two[0]).abs());
    assert!(steps.fold(0.0, f64::max) <= 5e4 + 1.0);
    let surfaces = asked(schema::SURFACE_POSITION);
    let within = |place: &f64| (0.021 - 1e-6..=0.028 + 1e-6).contains(place);
    assert!(surfaces.iter().all(|place| place.is_nan() || within(place)));
    let next = json(&bench.path("next/next.json"));
    assert!(next["largest_force_n"].as_f64().unwrap() <= 160.0);
    let probabilities = next["explanations"].as_array().unwrap().iter();
    let sum: f64 = probabilities
        .map(|own| own["probability"].as_f64().unwrap())
        .sum();
    let none = next["none_of_these"].as_f64().unwrap();
    let all = sum + none;
    assert!((all - 1.0).abs() < 1e-3, "{all}");
    // What the report states of the range is counted.
    let report = std::fs::read_to_string(bench.path("next/report.html")).unwrap();
    let (_, beyond) = report.split_once("its probability, ").unwrap();
    let end = beyond
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap();
    let percent: f64 = beyond[..end].parse().unwrap();
    assert!(
        percent > 0.0 && none >= 0.005 + 0.01 * percent - 1e-3,
        "{none}, {percent} %"
    );

    assert_bench_carries_out(&bench, time, pressures);
}

/// The bench of an experiment, run, has its set pressures and the strokes that its device predicts.
fn assert_bench_carries_out(bench: &Bench, time: &[f64], pressures: &[f64]) {
    let run = bench.idc(
        &[
            "run",
            "next/bench.toml",
            "--out",
            "run",
            "--quiet",
            "--no-recording",
        ],
        &[],
    );
    assert_eq!(run.code, 0, "{}", run.err);
    let samples = read_parquet(&bench.path("run/samples.parquet"))
        .unwrap()
        .recording;
    let own = |quantity: &str, time: f64| {
        let at = samples.time().partition_point(|t| *t <= time + 1e-9) - 1;
        samples.values(quantity).unwrap()[at]
    };
    // The device is the best explanation, which may hold the atmosphere to be another.
    let device = load_rig(&bench.path("next/device.toml")).unwrap().plant;
    let atmosphere = device.device.gas.atmosphere;
    for (place, time) in time.iter().enumerate().take(time.len() - 1) {
        // A command acts with the step that follows it.
        let found = own(schema::SET_PRESSURE, time + 2e-3) - atmosphere;
        assert!(
            (found - pressures[place]).abs() < 1.0,
            "{time} s: {found} {}",
            pressures[place]
        );
    }
    let device = bench.path("next/device.toml");
    let words = [
        "predict",
        device.to_str().unwrap(),
        "next/inputs.csv",
        "--out",
        "predicted.csv",
        "--quiet",
    ];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    let predicted = read_csv(&bench.path("predicted.csv"));
    let text = std::fs::read_to_string(bench.path("predicted.csv")).unwrap();
    assert!(predicted.is_err(), "a prediction has no inputs");
    let mut rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let at = rows
        .next()
        .unwrap()
        .iter()
        .position(|name| *name == "stroke_m")
        .unwrap();
    let strokes: Vec<f64> = rows.map(|row| row[at].parse().unwrap()).collect();
    let most = strokes.iter().copied().fold(0.0, f64::max);
    let off = time
        .iter()
        .zip(&strokes)
        .map(|(time, stroke)| (own(schema::STROKE, *time) - stroke).abs());
    let off = off.fold(0.0, f64::max);
    assert!(
        off < 0.01 * most,
        "bench and prediction differ by {off} m of {most} m"
    );
}

/// Half a second leaves a delay open with any of many things beside it, and the delay alone unlikely; what the device is asked next shows that it is alone.
#[test]
fn a_rig_that_is_a_program_is_asked_until_it_is_settled() {
    let bench = begun("case-03", "");
    rig(&bench, &laboratory("case-03"));
    let words = [
        "investigate",
        "case",
        "--rig",
        "./rig.sh",
        "--programmes",
        "60",
        "--time",
        "5s",
        "--out",
        "asked",
        "--json",
    ];
    let done = bench.idc(&words, &[]);
    assert_eq!(done.code, 0, "{}", done.err);
    let record: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let first = record["odds"][0]["explanations"][0]["probability"]
        .as_f64()
        .unwrap();
    assert!(first < 0.5, "{first}");
    let last = record["odds"].as_array().unwrap().last().unwrap();
    let best = &last["explanations"][0];
    assert_eq!(best["effects"], "transport_delay", "{record:#}");
    assert!(best["probability"].as_f64().unwrap() > 0.95);
    assert_eq!(record["stop"], "settled");
    // The case that has grown comes to the same by itself.
    let runs = record["asked"].as_array().unwrap().len();
    assert_eq!(bench.names_in("asked/case").len(), 2 + runs);
    let again = bench.idc(
        &["diagnose", "asked/case", "--out", "again", "--quiet"],
        &[],
    );
    assert_eq!(again.code, 0, "{}", again.err);
    let again = json(&bench.path("again/diagnosis.json"));
    assert_eq!(again["effects"][0]["name"], "transport_delay");
    assert_eq!(again["effects"].as_array().unwrap().len(), 1);
}

/// A diagnosis takes a recording in that comes to it, with what it comes to from the beginning; and says so where it cannot go on.
#[test]
fn a_diagnosis_goes_on_with_a_recording_more() {
    let bench = begun("case-05", "");
    let ok = |words: &[&str]| {
        let done = bench.idc(words, &[]);
        assert_eq!(done.code, 0, "{words:?}: {}", done.err);
        done.err
    };
    ok(&["diagnose", "case", "--out", "found", "--quiet"]);
    // The next experiment of a diagnosis is that of its case.
    let few = ["--programmes", "2", "--time", "3s", "--quiet"];
    ok(&[&["next", "found", "--out", "next"], &few[..]].concat());
    let next = json(&bench.path("next/next.json"));
    ok(&[&["next", "case", "--out", "same"], &few[..]].concat());
    let same = json(&bench.path("same/next.json"));
    let best = |next: &serde_json::Value| next["explanations"][0]["effects"].clone();
    assert_eq!(best(&next), best(&same));
    ok(&[
        "laboratory",
        "--rig",
        "case-05",
        "next/inputs.csv",
        "more.csv",
    ]);
    let with = ["diagnose", "case", "--with-recording", "more.csv"];
    let said = ok(&[&with[..], &["--out", "found", "--quiet"]].concat());
    assert!(!said.contains("from the beginning"), "{said}");
    ok(&[&with[..], &["--out", "anew", "--quiet"]].concat());
    let [on, anew] =
        ["found", "anew"].map(|own| json(&bench.path(&format!("{own}/diagnosis.json"))));
    let named = |answer: &serde_json::Value| -> Vec<(String, f64)> {
        let effects = answer["effects"].as_array().unwrap().iter();
        effects
            .map(|own| {
                let name = own["name"].as_str().unwrap().to_owned();
                (name, own["confidence"].as_f64().unwrap())
            })
            .collect()
    };
    let [on, anew] = [&on, &anew].map(named);
    assert_eq!(on.len(), anew.len(), "{on:?} {anew:?}");
    for ((name, odds), (other, expected)) in on.iter().zip(&anew) {
        assert_eq!(name, other);
        assert!((odds - expected).abs() < 0.02, "{name}: {odds} {expected}");
    }
    // Another sheet is another case.
    let rig = std::fs::read_to_string(bench.path("case/rig.toml")).unwrap();
    bench.write("case/rig.toml", format!("{rig}\n# Measured anew.\n"));
    let again = [&with[..], &["--out", "found", "--quiet"]].concat();
    let refused = bench.idc(&again, &[]);
    assert_eq!(refused.code, 2, "{}", refused.err);
    assert!(refused.only_line("error").contains("--force"));
    let said = ok(&[&again[..], &["--force"]].concat());
    assert!(said.contains("rig.toml has changed"), "{said}");
}

/// Whatever a rig's program does wrong is one message, and ends with exit code 2.
#[test]
fn a_rig_that_does_otherwise_is_refused_with_what_it_did() {
    let twice = "sed 's/^\\(0\\.[0-9]*\\),\\([0-9]*\\)/\\1,1\\2/' \"$1\" > other.csv; exec \"$IDC\" laboratory --rig case-10 other.csv \"$2\"";
    for (script, patience, expected) in [
        (
            "echo no air >&2; exit 7",
            "1min",
            vec!["exit code 7", "no air", "expected 0"],
        ),
        (
            "exit 0",
            "1min",
            vec!["recording.csv was not written", "regulator_pressure_pa"],
        ),
        (
            "sleep 30",
            "1s",
            vec!["no recording after 1 s", "--patience"],
        ),
        (
            "echo too hard >&2; exit 3",
            "1min",
            vec!["refused", "too hard", "[limits]"],
        ),
        (twice, "1min", vec!["set_pressure_pa", "asked for"]),
    ] {
        let bench = begun_with("case-10", "", 90);
        rig(&bench, script);
        let words = [
            "investigate",
            "case",
            "--rig",
            "./rig.sh",
            "--programmes",
            "3",
            "--until",
            "0.999",
            "--patience",
            patience,
            "--out",
            "asked",
            "--quiet",
        ];
        let refused = bench.idc(&words, &[]);
        assert_eq!(refused.code, 2, "{script}: {}", refused.err);
        let line = refused.only_line("error");
        for words in expected {
            assert!(line.contains(words), "{words:?} is not in {line}");
        }
        assert!(!bench.path("asked/investigation.json").exists());
    }
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let contradiction = "\n[limits]\nsurface_least_m = 0.03\nsurface_most_m = 0.02\n";
    for (limits, more, expected) in [
        (
            "\n[limits]\nsurface_least_m = 0.021\nstroke_m = 0.01\n",
            vec![],
            vec!["stroke_m", "rig.toml", "at least surface_least_m"],
        ),
        (
            contradiction,
            vec![],
            vec!["surface_most_m", "at least surface_least_m"],
        ),
        (
            "\n[limits]\nforce_n = 1e-6\nsurface_least_m = 0.021\nsurface_most_m = 0.028\n",
            vec!["--may", "surface"],
            vec!["force_n", "[limits]"],
        ),
        (
            "",
            vec!["--may", "surface"],
            vec!["nothing may be moved", "surface"],
        ),
        (
            "\n[limits]\nset_pressur_pa = 1\n",
            vec![],
            vec!["limits.set_pressur_pa", "set_pressure_pa"],
        ),
    ] {
        let bench = begun("case-10", limits);
        let mut words = vec![
            "next",
            "case",
            "--out",
            "next",
            "--programmes",
            "3",
            "--quiet",
        ];
        words.extend(more);
        let refused = bench.idc(&words, &[]);
        assert_eq!(refused.code, 2, "{limits}: {}", refused.err);
        let line = refused.only_line("error");
        for words in expected {
            assert!(line.contains(words), "{words:?} is not in {line}");
        }
        assert!(!bench.path("next/next.json").exists());
    }
    let arm = project("assets/first");
    let bench = Bench::new("paper_step");
    let refused = bench.idc(&["next", arm.to_str().unwrap(), "--out", "next"], &[]);
    assert_eq!(refused.code, 2, "{}", refused.out);
}
