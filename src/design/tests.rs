//! Tests of the whole study on models with known optima and fronts, of its file and of what it prints.

mod fronts;
mod optimum;
mod output;
mod refusals;
mod robustness;
mod surrogate;

use std::path::{Path, PathBuf};

use super::study::{Study, from_text};
use super::{DesignError, Evaluate, StudyResult, run};
use crate::scenario::ScenarioError;

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/studies/test.toml")
}

/// Reads a text as if it stood in scenarios/studies/test.toml.
fn read(text: &str) -> Result<Study, ScenarioError> {
    from_text(&file(), text)
}

fn search(text: &str, evaluator: &dyn Evaluate) -> Result<StudyResult, DesignError> {
    run(&read(text).unwrap(), evaluator, &|_, _| ())
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs().max(1e-12),
        "{found}, expected {expected} within {tolerance}"
    );
}
