//! A recording of a fleet as a task.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::super::error::{AppError, ExitCode};
use super::super::terminal::say_aside;
use crate::case::Case;
use crate::fleet::{Diagnosed, Started};
use crate::replay::LoadedCell;
use crate::scenario::rig_file::{RigFile, load_rig};
use crate::tasks::{Plan, Store, Task, TaskError};

/// What its plan is called.
pub(in super::super) const KIND: &str = "fleet";
/// The improved model of a recording that was searched.
const IMPROVED: &str = "improved.toml";

/// What all tasks share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Shared {
    /// The nominal model of all devices: a cell's scenario, or a rig file, from the plan's folder or the root.
    pub scenario: String,
}

/// A task of a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Asked {
    /// Its device.
    pub device: String,
    /// Name of the recording, by its date.
    pub name: String,
    /// Its day [d].
    pub day: f64,
    /// The recording, or its folder, from the plan's folder or the root.
    pub path: String,
    /// Files of a rig's recording within that folder.
    pub files: Vec<String>,
    /// Effects that are to be fitted, whatever else there is; without them the recording is diagnosed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<Vec<Started>>,
}

/// The nominal model.
enum NominalModel {
    Rig(Box<RigFile>),
    Cell(Box<LoadedCell>),
}

/// Does the tasks of a plan.
pub(in super::super) struct Worker {
    nominal: NominalModel,
    folder: PathBuf,
}

/// Whether a file describes a rig, not a cell: it has a table of its own for the rig's sensors or device.
pub(super) fn is_rig(file: &Path) -> bool {
    load_rig(file).is_ok()
}

impl Worker {
    /// One for a plan.
    pub(in super::super) fn new(plan: &Plan) -> Result<Self, AppError> {
        let shared: Shared = serde_json::from_value(plan.head.work.clone())?;
        Self::of(&plan.folder().join(&shared.scenario), plan.folder())
    }

    /// One for the nominal model, with recordings named from a folder.
    pub(super) fn of(file: &Path, folder: &Path) -> Result<Self, AppError> {
        let nominal = match load_rig(file) {
            Ok(rig) => NominalModel::Rig(Box::new(rig)),
            Err(of_rig) => match LoadedCell::load(file) {
                Ok(cell) => NominalModel::Cell(Box::new(cell)),
                // A file of a rig that has a fault is reported as such.
                Err(_) if says_rig(file) => return Err(of_rig.into()),
                Err(of_cell) => return Err(of_cell.into()),
            },
        };
        Ok(Self {
            nominal,
            folder: folder.to_owned(),
        })
    }

    /// Does a task, and puts what it came to in its place.
    pub(in super::super) fn perform(&self, task: &Task, store: &Store) -> Result<(), TaskError> {
        let refused = |reason: String, state: Vec<Started>| Diagnosed {
            code: ExitCode::BadInput as u8,
            reason,
            state,
            ..Diagnosed::default()
        };
        let before: Option<Diagnosed> = match &task.after {
            Some(after) => Some(store.read(after)?),
            None => None,
        };
        let state = before.map(|before| before.state).unwrap_or_default();
        let mut others = Vec::new();
        let result = match serde_json::from_value::<Asked>(task.work.clone()) {
            Ok(asked) => match self.diagnosed(&asked, &state) {
                Ok((result, improved)) => {
                    others.extend(improved.map(|text| (IMPROVED.to_owned(), text)));
                    result
                }
                // The next one begins with what the last one that could be read came to.
                Err(error) => refused(error.to_string(), state),
            },
            Err(error) => refused(error.to_string(), state),
        };
        let text = serde_json::to_string(&result).unwrap_or_default();
        Ok(store.put(&task.id, &others, &text)?)
    }

    fn diagnosed(
        &self,
        asked: &Asked,
        state: &[Started],
    ) -> Result<(Diagnosed, Option<String>), AppError> {
        let path = self.folder.join(&asked.path);
        let case = match &self.nominal {
            NominalModel::Cell(cell) => Case::of_cell(&path, cell, &[])?,
            NominalModel::Rig(rig) if path.is_dir() => Case::of_rig(rig, &path, &asked.files)?,
            NominalModel::Rig(rig) => {
                let folder = path.parent().unwrap_or(Path::new(""));
                Case::of_rig(rig, folder, &asked.files)?
            }
        };
        let (result, improved) = match &asked.fit {
            Some(fit) => (Diagnosed::of_effects(&case, fit)?, None),
            None => Diagnosed::after(&case, state)?,
        };
        Ok((result, improved))
    }
}

fn says_rig(file: &Path) -> bool {
    let text = crate::file::read_text(file).unwrap_or_default();
    text.lines().any(|line| line.trim() == "[device]") && text.contains("[sensors]")
}

/// Exit code of a task that stands.
pub(in super::super) fn report_result(store: &Store, id: &str) -> Result<ExitCode, AppError> {
    let result: Diagnosed = store.read(id)?;
    if !result.reason.is_empty() {
        say_aside(&result.reason);
    }
    Ok(match result.code {
        0 => ExitCode::Done,
        _ => ExitCode::BadInput,
    })
}
