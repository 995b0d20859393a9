//! A run of a sweep as a task.

use serde::{Deserialize, Serialize};

use super::super::error::{AppError, ExitCode};
use super::super::run::{Numbers, numbers};
use super::super::terminal::say_aside;
use crate::scenario::{KeyValue, ScenarioTemplate};
use crate::tasks::{Plan, Store, Task, TaskError};

/// What its plan is called.
pub(in super::super) const KIND: &str = "vary";

/// What all runs share, as the plan's head has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Shared {
    /// The scenario's file, from the plan's folder or the root.
    pub scenario: String,
    /// Keys with one value for all, as `--with` sets them.
    pub fixed: Vec<(String, String)>,
    /// Keys that vary.
    pub keys: Vec<String>,
}

impl Shared {
    /// The values of a run in place of the scenario's.
    pub(super) fn edits(&self, values: &[String]) -> Vec<KeyValue> {
        let fixed = self.fixed.iter().map(|(key, value)| (key, value));
        let all = fixed.chain(self.keys.iter().zip(values));
        all.map(|(key, value)| KeyValue::typed(key, value))
            .collect()
    }
}

/// Does the runs of a plan.
pub(in super::super) struct Worker {
    template: ScenarioTemplate,
    shared: Shared,
}

impl Worker {
    /// One for a plan.
    pub(in super::super) fn new(plan: &Plan) -> Result<Self, AppError> {
        let shared: Shared = serde_json::from_value(plan.head.work.clone())?;
        let file = plan.folder().join(&shared.scenario);
        Ok(Self {
            template: ScenarioTemplate::read(&file)?,
            shared,
        })
    }

    /// Does a run, and puts its numbers in their place.
    pub(in super::super) fn perform(&self, task: &Task, store: &Store) -> Result<(), TaskError> {
        let values: Vec<String> = serde_json::from_value(task.work.clone()).unwrap_or_default();
        let numbers = numbers_of(&self.template, &self.shared.edits(&values));
        let text = serde_json::to_string(&numbers).unwrap_or_default();
        Ok(store.put(&task.id, &[], &text)?)
    }
}

/// The numbers of a run with these values; what refuses it is a result as well.
pub(super) fn numbers_of(template: &ScenarioTemplate, edits: &[KeyValue]) -> Numbers {
    match template.with(edits) {
        Ok(scenario) => numbers(scenario),
        // As an edge that would end before it starts.
        Err(error) => Numbers {
            code: ExitCode::BadInput as u8,
            reason: error.to_string(),
            metrics: Vec::new(),
        },
    }
}

/// Exit code of an existing run; what it fell short of is printed.
pub(in super::super) fn report_result(store: &Store, id: &str) -> Result<ExitCode, AppError> {
    let numbers: Numbers = store.read(id)?;
    if !numbers.reason.is_empty() {
        say_aside(&numbers.reason);
    }
    Ok(match numbers.code {
        0 => ExitCode::Done,
        1 => ExitCode::OutsideBounds,
        3 => ExitCode::Stopped,
        _ => ExitCode::BadInput,
    })
}
