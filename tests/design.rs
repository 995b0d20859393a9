//! `idc design`: planted optima, the same bytes each time, refusals.

use idc_cell::app::ScenarioEvaluator;
use idc_cell::design::{self, Evaluate};

use crate::common::project;
use crate::program::{Bench, Outcome};

/// A surface that moves by 4 mm, eight times a second, under a device whose orifices are all but closed: two springs of air.
const SHAKEN: &str = r#"schema = 1
kind = "bench"
title = "shaken"
[device]
ideal = true
model = "device.toml"
[device.override]
supply_orifice_mm2 = 0.1
exhaust_orifice_mm2 = 0.1
moving_mass_kg = 0.5
[bench]
duration_s = 9
start_stroke_mm = 25
[load]
kind = "surface"
position_mm = 27
peak_to_peak_mm = 4
frequency_hz = 8
start_s = 8
[[command]]
at_s = 0
force_n = 150
"#;

const STUDY: &str = r#"schema = 1
[study]
title = "planted"
scenarios = ["shaken.toml"]
evaluations = 100
[variables.dead_volume_cm3]
min = 20
max = 60
start = 40
"#;

const MASS: &str = "[variables.moving_mass_kg]\nmin = 1\nmax = 6\nstart = 4\n";

/// A folder with `study.toml` and the scenario that it names.
fn folder(study: &str) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("shaken.toml", SHAKEN);
    bench.write("study.toml", study);
    bench
}

fn run(bench: &Bench, threads: Option<&str>) -> Outcome {
    let environment: Vec<(&str, &str)> = threads
        .map(|count| ("RAYON_NUM_THREADS", count))
        .into_iter()
        .collect();
    bench.idc(
        &["design", "study.toml", "--out", "out", "--force"],
        &environment,
    )
}

/// design.json of a study that is done.
fn result(study: &str) -> serde_json::Value {
    let bench = folder(study);
    let outcome = run(&bench, None);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    serde_json::from_slice(&std::fs::read(bench.path("out/design.json")).unwrap()).unwrap()
}

#[test]
fn a_softer_spring_of_air_is_wanted_up_to_its_bound() {
    let result = result(STUDY);
    assert_eq!(result["chosen"]["design"]["dead_volume_cm3"], 60.0);
    let bounds = result["active_bounds"].as_array().unwrap();
    assert_eq!(bounds.len(), 1);
    assert_eq!(
        (&bounds[0]["variable"], &bounds[0]["side"]),
        (&"dead_volume_cm3".into(), &"max".into())
    );
    assert!(bounds[0]["objective_change_percent"].as_f64().unwrap() < -1.0);
    let of = |design: &str| result[design]["objective"].as_f64().unwrap();
    assert!(of("chosen") < 0.9 * of("start"));
}

/// At one mass the force that accelerates it is what the springs of air give: M w^2 = p1 A1^2 / V1 + p2 A2^2 / V2.
#[test]
fn the_mass_that_swings_with_the_air_is_found() {
    let study = STUDY.replace(
        "[variables.dead_volume_cm3]\nmin = 20\nmax = 60\nstart = 40\n",
        MASS,
    );
    let result = result(&study);
    let quarter = std::f64::consts::FRAC_PI_4;
    let areas = [
        2.0 * quarter * 0.032_f64.powi(2),
        2.0 * quarter * (0.032_f64.powi(2) - 0.012_f64.powi(2)),
    ];
    let pressures = [101_325.0 + 150.0 / areas[0], 101_325.0];
    // The middle of the motion, 2 mm from the surface's outer end and 1 mm into it.
    let volumes = [20e-6 + areas[0] * 0.026, 20e-6 + areas[1] * 0.024];
    let spring = |i: usize| pressures[i] * areas[i] * areas[i] / volumes[i];
    let expected = (spring(0) + spring(1)) / (16.0 * std::f64::consts::PI).powi(2);
    let found = result["chosen"]["design"]["moving_mass_kg"]
        .as_f64()
        .unwrap();
    assert!(
        (found / expected - 1.0).abs() < 0.02,
        "{found} kg, expected {expected} kg"
    );
    assert_eq!(result["active_bounds"].as_array().unwrap().len(), 0);
}

