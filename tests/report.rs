//! Pages of results: what they say, that they come again from the files alone, and how damaged folders are refused.

use std::fs;

use crate::common::project;
use crate::program::Bench;

/// A bench with a diagnosis of one of the project's cases in `found`.
fn diagnosed(case: &str) -> Bench {
    let bench = Bench::new("paper_step");
    let case = project(&format!("assets/proof/cases/{case}"));
    let words = [
        "diagnose",
        case.to_str().unwrap(),
        "--out",
        "found",
        "--quiet",
    ];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    bench
}

#[test]
fn the_page_of_a_diagnosis_says_what_is_missing_and_comes_again_from_its_files() {
    let bench = diagnosed("case-02");
    let page = fs::read(bench.path("found/report.html")).unwrap();
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
    let text = String::from_utf8(page.clone()).unwrap();
    for said in [
        "Diagnosis of case-02",
        "Missing: coulomb viscous friction.",
        "Seals and guides rub",
        "What each link lacks",
        "not fitted to",
        "Other explanations",
        "What to record next",
        "Provenance",
    ] {
        assert!(text.contains(said), "{said}");
    }
    let outcome = bench.idc(&["report", "found", "--json"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let told: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    assert_eq!(told["kind"], "diagnosis");
    assert!(fs::read(bench.path("found/report.html")).unwrap() == page);
    // Elsewhere, and not over what stands there.
    let words = ["report", "found", "--out", "mine.html"];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    assert!(fs::read(bench.path("mine.html")).unwrap() == page);
    let outcome = bench.idc(&words, &[]);
    assert_eq!(outcome.code, 2);
    outcome.only_line("error: mine.html");
}

#[test]
fn a_case_with_nothing_missing_gets_a_page_that_says_so() {
    let bench = diagnosed("case-01");
    let text = fs::read_to_string(bench.path("found/report.html")).unwrap();
    assert!(text.contains("Nothing is missing.") && !text.contains("Missing:"));
}

#[test]
fn the_page_of_a_run_comes_again_and_names_bounds_that_were_not_kept() {
    let bench = Bench::new("paper_step");
    let words = ["run", "scenario.toml", "--out", "out", "--quiet"];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    let page = fs::read(bench.path("out/report.html")).unwrap();
    assert_eq!(bench.idc(&["report", "out", "--quiet"], &[]).code, 0);
    assert!(fs::read(bench.path("out/report.html")).unwrap() == page);
    let mut scenario = fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let lines = scenario.lines().filter(|line| !line.starts_with("force_"));
    scenario = lines.collect::<Vec<_>>().join("\n");
    let before = scenario.split("[expect]").next().unwrap().to_owned();
    bench.write(
        "scenario.toml",
        before + "\n[expect]\nforce_mean_n = { max = 1.0 }\n",
    );
    let words = ["run", "scenario.toml", "--out", "broken", "--quiet"];
    assert_eq!(bench.idc(&words, &[]).code, 1);
    let text = fs::read_to_string(bench.path("broken/report.html")).unwrap();
    assert!(text.contains("Outside its bounds: force, mean is 289."));
    assert!(text.contains(" N, expected at most 1 N."));
    // What a bench means by it, not a cell, which follows an edge.
    assert!(text.contains("surface moving; else last level, steady"));
    assert!(!text.contains("over the following phase"));
}

#[test]
fn damaged_folders_are_refused_by_one_message_and_keep_their_page() {
    let bench = diagnosed("case-02");
    let page = fs::read(bench.path("found/report.html")).unwrap();
    let whole = fs::read(bench.path("found/comparison.parquet")).unwrap();
    fs::write(
        bench.path("found/comparison.parquet"),
        &whole[..whole.len() / 2],
    )
    .unwrap();
    let outcome = bench.idc(&["report", "found"], &[]);
    assert_eq!(outcome.code, 2);
    outcome.only_line("error: cannot read found/comparison.parquet");
    // A table that is none of ours.
    fs::copy(
        bench.path("found/balance.parquet"),
        bench.path("found/comparison.parquet"),
    )
    .unwrap();
    let outcome = bench.idc(&["report", "found"], &[]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome.err.contains("no column `recording`"),
        "{}",
        outcome.err
    );
    bench.write("found/diagnosis.json", "{\"schema\": 1, \"verdict\"");
    let outcome = bench.idc(&["report", "found"], &[]);
    assert_eq!(outcome.code, 2);
    outcome.only_line("error: cannot read found/diagnosis.json");
    assert!(fs::read(bench.path("found/report.html")).unwrap() == page);
    fs::create_dir(bench.path("empty")).unwrap();
    let outcome = bench.idc(&["report", "empty"], &[]);
    assert_eq!(outcome.code, 2);
    outcome.only_line("error: empty: there are no results in it");
}

#[test]
fn a_comparison_has_changes_against_the_first_and_refuses_what_cannot_be_compared() {
    let bench = diagnosed("case-02");
    for (name, pressure) in [("one", "1.8"), ("other", "2.7")] {
        let scenario = fs::read_to_string(project("scenarios/paper_step.toml")).unwrap();
        let changed = scenario
            .replace("1.8", pressure)
            .replace("../models/device.toml", "device.toml");
        let changed = changed.split("[expect]").next().unwrap().to_owned();
        bench.write("changed.toml", changed);
        let words = ["run", "changed.toml", "--out", name, "--quiet"];
        let outcome = bench.idc(&words, &[]);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
    }
    let outcome = bench.idc(&["compare", "one", "other", "--json"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let told: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    let numbers = told["numbers"].as_array().unwrap();
    let mean = numbers.iter().find(|n| n["key"] == "force_mean_n").unwrap();
    let [one, other] = [0, 1].map(|i| mean["values"][i].as_f64().unwrap());
    // The paper's force is in proportion to the gauge pressure.
    assert!((other / one - 1.5).abs() < 1e-3, "{one} {other}");
    let outcome = bench.idc(&["compare", "one", "other", "--out", "both.html"], &[]);
    assert!(outcome.out.contains("(+50 %)"), "{}", outcome.out);
    let page = fs::read_to_string(bench.path("both.html")).unwrap();
    assert!(page.contains("one / other") && page.contains("+50 %"));
    let outcome = bench.idc(&["compare", "one", "found"], &[]);
    assert_eq!(outcome.code, 2);
    outcome.only_line("error: found holds a diagnosis and one a run, expected all of one kind");
    let outcome = bench.idc(&["compare", "found", "found"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(
        outcome
            .out
            .contains("coulomb viscous friction: coulomb force [N]")
    );
}

#[test]
fn what_is_read_is_not_written_and_what_is_refused_leaves_nothing() {
    let bench = Bench::new("paper_step");
    assert_eq!(bench.run().code, 0);
    let before = bench.contents();
    for (words, told) in [
        (
            vec!["report", "out", "--out", "out/summary.json", "--force"],
            "--out is out/summary.json, which is read here",
        ),
        (
            vec![
                "compare",
                "out",
                "out",
                "--out",
                "out/samples.parquet",
                "--force",
            ],
            "--out is out/samples.parquet, which is read here",
        ),
        (
            vec!["compare", "nowhere", "out", "--out", "new/page.html"],
            "nowhere: there is nothing in it to compare",
        ),
        (
            vec!["report", "nowhere", "--out", "new/page.html"],
            "nowhere: there are no results in it",
        ),
        (
            vec!["sweep", "--effects", "frictoin", "--out", "new"],
            "frictoin",
        ),
        (
            vec!["new", "cell", "my\"cell.toml"],
            "my\"cell.toml: its name stands in the file too",
        ),
    ] {
        let outcome = bench.idc(&words, &[]);
        assert_eq!(outcome.code, 2, "{words:?}: {}", outcome.err);
        assert!(outcome.err.contains(told), "{words:?}: {}", outcome.err);
        assert!(before == bench.contents(), "{words:?}");
        assert!(!bench.path("new").exists(), "{words:?}");
    }
}

/// `--json` once ended in a panic where a name was no UTF-8.
#[cfg(unix)]
#[test]
fn names_that_are_no_text_are_told_as_far_as_they_are() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    let bench = Bench::new("paper_step");
    let folder = OsStr::from_bytes(b"odd\xff");
    let run = std::process::Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(["run", "scenario.toml", "--quiet", "--out"])
        .arg(folder)
        .current_dir(bench.path(""))
        .status();
    assert!(run.unwrap().success());
    let told = std::process::Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(["report", "--json"])
        .arg(folder)
        .current_dir(bench.path(""))
        .output()
        .unwrap();
    assert!(
        told.status.success(),
        "{}",
        String::from_utf8_lossy(&told.stderr)
    );
    let told: serde_json::Value = serde_json::from_slice(&told.stdout).unwrap();
    assert_eq!(told["file"], "odd\u{fffd}/report.html");
}
