//! A unit's model: the bench of its resources, its variables, and the token by which description and library know one another.

use std::path::Path;

use super::error::FmuError;
use super::variables::{Starts, Variable, variables};
use crate::effects::actual;
use crate::physics::valve::ValvePosition;
use crate::plant::{DeviceParts, Nominal, PlantParameters};
use crate::recording::provenance::{BUILD, Provenance, SourceFile};
use crate::scenario::bench::{BenchScenario, LoadScenario};
use crate::scenario::{AnyScenario, load_any};

/// The bench's scenario among the resources; the file of its device lies beside it.
pub const SCENARIO: &str = "scenario.toml";

/// What stands in a library, so that an export finds out which build it is of.
pub const MARK: &str = concat!(
    "co-simulation library of idc ",
    env!("CARGO_PKG_VERSION"),
    " (",
    env!("IDC_SOURCES"),
    ")"
);

/// All that does not change while a unit runs.
#[derive(Debug, Clone)]
pub struct Model {
    /// The bench.
    pub scenario: BenchScenario,
    /// Its physics with its effects, before an importer changes a number.
    pub(super) plant: Nominal<PlantParameters>,
    /// Variables, each at its value reference.
    pub variables: Vec<Variable>,
    /// What an importer hands over with the resources: it tells build, scenario and device.
    pub token: String,
    /// As it starts.
    pub(super) starts: Starts,
}

impl Model {
    /// Reads the bench of a scenario file.
    ///
    /// # Errors
    /// Those of the file; a cell; a part of a device.
    pub fn load(path: &Path) -> Result<Self, FmuError> {
        let file = || path.display().to_string();
        let scenario = match load_any(path)? {
            AnyScenario::Bench(bench) => *bench,
            AnyScenario::Cell(_) => return Err(FmuError::Cell { file: file() }),
        };
        if scenario.nominal.parts != DeviceParts::Whole {
            return Err(FmuError::Part {
                file: scenario.device.model.display().to_string(),
                chain: scenario.nominal.parts.name(),
            });
        }
        // As `actual` makes it, but for what it derives from it: that follows from the numbers as they are then.
        let mut plant = scenario.nominal.clone();
        for effect in &scenario.effects {
            effect.apply_to(&mut plant);
        }
        let extends = |valve: &(f64, ValvePosition)| valve.1 == ValvePosition::Extend;
        let starts = Starts {
            surface: match &scenario.load {
                LoadScenario::Free => None,
                LoadScenario::Contact { position, .. } => Some(*position),
            },
            extends: (scenario.valve.first()).is_none_or(|first| first.0 > 0.0 || extends(first)),
            stroke: scenario.start_stroke,
        };
        let variables = variables(&actual(&plant, &[]), &starts);
        let token = token(path, &scenario)?;
        Ok(Self {
            scenario,
            plant,
            variables,
            token,
            starts,
        })
    }

    /// The variable at a value reference.
    #[must_use]
    pub fn variable(&self, reference: u32) -> Option<&Variable> {
        self.variables.get(reference as usize)
    }

    /// Refuses a description that is of other files or of another build.
    pub(super) fn check_token(&self, given: &str) -> Result<(), FmuError> {
        match given == self.token {
            true => Ok(()),
            false => Err(FmuError::Token { library: BUILD }),
        }
    }
}

/// Hash of build and files.
fn token(path: &Path, scenario: &BenchScenario) -> Result<String, FmuError> {
    let files = [
        ("scenario", path),
        ("device", scenario.device.model.as_path()),
    ];
    let read = Provenance::of(files, None).map_err(|error| FmuError::Argument {
        what: error.to_string(),
    })?;
    let content = format!("{MARK} {}", read.content());
    Ok(SourceFile::holding("", content.as_bytes()).sha256)
}
