//! Pages of results: what they say, that they come again from the files alone, and how damaged folders are refused.

use std::collections::BTreeMap;
use std::fs;
use std::sync::Mutex;

use serde_json::{Value, json};

use crate::common::project;
use crate::own_cell::columns;
use crate::program::Bench;

/// A bench with a diagnosis of one of the project's cases in `found`; each case is diagnosed once.
fn diagnosed(case: &str) -> Bench {
    static DONE: Mutex<BTreeMap<String, Bench>> = Mutex::new(BTreeMap::new());
    let mut done = DONE.lock().unwrap();
    let first = done.entry(case.to_owned()).or_insert_with(|| {
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
    });
    let bench = Bench::new("paper_step");
    fs::create_dir(bench.path("found")).unwrap();
    for entry in fs::read_dir(first.path("found")).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), bench.path("found").join(entry.file_name())).unwrap();
    }
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
    let reported: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    assert_eq!(reported["kind"], "diagnosis");
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

// Catches: a value that is declared assumed and not listed, one listed that is declared otherwise, and a study that says nothing of them.
#[test]
fn a_run_says_which_of_its_numbers_rest_on_assumed_values() {
    let bench = Bench::new("deburred_edge");
    bench.replace("scenario.toml", "end_mm = 290", "end_mm = 50");
    bench.replace("scenario.toml", "friction_coefficient = 0.3\n", "");
    let text = fs::read_to_string(bench.path("scenario.toml")).unwrap();
    bench.write("scenario.toml", text.split("[expect]").next().unwrap());
    let words = [
        "run",
        "scenario.toml",
        "--out",
        "out",
        "--quiet",
        "--no-recording",
    ];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    let summary = bench.summary();
    let reported = summary["judged"].as_array().unwrap();
    let key = |value: &Value| value["key"].as_str().unwrap().to_owned();
    let rows = fs::read_to_string(project("scenarios/README.md")).unwrap();
    let model = fs::read_to_string(project("models/device.toml")).unwrap();
    let model: toml::Table = toml::from_str(&model).unwrap();
    let of_model = model["judged"].as_array().unwrap();
    for value in reported {
        let key = key(value);
        match key.strip_prefix("device.") {
            Some(own) => assert!(of_model.contains(&toml::Value::from(own)), "{key}"),
            None => {
                let row = |line: &str| line.starts_with(&format!("| `{key}` |"));
                let declared = rows.lines().find(|line| row(line)).unwrap();
                assert!(declared.contains("assumed"), "{key}");
            }
        }
    }
    let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
    let (_, reported_there) = page.split_once("These numbers rest on values").unwrap();
    let sentence = reported_there.split("measure your own").next().unwrap();
    for expected in [
        "leg of the chamfer and burr that is left on removal.coefficient_mm3_per_j, removal.contact_length_mm (default) and workpiece.burr.root_mm",
        "spindle torque and power on removal.friction_coefficient (default) and removal.specific_energy_j_per_mm3",
        "share out of tolerance on workpiece.chamfer.residual_burr_max_mm (default)",
        "contact force and stroke on ",
    ] {
        assert!(sentence.contains(expected), "{sentence}");
    }
    // What the scenario gives is no longer the model's, and what switches something off decides nothing.
    let given = |key_: &str| reported.iter().any(|value| key(value) == key_);
    assert!(given("device.seal_coulomb_force_n") && !given("device.axial_load_n"));
    assert!(!given("removal.wear_work_kj"));
    bench.replace(
        "scenario.toml",
        "[workpiece]\n",
        "[device.override]\nseal_coulomb_force_n = 9\n\n[workpiece]\n",
    );
    let words = [&words[..], &["--force"]].concat();
    assert_eq!(bench.idc(&words, &[]).code, 0);
    let summary = bench.summary();
    let again = summary["judged"].as_array().unwrap();
    assert_eq!(again.len() + 1, reported.len());
    assert!(
        !again
            .iter()
            .any(|value| key(value) == "device.seal_coulomb_force_n")
    );
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
    let reported: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    let numbers = reported["numbers"].as_array().unwrap();
    let mean = numbers.iter().find(|n| n["key"] == "force_mean_n").unwrap();
    let [one, other] = [0, 1].map(|i| mean["values"][i].as_f64().unwrap());
    // The paper's force is in proportion to the gauge pressure.
    assert!((other / one - 1.5).abs() < 1e-3, "{one} {other}");
    let outcome = bench.idc(&["compare", "one", "other", "--out", "both.html"], &[]);
    assert!(outcome.out.contains("+50 %"), "{}", outcome.out);
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
            .contains("coulomb viscous friction: coulomb force")
    );
}

