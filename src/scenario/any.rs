//! A scenario file of either kind, read.

use std::path::Path;

use super::bench::{self, BenchScenario};
use super::file::{Kind, KindOnly, SCHEMA};
use super::load::from_document;
use super::sections::{bench_sections, scenario_sections};
use super::whole_cell::Scenario;
use crate::keys::document::{Document, location_of_key, read_text};
use crate::keys::error::{Location, ScenarioError};
use crate::keys::suggestion::Sections;

/// A scenario of either kind.
#[derive(Debug, Clone)]
pub enum AnyScenario {
    /// Arm, device and workpiece.
    Cell(Box<Scenario>),
    /// The device alone.
    Bench(Box<BenchScenario>),
}

/// Reads and checks a scenario file of either kind and the device model file that it names.
///
/// # Errors
/// A file cannot be read, or a key is unknown, absent or out of its range.
pub fn load_any(path: &Path) -> Result<AnyScenario, ScenarioError> {
    from_text(path, &read_text(path)?)
}

/// As `load_any`, of a text that stands, or could stand, in the file at `path`.
pub(super) fn from_text(path: &Path, text: &str) -> Result<AnyScenario, ScenarioError> {
    let document = Document::new(path, text, SCHEMA)?;
    // Keys of either kind are known here, so that only a wrong kind is refused.
    let KindOnly { kind } = document.parse(&bench_sections())?;
    match kind {
        Kind::Cell => from_document(path, &document)
            .map(|cell| AnyScenario::Cell(Box::new(cell)))
            .map_err(|error| name_kind(error, "bench", &bench_sections())),
        Kind::RecordedCell => Err(ScenarioError::OtherKind {
            file: path.to_owned(),
            found: kind.name(),
            expected: "cell or bench",
        }),
        Kind::Bench => bench::from_document(path, &document)
            .map(|bench| AnyScenario::Bench(Box::new(bench)))
            .map_err(|error| name_kind(error, "cell", &scenario_sections())),
    }
}

/// Says of an unknown key at the top that the other kind of scenario has it, if so.
fn name_kind(error: ScenarioError, other: &str, sections: &Sections) -> ScenarioError {
    match error {
        ScenarioError::UnknownKey { location, key, .. }
            if sections
                .iter()
                .any(|(table, keys)| table.is_empty() && keys.contains(&key.as_str())) =>
        {
            let advice = format!("a scenario of kind = \"{other}\" has it");
            ScenarioError::UnknownKey {
                location,
                key,
                advice,
            }
        }
        error => error,
    }
}

/// Reads and checks the scenario file of a cell and the device model file that it names.
///
/// # Errors
/// A file cannot be read, or a key is unknown, absent or out of its range.
pub fn load(path: &Path) -> Result<Scenario, ScenarioError> {
    match load_any(path)? {
        AnyScenario::Cell(cell) => Ok(*cell),
        AnyScenario::Bench(_) => Err(ScenarioError::OtherKind {
            file: path.to_owned(),
            found: "bench",
            expected: "cell",
        }),
    }
}

/// Reads and checks a bench scenario file and the device model file that it names.
///
/// # Errors
/// A file cannot be read, or a key is unknown, absent or out of its range.
pub fn load_bench(path: &Path) -> Result<BenchScenario, ScenarioError> {
    match load_any(path)? {
        AnyScenario::Bench(bench) => Ok(*bench),
        AnyScenario::Cell(_) => Err(ScenarioError::OtherKind {
            file: path.to_owned(),
            found: "cell",
            expected: "bench",
        }),
    }
}

/// Where a dotted key stands in a scenario file; none if it does not stand there.
pub fn location_of(file: &Path, key: &str) -> Option<Location> {
    location_of_key(file, key, SCHEMA)
}

/// Keys that a file gives in a table, by its dotted name; at the top for none.
///
/// # Errors
/// The file cannot be read, or is not TOML.
pub fn keys_given(file: &Path, table: &str) -> Result<Vec<String>, ScenarioError> {
    keys_of_text(file, &read_text(file)?, table)
}

/// As `keys_given`, of a text that stands, or could stand, in the file.
pub(super) fn keys_of_text(
    file: &Path,
    text: &str,
    table: &str,
) -> Result<Vec<String>, ScenarioError> {
    let document = Document::new(file, text, SCHEMA)?;
    Ok(document.keys_in(table).map(str::to_owned).collect())
}