#[test]
fn a_study_gives_the_same_bytes_again_and_on_one_thread() {
    let study = STUDY.replace(
        "[variables.dead_volume_cm3]",
        "[objective]\ntrade_off = \"bore_mm\"\n[variables.bore_mm]\nmin = 25\nmax = 40\nstart = 32\n[variables.dead_volume_cm3]",
    );
    let bench = folder(&study);
    bench.replace("shaken.toml", "duration_s = 9", "duration_s = 2");
    bench.replace("shaken.toml", "start_s = 8", "start_s = 1");
    let files = |threads: Option<&str>| {
        let outcome = run(&bench, threads);
        assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
        let names = bench.names_in("out");
        assert_eq!(
            names,
            ["design.json", "front.svg", "override.toml", "report.html"]
        );
        let read = |name: &String| std::fs::read(bench.path("out").join(name)).unwrap();
        (names.iter().map(read).collect::<Vec<_>>(), outcome.out)
    };
    let first = files(None);
    assert!(first == files(None));
    assert!(first == files(Some("1")));
    assert!(first == files(Some("3")));
    // What is pasted is what was simulated.
    let overrides = String::from_utf8(first.0[2].clone()).unwrap();
    let keys = overrides.split_once("[device.override]\n").unwrap().1;
    bench.replace(
        "shaken.toml",
        "[device.override]\n",
        &format!("[device.override]\n{keys}"),
    );
    let outcome = bench.idc(&["run", "shaken.toml", "--out", "run", "--json"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let summary: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    let design: serde_json::Value = serde_json::from_slice(&first.0[0]).unwrap();
    assert_eq!(
        summary["summary"]["coefficient_of_variation_percent"],
        design["chosen"]["objective"]
    );
}

#[test]
fn designs_that_fail_are_counted_and_the_search_goes_on() {
    let study = STUDY.to_owned() + "[variables.rod_mm]\nmin = 6\nmax = 60\nstart = 12\n";
    let result = result(&study);
    let failed = &result["infeasible"]["shaken: device.override.rod_mm refused"];
    assert!(failed.as_u64().unwrap() > 5, "{}", result["infeasible"]);
    assert!(result["chosen"]["design"]["rod_mm"].as_f64().unwrap() < 32.0);
}

#[test]
fn a_cell_is_simulated_as_idc_run_does_it() {
    let study = STUDY.replace("shaken", "scenario").replace(
        "[variables.dead_volume_cm3]",
        "[variables.bore_mm]\ncatalogue = [10, 32]\nstart = 32\n[variables.dead_volume_cm3]",
    );
    let bench = folder(&study.replace("start = 40", "start = 20"));
    assert_eq!(bench.run().code, 0);
    let study = design::load(&bench.path("study.toml")).unwrap();
    let evaluator = ScenarioEvaluator::new(&study).unwrap();
    let outcome = evaluator.evaluate(&study.starting_design()).unwrap();
    let summary = &bench.summary()["summary"];
    let found = &outcome.scenarios[0].metrics;
    assert!(found.len() > 15, "{found:?}");
    for (name, value) in found {
        // Reading JSON rounds the last digit.
        let expected = summary[name].as_f64().unwrap();
        assert!(
            (value - expected).abs() <= 1e-12 * expected.abs(),
            "{name}: {value}, expected {expected}"
        );
    }
    assert!(!found.contains_key("wall_time_s"));
    // 4 kg on an axis that leans by 45 degrees, at most 6 bar on 1608 mm2.
    let weight = 39.24 * std::f64::consts::FRAC_1_SQRT_2;
    let range = outcome.force_range;
    assert!((range[0] - weight).abs() < 0.01, "{range:?}");
    assert!((range[1] - 965.097 - weight).abs() < 0.01, "{range:?}");
    let small = evaluator
        .evaluate(&study.design(&[10.0, 20.0]))
        .unwrap_err();
    assert_eq!(small.reason, "scenario: the supply cannot give the force");
    assert!(small.detail.contains("process.force_n"), "{}", small.detail);
}

fn refused(spoil: impl Fn(&Bench), code: i32, words: &str) {
    let bench = folder(STUDY);
    spoil(&bench);
    let before = bench.contents();
    let outcome = run(&bench, None);
    let line = outcome.only_line("error: ");
    assert!(line.starts_with(&format!("error: {words}")), "{line}");
    assert_eq!(outcome.code, code, "{line}");
    assert_eq!(
        (outcome.sentences().as_str(), outcome.out.as_str()),
        (line, "")
    );
    if code == 2 {
        assert!(before == bench.contents(), "files changed: {line}");
    }
}

#[test]
fn bad_studies_are_refused_by_place() {
    let edits = [
        (
            "\"shaken.toml\"",
            "\"shaken.toml\", \"nowhere.toml\"",
            "study.toml:4:29: `study.scenarios[1]` is \"nowhere.toml\", expected an existing file",
        ),
        (
            "dead_volume_cm3",
            "dead_volumes_cm3",
            "study.toml:6:12: unknown key `variables.dead_volumes_cm3`; ",
        ),
        (
            "min = 20\nmax = 60",
            "min = 60\nmax = 20",
            "study.toml:7:1: `variables.dead_volume_cm3.min` is 60, expected less than max, 20",
        ),
        (
            "min = 20\nmax = 60",
            "catalogue = []",
            "study.toml:7:1: `variables.dead_volume_cm3.catalogue` is [], expected at least one entry",
        ),
        (
            "min = 20\nmax = 60\nstart = 40",
            "min = 20\nmax = 60000\nstart = 40000",
            "study.toml:6:12: `variables.dead_volume_cm3` does not fit a scenario of the study: shaken.toml: `device.override.dead_volume_cm3` is 40000 cm3, expected 0.01 to 5000 cm3",
        ),
        (
            "dead_volume_cm3",
            "\"controller.proportional_gain\"",
            "study.toml:6:12: `variables.controller.proportional_gain` does not fit a scenario of the study: shaken.toml: ",
        ),
        (
            "[variables.",
            "[objective]\nminimise = \"smoothness\"\n[variables.",
            "study.toml:7:1: `objective.minimise` names the metric `smoothness`, which no scenario gives",
        ),
    ];
    for (from, to, words) in edits {
        refused(|bench| bench.replace("study.toml", from, to), 2, words);
    }
    refused(
        |bench| bench.replace("shaken.toml", "position_mm", "positron_mm"),
        2,
        "shaken.toml:16:1: unknown key `load.positron_mm`",
    );
    refused(
        |bench| std::fs::remove_file(bench.path("study.toml")).unwrap(),
        2,
        "there is no file study.toml",
    );
    refused(
        |bench| bench.write("out", "in the way"),
        2,
        "cannot write into the output folder out: there is a file of that name",
    );
}

#[test]
fn limits_that_no_design_keeps_end_with_exit_code_1() {
    let limits = "[limits]\ncoefficient_of_variation_percent = { max = 0.01 }\n[variables.";
    refused(
        |bench| bench.replace("study.toml", "[variables.", limits),
        1,
        "no design within the bounds keeps the limits: the best of ",
    );
}

/// A burr of 30 mm of the plate's edge, taken off by a ball that turns.
const BURRED: &str = r#"schema = 1
[study]
title = "burred"
scenarios = ["burred.toml"]
evaluations = 200
[objective]
minimise = "duration_s"
[limits]
residual_burr_share_percent = { max = 0 }
chamfer_leg_mean_mm = { min = 0.2, max = 0.6 }
[variables."process.feed_mm_per_s"]
min = 15
max = 100
start = 30
scale = "log"
[variables."process.lean_deg"]
min = -20
max = 20
start = 0
[variables."process.passes"]
catalogue = [1, 2, 3]
start = 2
[variables."tool.spindle_speed_rpm"]
min = 10000
max = 24000
start = 20000
"#;

fn burred(study: &str) -> Bench {
    let bench = folder(study);
    let text = std::fs::read_to_string(project("scenarios/studies/burred_plate.toml")).unwrap();
    let text = text
        .replace("../../models/arm/arm10.urdf", "arm.urdf")
        .replace("../../models/device.toml", "device.toml")
        .replace("../../assets/plate.stl", "part.stl")
        .replace("end_mm = 290", "end_mm = 40");
    bench.write("burred.toml", text);
    bench
}

#[test]
fn passes_lean_and_spindle_speed_are_the_designer_s_to_choose() {
    let bench = burred(BURRED);
    let study = design::load(&bench.path("study.toml")).unwrap();
    let evaluator = ScenarioEvaluator::new(&study).unwrap();
    let of = |feed: f64, lean: f64, passes: f64, speed: f64| {
        let design = study.design(&[feed, lean, passes, speed]);
        let outcome = evaluator.evaluate(&design).unwrap();
        let metrics = &outcome.scenarios[0].metrics;
        ["duration_s", "removed_volume_mm3"].map(|name| metrics[name])
    };
    let start = of(30.0, 0.0, 2.0, 20_000.0);
    let once = of(30.0, 0.0, 1.0, 20_000.0);
    let slower = of(30.0, 0.0, 2.0, 10_000.0);
    let leaned = of(30.0, 20.0, 2.0, 20_000.0);
    // Each pass takes about as long and as much; what comes off goes with the speed, and the force that wears is the same along the normal.
    assert!(
        once[0] < 0.62 * start[0] && once[0] > 0.4 * start[0],
        "{once:?} {start:?}"
    );
    assert!(
        (once[1] / start[1] - 0.5).abs() < 0.05,
        "{once:?} {start:?}"
    );
    assert!(
        (slower[1] / start[1] - 0.5).abs() < 0.05,
        "{slower:?} {start:?}"
    );
    assert!(
        leaned[1] != start[1] && (leaned[0] - start[0]).abs() < 0.3,
        "{leaned:?}"
    );
}

#[test]
fn a_tolerance_that_no_feed_meets_ends_with_exit_code_1_and_one_message() {
    let study = BURRED.replace("min = 0.2, max = 0.6", "min = 4, max = 5");
    let (head, _) = study
        .split_once("[variables.\"process.lean_deg\"]")
        .unwrap();
    let bench = burred(head);
    let outcome = bench.idc(
        &[
            "design",
            "study.toml",
            "--out",
            "out",
            "--evaluations",
            "20",
        ],
        &[],
    );
    let line = outcome.only_line("error: ");
    let words = "error: no design within the bounds keeps the limits: the best of ";
    assert!(
        line.starts_with(words) && line.contains("chamfer_leg_mean_mm at least 4 mm by"),
        "{line}"
    );
    assert_eq!(
        (
            outcome.code,
            outcome.out.as_str(),
            outcome.sentences().as_str()
        ),
        (1, "", line)
    );
    assert!(!bench.path("out/design.json").exists());
}

#[test]
fn draws_at_the_chosen_design_are_the_same_on_any_number_of_threads() {
    let study = STUDY.replace("evaluations = 100", "evaluations = 50")
        + "[limits]\ncoefficient_of_variation_percent = { max = 100 }\n[robustness]\nruns = 12\n[robustness.variables.axial_load_n]\nmin = 0\nmax = 40\n[robustness.variables.\"load.frequency_hz\"]\nmean = 8\nstandard_deviation = 0.5\n";
    let bench = folder(&study);
    let files = |threads: &str| {
        let outcome = run(&bench, Some(threads));
        assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
        let names = ["design.json", "robustness.svg", "report.html"];
        let read = |name: &str| std::fs::read(bench.path("out").join(name)).unwrap();
        (names.map(read), outcome.out)
    };
    let first = files("1");
    assert!(first == files("3"));
    let result: serde_json::Value = serde_json::from_slice(&first.0[0]).unwrap();
    let robustness = &result["robustness"];
    assert_eq!(robustness["draws"].as_array().unwrap().len(), 12);
    assert_eq!(robustness["all_limits"]["kept"], 12);
    // A load moves the force, and with it the variation.
    let reported = &robustness["quantiles"][0];
    assert!(
        reported["percent_95"].as_f64() > reported["percent_5"].as_f64(),
        "{reported}"
    );
    let page = String::from_utf8(first.0[2].clone()).unwrap();
    assert!(page.contains("Robustness") && page.contains("normal, mean 8, standard deviation 0.5"));
    // The bench's device has values that nobody has measured in public.
    let assumed = result["judged"].as_array().unwrap();
    let is_assumed = |key: &str| assumed.iter().any(|value| value["key"] == key);
    assert!(is_assumed("device.supply_pressure_bar_gauge") && !is_assumed("device.bore_mm"));
    assert!(page.contains("These numbers rest on values"));
    // What a draw would be refused for is reported before anything is searched.
    bench.replace("study.toml", "max = 40", "max = 40000");
    let outcome = run(&bench, None);
    let line = outcome.only_line("error: ");
    let words = "study.toml:14:23: `robustness.variables.axial_load_n` draws 39960, which a scenario of the study does not take: shaken.toml: `device.override.axial_load_n` is 39960 N, expected -2000 to 2000 N";
    assert!(outcome.code == 2 && line.ends_with(words), "{line}");
}

#[test]
fn the_picture_of_another_study_does_not_stay() {
    let bench = folder(&STUDY.replace("evaluations = 100", "evaluations = 50"));
    std::fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/front.svg", "old");
    bench.write("out/robustness.svg", "old");
    bench.write("out/mine.txt", "mine");
    let outcome = bench.idc(
        &["design", "study.toml", "--out", "out", "--force", "--json"],
        &[],
    );
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    assert_eq!(
        bench.names_in("out"),
        ["design.json", "mine.txt", "override.toml", "report.html"]
    );
    let document = std::fs::read_to_string(bench.path("out/design.json")).unwrap();
    assert_eq!(outcome.out.trim_end(), document.trim_end());
}

#[test]
fn the_study_shipped_takes_its_scenarios() {
    let study = design::load(&project("scenarios/studies/device_design.toml")).unwrap();
    let evaluator = ScenarioEvaluator::new(&study).unwrap();
    design::check_start(&study, &evaluator).unwrap();
}
