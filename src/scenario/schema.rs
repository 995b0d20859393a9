//! JSON Schemas of the files, for editors, made of the keys as they are declared.

mod rig;

use serde_json::{Value, json};

pub use rig::schema as rig;

use super::bench_file::BenchFile;
use super::file::{ModelFile, ScenarioFile};
use super::recorded_cell::RecordedCellFile;
use crate::keys::declaration::{Filled, of_file};
use crate::keys::schema::DIALECT;

/// Schema of a scenario file of any kind.
#[must_use]
pub fn scenario() -> Value {
    let is =
        |kind: &str| json!({ "properties": { "kind": { "const": kind } }, "required": ["kind"] });
    json!({
        "$schema": DIALECT,
        "title": "A scenario of idc: a robot cell, a bench (kind = \"bench\") or a recorded cell (kind = \"recorded_cell\")",
        "type": "object",
        "if": is("bench"),
        "then": BenchFile::schema(),
        "else": { "if": is("recorded_cell"), "then": RecordedCellFile::schema(), "else": ScenarioFile::schema() },
    })
}

/// Schema of a device model file.
#[must_use]
pub fn device() -> Value {
    of_file::<ModelFile>("A device model file of idc")
}
