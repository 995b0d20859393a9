//! A table of runs is a case: what it should name is planted by formulas of the test's own.

use std::fmt::Write as _;

use serde_json::Value;

use crate::program::Bench;

const FILE: &str = r#"schema = 1
kind = "removal_table"
title = "Belt on an edge"

[tables]
fit = ["runs.csv"]

[columns]
force = { name = "force_n", unit = "N" }
feed = { name = "feed_mm_s", unit = "mm/s" }
wear = { name = "wear" }
volume = { name = "removed_mm3", unit = "mm3" }

[believed]
law = "preston"
"#;

/// A table of a law, its volumes scattered by 5 %.
fn table(seed: u64, law: impl Fn(f64, f64, f64) -> f64) -> String {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut text = String::from("force_n,feed_mm_s,wear,removed_mm3\n");
    for i in 0..40 {
        let force = 3.0 + 4.0 * uniform();
        let feed = [10.0, 20.0, 40.0][i % 3];
        let wear = 3.0 * uniform();
        // The sum of twelve is as good as normal.
        let normal: f64 = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let volume = law(force, feed, wear) * (0.05 * normal).exp();
        let _ = writeln!(text, "{force:.4},{feed},{wear:.4},{volume:.5}");
    }
    text
}

fn diagnosed(bench: &Bench, folder: &str) -> Value {
    let outcome = bench.idc(
        &["diagnose", folder, "--out", "found", "--force", "--quiet"],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let text = std::fs::read_to_string(bench.path("found/diagnosis.json")).unwrap();
    crate::statements::hold_together(&serde_json::from_str(&text).unwrap());
    serde_json::from_str(&text).unwrap()
}

fn bench(rows: &str) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    std::fs::create_dir_all(bench.path("case")).unwrap();
    bench.write("case/rig.toml", FILE);
    bench.write("case/runs.csv", rows);
    bench
}

/// What `idc new` writes is a case as it stands, `idc check` explains it, and its diagnosis names what the made-up rows have.
#[test]
fn a_new_table_is_checked_and_diagnosed_unchanged() {
    let bench = Bench::new("plate_edge_ideal");
    let new = bench.idc(&["new", "removal_table", "mine/rig.toml"], &[]);
    assert_eq!(new.code, 0, "{}", new.err);
    assert!(
        new.out.contains("mine/rig_runs.csv") && new.out.contains("next: idc diagnose mine"),
        "{}",
        new.out
    );
    for target in ["mine", "mine/rig.toml"] {
        let checked = bench.idc(&["check", target], &[]);
        assert_eq!(checked.code, 0, "{}", checked.err);
        for words in [
            "24 rows to diagnose from",
            "feed from feed_mm_s, in mm/s",
            "idc diagnose mine",
        ] {
            assert!(checked.out.contains(words), "{}", checked.out);
        }
    }
    let answer = diagnosed(&bench, "mine");
    let mut found = names(&answer);
    found.sort_unstable();
    assert_eq!(found, ["removal_force_exponent", "tool_wear"]);
    // A second one elsewhere under another name has a table of its own name, and what stands is kept.
    let again = bench.idc(&["new", "removal_table", "mine/rig.toml"], &[]);
    assert_eq!(again.code, 2, "{}", again.err);
    assert_eq!(
        bench
            .idc(&["new", "removal_table", "belt.toml", "--quiet"], &[])
            .code,
        0
    );
    assert!(bench.path("belt_runs.csv").is_file());
}

fn names(answer: &Value) -> Vec<&str> {
    let effects = answer["effects"].as_array().unwrap().iter();
    effects
        .map(|effect| effect["name"].as_str().unwrap())
        .collect()
}

#[test]
fn exponent_and_wear_are_named_and_the_improved_law_predicts_another_table() {
    let law =
        |force: f64, feed: f64, wear: f64| 2.8 * force.powf(2.05) / feed * (-0.23 * wear).exp();
    let bench = bench(&table(1, law));
    let answer = diagnosed(&bench, "case");
    let mut found = names(&answer);
    found.sort_unstable();
    assert_eq!(found, ["removal_force_exponent", "tool_wear"]);
    let exponent = &answer["effects"]
        .as_array()
        .unwrap()
        .iter()
        .find(|e| e["name"] == "removal_force_exponent")
        .unwrap()["parameters"]["force_exponent"];
    let [value, low, high] = ["value", "low", "high"].map(|key| exponent[key].as_f64().unwrap());
    assert!(
        (value - 2.05).abs() < 0.15 && low < 2.05 && 2.05 < high,
        "{exponent}"
    );
    // The improved file predicts rows that it has not seen to their scatter, the nominal one does not.
    bench.write("other.csv", table(2, law));
    let off = |file: &str| -> f64 {
        let outcome = bench.idc(
            &[
                "predict",
                file,
                "other.csv",
                "--out",
                "p.csv",
                "--force",
                "--json",
            ],
            &[],
        );
        assert_eq!(outcome.code, 0, "{}", outcome.err);
        let reported: Value = serde_json::from_str(&outcome.out).unwrap();
        reported["rms_of_log_volume"].as_f64().unwrap()
    };
    let improved = off("found/improved.toml");
    assert!(improved < 0.075, "{improved}");
    // Taken as nominal, nothing is missing any more.
    std::fs::create_dir_all(bench.path("again")).unwrap();
    let text = std::fs::read_to_string(bench.path("found/improved.toml")).unwrap();
    bench.write("again/rig.toml", text);
    bench.write("again/runs.csv", table(3, law));
    assert_eq!(diagnosed(&bench, "again")["verdict"], "nothing_missing");
}

