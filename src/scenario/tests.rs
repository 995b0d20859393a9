//! Tests of reading a scenario: values, messages, the files shipped, and scenarios/README.md.

mod messages;
mod readme;
mod refusals;
mod shipped;
mod values;

use std::path::{Path, PathBuf};

use super::load::from_text;
use super::{Scenario, ScenarioError};

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

fn scenarios() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios")
}

/// Reads a text as if it stood in scenarios/test.toml.
fn read(text: &str) -> Result<Scenario, ScenarioError> {
    from_text(&scenarios().join("test.toml"), text)
}

/// The minimal scenario with one piece of its text replaced.
fn edited(from: &str, to: &str) -> String {
    assert_eq!(
        MINIMAL.matches(from).count(),
        1,
        "{from:?} must stand once in the text"
    );
    MINIMAL.replace(from, to)
}

/// The one line that a text is refused with.
fn message(text: &str) -> String {
    let message = match read(text) {
        Ok(scenario) => panic!("accepted: {scenario:?}"),
        Err(error) => error.to_string(),
    };
    assert!(!message.contains('\n'), "more than one line: {message}");
    message
}

/// Refuses `to` in place of `from`, at a line and column, with these words.
fn refused(from: &str, to: &str, place: &str, words: &str) {
    let message = message(&edited(from, to));
    let expected = format!("scenarios/test.toml:{place}: {words}");
    assert!(
        message.ends_with(&expected),
        "{message}\nexpected {expected}"
    );
}