#[test]
fn what_is_read_is_not_written_and_what_is_refused_leaves_nothing() {
    let bench = Bench::new("paper_step");
    assert_eq!(bench.run().code, 0);
    let before = bench.contents();
    for (words, reported) in [
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
            vec!["prove", "--sweep", "--effects", "frictoin", "--out", "new"],
            "frictoin",
        ),
        (
            vec!["new", "cell", "my\"cell.toml"],
            "my\"cell.toml: its name stands in the file too",
        ),
    ] {
        let outcome = bench.idc(&words, &[]);
        assert_eq!(outcome.code, 2, "{words:?}: {}", outcome.err);
        assert!(outcome.err.contains(reported), "{words:?}: {}", outcome.err);
        assert!(before == bench.contents(), "{words:?}");
        assert!(!bench.path("new").exists(), "{words:?}");
    }
}

/// `--json` once ended in a panic where a name was no UTF-8.
#[cfg(unix)]
#[test]
fn names_that_are_no_text_are_shown_as_far_as_they_are() {
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
    let reported = std::process::Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(["report", "--json"])
        .arg(folder)
        .current_dir(bench.path(""))
        .output()
        .unwrap();
    assert!(
        reported.status.success(),
        "{}",
        String::from_utf8_lossy(&reported.stderr)
    );
    let reported: serde_json::Value = serde_json::from_slice(&reported.stdout).unwrap();
    assert_eq!(reported["file"], "odd\u{fffd}/report.html");
}

/// Rows of the tables of a page, cell by cell.
fn rows(page: &str) -> Vec<Vec<&str>> {
    fn row(text: &str) -> Vec<&str> {
        let row = text.split("</tr>").next().unwrap();
        let cells = row.split("<td").skip(1);
        let content = |cell: &'_ str| cell.find('>').unwrap() + 1..cell.find("</td>").unwrap();
        cells.map(|cell| &cell[content(cell)]).collect()
    }
    page.split("<tr>").skip(1).map(row).collect()
}

/// Whether a number on a page is one of a file, to three digits.
fn shows(text: &str, number: f64) -> bool {
    let shown = text.split([' ', '<']).next().unwrap().parse();
    shown.is_ok_and(|shown: f64| (shown / number - 1.0).abs() < 2e-3)
}

/// Puts another number in place of each, all different, and of those in rows below it; what counts rows stays.
fn tell_apart(value: &mut Value, next: &mut f64) {
    match value {
        Value::Object(map) => {
            let numbers = map.iter_mut().filter(|(key, _)| *key != "pass");
            numbers.for_each(|(_, own)| tell_apart(own, next));
        }
        Value::Array(list) => list.iter_mut().for_each(|own| tell_apart(own, next)),
        Value::Number(_) => {
            *next *= 1.03;
            *value = json!(*next);
        }
        _ => (),
    }
}

/// Numbers of a page by their keys.
fn keyed(page: &str) -> Vec<(&str, &str)> {
    let numbers = page.split("data-key=\"").skip(1).map(|rest| {
        let (key, rest) = rest.split_once('"').unwrap();
        let text = rest.split_once('>').unwrap().1;
        (key, text.split('<').next().unwrap())
    });
    numbers.collect()
}