#[test]
fn nothing_is_named_where_preston_holds() {
    let bench = bench(&table(4, |force, feed, _| 5.0 * force / feed));
    let answer = diagnosed(&bench, "case");
    assert_eq!(answer["verdict"], "nothing_missing");
    for file in ["account.txt", "improved.toml", "fit.svg", "report.html"] {
        assert!(bench.path("found").join(file).is_file(), "{file}");
    }
}

#[test]
fn tables_that_cannot_be_are_refused_with_one_line_and_nothing_is_written() {
    let rows = table(5, |force, feed, _| 5.0 * force / feed);
    let refused = |file: &str, rows: &str, expected: &[&str]| {
        let bench = bench(rows);
        bench.write("case/rig.toml", file);
        let outcome = bench.idc(&["diagnose", "case", "--out", "found"], &[]);
        assert_eq!(outcome.code, 2, "{}", outcome.err);
        let line = outcome.only_line("error");
        for word in expected {
            assert!(line.contains(word), "{word}: {line}");
        }
        assert!(!bench.path("found").exists());
    };
    refused(
        FILE,
        &rows.replace("removed_mm3", "taken_mm3"),
        &["runs.csv", "removed_mm3"],
    );
    let negative = rows.lines().next().unwrap().to_owned() + "\n-3,10,0,1\n";
    refused(FILE, &negative, &["runs.csv", "line 2", "force_n", "-3"]);
    let one: Vec<&str> = rows.lines().take(2).collect();
    refused(FILE, &(one.join("\n") + "\n"), &["at least 5"]);
    let threshold = FILE.replace("\"preston\"", "\"threshold\"");
    refused(&threshold, &rows, &["threshold_force_n"]);
    let furlong = FILE.replace("unit = \"N\"", "unit = \"lbf\"");
    refused(&furlong, &rows, &["force.unit", "lbf", "N, kN"]);
}

/// A table whose wear adds up from row to row as force x time x speed: the planted wear per work comes back. Added up without the speed, or beginning with the row's
/// own work, it would be another number; and a nominal law that has it leaves nothing.
#[test]
fn wear_that_is_cumulated_grows_by_force_times_time_times_speed() {
    let rate = 2e-5;
    let mut state = 11u64;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut rows = String::from("force_n,time_s,speed_m_s,removed_mm3\n");
    let mut work = 0.0;
    for _ in 0..60 {
        let (force, time) = (20.0 + 40.0 * uniform(), 2.0 + 6.0 * uniform());
        let speed = 2.0 + 18.0 * uniform();
        let normal: f64 = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let volume = 0.02 * force * time * speed * (-rate * work + 0.02 * normal).exp();
        let _ = writeln!(rows, "{force:.4},{time:.4},{speed:.4},{volume:.6}");
        work += force * time * speed;
    }
    assert!(rate * work > 1.0 && rate * work < 4.0, "{}", rate * work);
    let columns = r#"force = { name = "force_n", unit = "N" }
time = { name = "time_s", unit = "s" }
speed = { name = "speed_m_s", unit = "m/s" }
cumulate_wear = true
volume = { name = "removed_mm3", unit = "mm3" }
"#;
    let (head, _) = FILE.split_once("force =").unwrap();
    let file = format!("{head}{columns}\n[believed]\nlaw = \"preston\"\n");
    let bench = bench(&rows);
    bench.write("case/rig.toml", file.clone());
    let answer = diagnosed(&bench, "case");
    assert_eq!(names(&answer), ["tool_wear"]);
    let wear = &answer["effects"][0]["parameters"]["wear_rate"];
    let value = wear["value"].as_f64().unwrap();
    assert!((value / rate - 1.0).abs() < 0.05, "{wear}");
    bench.write("case/rig.toml", file + &format!("wear_rate = {rate}\n"));
    assert_eq!(diagnosed(&bench, "case")["verdict"], "nothing_missing");
}
