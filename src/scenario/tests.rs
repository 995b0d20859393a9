//! Tests of reading a scenario: values, messages, the files shipped, and scenarios/README.md.

mod bench;
mod controller;
mod device;
mod effects;
mod estimator;
mod messages;
mod readme;
mod refusals;
mod rig_device;
mod sensing;
mod shipped;
mod values;

use std::path::{Path, PathBuf};

use super::any::from_text;
use super::{AnyScenario, BenchScenario, Scenario, ScenarioError};

/// A scenario of required keys alone.
const MINIMAL: &str = r#"schema = 1
title = "minimal"
[arm]
urdf = "../models/arm/arm10.urdf"
flange_link = "flange"
[device]
model = "../models/device.toml"
[workpiece]
mesh = "../assets/plate.stl"
mesh_unit = "mm"
position_mm = [750, 0, 200]
[workpiece.edge]
edge = 1
[process]
force_n = 150
feed_mm_per_s = 20
"#;

/// A bench scenario of required keys alone.
const MINIMAL_BENCH: &str = r#"schema = 1
kind = "bench"
title = "minimal"
[device]
model = "../models/device.toml"
[bench]
duration_s = 6
[load]
kind = "free"
"#;

fn scenarios() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios")
}

/// Reads a text as if it stood in scenarios/test.toml.
fn read_any(text: &str) -> Result<AnyScenario, ScenarioError> {
    from_text(&scenarios().join("test.toml"), text)
}

/// Reads a text that is a cell if it is anything.
fn read(text: &str) -> Result<Scenario, ScenarioError> {
    read_any(text).map(|scenario| match scenario {
        AnyScenario::Cell(cell) => *cell,
        AnyScenario::Bench(bench) => panic!("a bench: {bench:?}"),
    })
}

/// Reads a text that is a bench if it is anything.
fn read_bench(text: &str) -> Result<BenchScenario, ScenarioError> {
    read_any(text).map(|scenario| match scenario {
        AnyScenario::Bench(bench) => *bench,
        AnyScenario::Cell(cell) => panic!("a cell: {cell:?}"),
    })
}

/// A text with one piece replaced.
fn replaced(text: &str, from: &str, to: &str) -> String {
    assert_eq!(
        text.matches(from).count(),
        1,
        "{from:?} must stand once in the text"
    );
    text.replace(from, to)
}

/// The minimal scenario with one piece of its text replaced.
fn edited(from: &str, to: &str) -> String {
    replaced(MINIMAL, from, to)
}

/// The one line that a text is refused with.
fn message(text: &str) -> String {
    let message = match read_any(text) {
        Ok(scenario) => panic!("accepted: {scenario:?}"),
        Err(error) => error.to_string(),
    };
    assert!(!message.contains('\n'), "more than one line: {message}");
    message
}

/// Refuses a text at a line and column, with these words.
fn text_refused(text: &str, location: &str, words: &str) {
    let message = message(text);
    let expected = format!("scenarios/test.toml:{location}: {words}");
    assert!(
        message.ends_with(&expected),
        "{message}\nexpected {expected}"
    );
}

/// Refuses `to` in place of `from` in the minimal scenario.
fn refused(from: &str, to: &str, location: &str, words: &str) {
    text_refused(&edited(from, to), location, words);
}
