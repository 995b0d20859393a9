//! A scenario run by the library in one call: the numbers of summary.json.

use idc_cell::run::{Job, RunError};

use crate::common::project;
use crate::program::Bench;

/// Compares a scenario's metrics by [`Job::run`] with those that `idc run` wrote of it.
fn same_as_the_program(name: &str, bounds: usize) {
    let program = Bench::new(name);
    let words = [
        "run",
        "scenario.toml",
        "--out",
        "out",
        "--quiet",
        "--no-recording",
    ];
    assert_eq!(program.idc(&words, &[]).code, 0);
    let summary = &program.summary()["summary"];
    let job = Job::load(&project(&format!("scenarios/{name}.toml"))).unwrap();
    let mut last = (0, 0);
    let outcome = job.run(&mut |done, all| last = (done, all)).unwrap();
    assert!(last.0 > 0 && last.0 <= last.1);
    assert!(outcome.stop.is_none());
    assert_eq!(outcome.bounds.len(), bounds);
    assert!(outcome.bounds.iter().all(|bound| bound.kept));
    let mut compared = 0;
    for (metric, value) in &outcome.metrics {
        let Some(written) = summary.get(metric) else {
            continue;
        };
        // A decimal that is read back may be the next double.
        let same = |a: f64, b: f64| (a - b).abs() <= 2.0 * f64::EPSILON * a.abs();
        let is_same = match (written.as_f64(), *value) {
            (Some(written), Some(value)) => same(written, value),
            (written, value) => written == value,
        };
        assert!(is_same, "{metric}: {written}, {value:?}");
        compared += 1;
    }
    assert!(compared > 10, "{compared} of {}", outcome.metrics.len());
    // How long it took is none of its numbers.
    let wall = outcome
        .metrics
        .iter()
        .find(|(name, _)| *name == "wall_time_s");
    assert!(wall.is_none_or(|(_, value)| value.is_none()));
}

#[test]
fn a_bench_and_a_cell_give_what_the_program_writes() {
    same_as_the_program("paper_step", 0);
    same_as_the_program("plate_edge", 5);
}

#[test]
fn what_is_missing_is_said_by_its_file() {
    let error = Job::load(&project("scenarios/none.toml")).err().unwrap();
    assert!(matches!(error, RunError::Scenario(_)));
    assert!(error.to_string().contains("none.toml"), "{error}");
}