// Catches: a number that is taken from another field. In most runs some fields are equal or nearly so, here none are.
#[test]
fn each_number_on_the_page_of_a_run_is_that_of_its_key() {
    for (scenario, least) in [("plate_edge", 100), ("paper_stairstep", 60)] {
        let bench = Bench::new(scenario);
        let words = ["run", "scenario.toml", "--out", "out", "--quiet"];
        assert!(bench.idc(&words, &[]).code < 2);
        let text = fs::read_to_string(bench.path("out/summary.json")).unwrap();
        let mut document: Value = serde_json::from_str(&text).unwrap();
        document["expectations"] = json!([]);
        tell_apart(&mut document["summary"], &mut 11.0);
        bench.write("out/summary.json", document.to_string());
        let outcome = bench.idc(&["report", "out", "--quiet"], &[]);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
        let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
        let numbers = keyed(&page);
        for (key, text) in &numbers {
            let pointer = format!("/summary/{}", key.replace('.', "/"));
            let number = document.pointer(&pointer).and_then(Value::as_f64);
            match number {
                // An end of a tenth has as many decimals as tell tenths apart.
                Some(number) if key.ends_with("_mm") && key.starts_with("force_by_tenth") => {
                    assert!(
                        (text.parse::<f64>().unwrap() - number).abs() <= 0.5,
                        "{key}"
                    );
                }
                Some(number) => assert!(shows(text, number), "{key}: {text} for {number}"),
                None => assert_eq!(*text, "\u{2013}", "{key}"),
            }
        }
        assert!(numbers.len() > least, "{scenario}: {}", numbers.len());
    }
}

// Catches: the same on the page of a diagnosis, and a row of its comparison that is lost.
#[test]
fn the_page_of_a_diagnosis_shows_its_own_numbers_and_the_comparison_every_sample() {
    let bench = diagnosed("case-02");
    let text = fs::read_to_string(bench.path("found/diagnosis.json")).unwrap();
    let mut answer: Value = serde_json::from_str(&text).unwrap();
    let effect = &mut answer["effects"][0];
    effect["confidence"] = json!(0.66);
    let names: Vec<String> = (effect["parameters"].as_object().unwrap().keys())
        .cloned()
        .collect();
    let mut next = 11.0;
    for name in &names {
        for key in ["low", "value", "high"] {
            next *= 1.1;
            effect["parameters"][name][key] = json!(next);
        }
    }
    let effect = effect.clone();
    bench.write("found/diagnosis.json", answer.to_string());
    assert_eq!(bench.idc(&["report", "found", "--quiet"], &[]).code, 0);
    let page = fs::read_to_string(bench.path("found/report.html")).unwrap();
    let rows = rows(&page);
    let mut own = rows.iter();
    for name in &names {
        let row = own.find(|row| row.first() == Some(&"coulomb viscous friction"));
        let row = row.unwrap();
        let of = |key: &str| effect["parameters"][name][key].as_f64().unwrap();
        assert!(
            name.starts_with(&row[3].replace(' ', "_")),
            "{name}: {}",
            row[3]
        );
        for (cell, number) in [
            (row[2], 66.0),
            (row[4], of("value")),
            (row[5], of("low")),
            (row[6], of("high")),
        ] {
            assert!(shows(cell, number), "{name}: {cell} for {number}");
        }
    }
    for recording in ["stairs.csv", "ride.csv", "cycle.csv", "predict.csv"] {
        let case = project(&format!("assets/proof/cases/case-02/{recording}"));
        let log = fs::read_to_string(case).unwrap();
        let times = log.lines().skip(1);
        let times: Vec<f64> = times
            .map(|line| line.split(',').next().unwrap().parse().unwrap())
            .collect();
        let names = ["time_s", "believed_stroke_m", "improved_force_n"];
        let compared = columns(&bench.path("found/comparison.parquet"), recording, names);
        let shown: Vec<f64> = compared.iter().map(|row| row[0]).collect();
        assert_eq!(shown, times, "{recording}");
        assert!(compared.iter().flatten().all(|value| value.is_finite()));
    }
}
