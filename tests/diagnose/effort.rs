//! A limit of a search: an answer however small it is, the same bytes for the same effort.

use serde_json::Value;

use super::planted::{Dirt, OFFSET, case};
use super::{diagnose, without_time};
use crate::program::Bench;

fn stopped(answer: &Value) -> u64 {
    assert_eq!(answer["effort"]["stopped"], true, "{answer:#}");
    let evaluations = answer["effort"]["model_evaluations"].as_u64().unwrap();
    let notes = answer["notes"].to_string();
    assert!(
        notes.contains(&format!("`--effort {evaluations}`")),
        "{notes}"
    );
    evaluations
}

#[test]
fn a_limit_ends_with_the_best_so_far_and_the_same_effort_with_the_same_bytes() {
    let bench = Bench::new("plate_edge_ideal");
    case(&bench, "case", OFFSET, Dirt::None);
    let run = |limit: &[&str], out: &str| {
        let outcome = diagnose(
            &bench,
            &[&["case", "--quiet", "--out", out], limit].concat(),
        );
        assert_eq!(outcome.code, 0, "{}", outcome.err);
        let mut answer = without_time(&bench.path(&format!("{out}/diagnosis.json")));
        // Of the seal, which says what was asked for.
        answer["seal"].take();
        answer
    };
    let text = |name: &str| std::fs::read_to_string(bench.path(name)).unwrap();
    // Less than the first checkpoint takes.
    let timed = run(&["--limit", "1ms"], "timed");
    let effort = stopped(&timed).to_string();
    let again = run(&["--effort", &effort], "again");
    assert_eq!(again, timed);
    let least = run(&["--effort", "1"], "least");
    assert_eq!(least, timed);
    for name in ["account.txt", "improved.toml", "prediction.csv"] {
        assert_eq!(
            text(&format!("again/{name}")),
            text(&format!("timed/{name}"))
        );
    }
    assert!(text("timed/account.txt").contains("stopped by its limit"));
    // More gets farther, and what is enough stops nothing.
    let more = run(&["--effort", &format!("{effort}0")], "more");
    assert!(
        more["effort"]["model_evaluations"].as_u64()
            > timed["effort"]["model_evaluations"].as_u64()
    );
    let whole = run(&["--limit", "1h"], "whole");
    assert_eq!(whole["effort"]["stopped"], false);
    assert_eq!(super::names(&whole), ["axial_force_offset"]);
}

#[test]
fn a_limit_that_is_none_is_refused_in_one_line() {
    let bench = Bench::new("plate_edge_ideal");
    case(&bench, "case", OFFSET, Dirt::None);
    for (limit, expected) in [
        ("--limit=12", "a time above zero with its unit"),
        ("--limit=-3s", "a time above zero with its unit"),
        ("--effort=0", "1.."),
    ] {
        let outcome = diagnose(&bench, &["case", "--out", "out", limit]);
        assert_eq!(outcome.code, 2, "{}", outcome.err);
        assert!(outcome.err.contains(expected), "{}", outcome.err);
    }
}
