//! Results that version 0.1.0 wrote are read by today's program; its plans, whose tasks are named by the program, are refused by version.

use std::path::{Path, PathBuf};

use crate::common::project;
use crate::program::Bench;

/// A copy of the stored results beside a job of today.
fn stored() -> (Bench, PathBuf) {
    let bench = Bench::new("plate_edge_ideal");
    let copy = bench.path("old");
    for name in ["run", "diagnosis", "sweep"] {
        std::fs::create_dir_all(copy.join(name)).unwrap();
        let folder = project("tests/results_0_1_0").join(name);
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            std::fs::copy(&path, copy.join(name).join(path.file_name().unwrap())).unwrap();
        }
    }
    (bench, copy)
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn they_are_of_the_version_that_they_are_taken_for() {
    let (_bench, folder) = stored();
    let program = |file: &str| json(&folder.join(file))["provenance"]["program"].clone();
    assert_eq!(program("run/summary.json"), "idc 0.1.0");
    assert_eq!(program("diagnosis/diagnosis.json"), "idc 0.1.0");
    assert_ne!(env!("CARGO_PKG_VERSION"), "0.1.0");
}

#[test]
fn a_page_is_made_of_each_and_says_which_version_made_the_result() {
    let (bench, folder) = stored();
    for name in ["run", "diagnosis", "sweep"] {
        let outcome = bench.idc(&["report", &format!("old/{name}")], &[]);
        assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{name}");
        let page = std::fs::read_to_string(folder.join(name).join("report.html")).unwrap();
        assert!(page.contains("idc 0.1.0"), "{name}");
    }
}

#[test]
fn an_old_run_is_compared_with_itself_and_its_numbers_are_read() {
    let (bench, folder) = stored();
    let outcome = bench.idc(&["compare", "old/run", "old/run"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let summary = json(&folder.join("run/summary.json"));
    let stroke = summary["summary"]["stroke_max_mm"].as_f64().unwrap();
    assert!(stroke > 0.0);
    let shown = outcome
        .out
        .lines()
        .find(|line| line.contains("largest stroke"));
    let shown = shown.unwrap_or_else(|| panic!("{}", outcome.out));
    let digits: Vec<f64> = shown
        .split_whitespace()
        .filter_map(|w| w.parse().ok())
        .collect();
    assert!((digits[0] - stroke).abs() < 5e-3, "{shown}: {stroke}");
}

#[test]
fn a_plan_of_another_version_is_refused() {
    let (bench, folder) = stored();
    let plan = std::fs::read_to_string(folder.join("sweep/plan.jsonl")).unwrap();
    let task: serde_json::Value = serde_json::from_str(plan.lines().nth(1).unwrap()).unwrap();
    let id = task["id"].as_str().unwrap();
    let outcome = bench.idc(&["task", "old/sweep/plan.jsonl", id], &[]);
    assert_eq!(outcome.code, 2, "{}{}", outcome.out, outcome.err);
    assert!(outcome.err.contains("idc 0.1.0"), "{}", outcome.err);
}
