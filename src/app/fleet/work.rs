//! A recording of a fleet as a task: first by what explained the last one, and by nothing; where neither leaves noise alone, by a search.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::super::error::{AppError, ExitCode};
use crate::case::{Case, diagnose};
use crate::diagnosis::answer::Verdict;
use crate::diagnosis::answer::estimate::Number;
use crate::diagnosis::search::known::{KnownEffects, KnownFit};
use crate::diagnosis::settings::Settings;
use crate::effects::Effect;
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
    /// What is believed of all devices: a cell's scenario, or a rig file, from the plan's folder or the root.
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

/// An effect with the values that a fit starts from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Started {
    pub name: String,
    pub values: Vec<f64>,
}

/// A number with its interval at 95 %.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Told {
    pub name: String,
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// What a recording came to.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Diagnosed {
    /// 0, or 2 where it could not be read.
    pub code: u8,
    /// Why it could not be read; empty where it could.
    pub reason: String,
    /// `nothing_missing`, `explained` or `unlisted`.
    pub verdict: String,
    /// Whether it took a search.
    pub searched: bool,
    /// What is at work, and its numbers that are told.
    pub effects: Vec<(String, Vec<Told>)>,
    /// What is believed within a tolerance, as the recording has it.
    pub tolerated: Vec<Told>,
    /// What the next recording begins with.
    pub state: Vec<Started>,
}

/// What is believed.
enum Believed {
    Rig(Box<RigFile>),
    Cell(Box<LoadedCell>),
}

/// Does the tasks of a plan.
pub(in super::super) struct Worker {
    believed: Believed,
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

    /// One for what is believed, with recordings named from a folder.
    pub(super) fn of(file: &Path, folder: &Path) -> Result<Self, AppError> {
        let believed = match load_rig(file) {
            Ok(rig) => Believed::Rig(Box::new(rig)),
            Err(of_rig) => match LoadedCell::load(file) {
                Ok(cell) => Believed::Cell(Box::new(cell)),
                // A file of a rig that has a fault is told as such.
                Err(_) if says_rig(file) => return Err(of_rig.into()),
                Err(of_cell) => return Err(of_cell.into()),
            },
        };
        Ok(Self {
            believed,
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
        let case = match &self.believed {
            Believed::Cell(cell) => Case::of_cell(&path, cell)?,
            Believed::Rig(rig) if path.is_dir() => Case::of_rig(rig, &path, &asked.files)?,
            Believed::Rig(rig) => {
                let folder = path.parent().unwrap_or(Path::new(""));
                Case::of_rig(rig, folder, &asked.files)?
            }
        };
        if let Some(fit) = &asked.fit {
            let fitted = case.known_fit(&[known(&case, fit)])?;
            return Ok((
                fitted.map(|fit| of_fit(&case, &fit)).unwrap_or_default(),
                None,
            ));
        }
        let mut sets = vec![Vec::new()];
        if !state.is_empty() {
            sets.push(known(&case, state));
        }
        if let Some(fit) = case.known_fit(&sets)?
            && fit.leaves_noise
        {
            return Ok((of_fit(&case, &fit), None));
        }
        let searched = diagnose(&case, &Settings::default(), &mut |_| ())?;
        let mut result = Diagnosed {
            verdict: word(searched.answer.verdict).to_owned(),
            searched: true,
            ..Diagnosed::default()
        };
        if let Some(diagnosis) = &searched.diagnosis {
            let numbers = &diagnosis.estimates;
            fill(&mut result, &case, &numbers.effects, &numbers.tolerated);
            if searched.answer.verdict == Verdict::Unlisted {
                result.effects.push(("unlisted".to_owned(), Vec::new()));
            }
        }
        Ok((result, Some(searched.improved)))
    }
}

fn says_rig(file: &Path) -> bool {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    text.lines().any(|line| line.trim() == "[device]") && text.contains("[sensors]")
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Explained => "explained",
        Verdict::NothingMissing => "nothing_missing",
        Verdict::Unlisted => "unlisted",
    }
}

/// Effects by their names, of those that the case may have.
fn known(case: &Case, started: &[Started]) -> KnownEffects {
    let candidates = case.input().map(|input| &input.candidates);
    let find = |name: &str| {
        candidates?
            .iter()
            .find(|effect| effect.name == name)
            .copied()
    };
    let of = |one: &Started| Some((find(&one.name)?, one.values.clone()));
    started.iter().filter_map(of).collect()
}

fn of_fit(case: &Case, fit: &KnownFit) -> Diagnosed {
    let verdict = match fit.effects.is_empty() {
        true => "nothing_missing",
        false => "explained",
    };
    let mut result = Diagnosed {
        verdict: verdict.to_owned(),
        ..Diagnosed::default()
    };
    fill(&mut result, case, &fit.effects, &fit.tolerated);
    result
}

fn fill(
    result: &mut Diagnosed,
    case: &Case,
    effects: &[(&'static Effect, Vec<Number>)],
    tolerated: &[Number],
) {
    let told = |number: &Number| Told {
        name: number.name.to_owned(),
        value: number.value,
        low: number.interval[0],
        high: number.interval[1],
    };
    for (effect, numbers) in effects {
        let reported = numbers.iter().filter(|number| number.reported).map(told);
        result
            .effects
            .push((effect.name.to_owned(), reported.collect()));
        let Some(input) = case.input() else { continue };
        let parameters = effect.parameters(&input.believed);
        let value = |name: &str| numbers.iter().find(|n| n.name == name).map(|n| n.value);
        let values: Option<Vec<f64>> = parameters.iter().map(|p| value(p.quantity.name)).collect();
        if let (Some(values), None) = (values, effect.phase) {
            let name = effect.name.to_owned();
            result.state.push(Started { name, values });
        }
    }
    result.tolerated = tolerated.iter().map(told).collect();
}

/// Exit code of a task that stands.
pub(in super::super) fn told(store: &Store, id: &str) -> Result<ExitCode, AppError> {
    let result: Diagnosed = store.read(id)?;
    if !result.reason.is_empty() {
        eprintln!("{}", result.reason);
    }
    Ok(match result.code {
        0 => ExitCode::Done,
        _ => ExitCode::BadInput,
    })
}
