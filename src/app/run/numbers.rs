//! A run of which only the numbers are wanted: nothing is written.

use serde::{Deserialize, Serialize};

use super::super::error::{AppError, ExitCode};
use crate::run::{Job, RunError, outside};
use crate::scenario::AnyScenario;

/// The numbers of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in super::super) struct Numbers {
    /// Its exit code, as that of `idc run`.
    pub code: u8,
    /// What stopped it, was refused, or lies outside its bounds; empty where all is well.
    pub reason: String,
    /// Its metrics in the order of their list, none where it does not determine one; empty where it was refused.
    pub metrics: Vec<Option<f64>>,
}

/// Whether a scenario can be run, as far as is known before it is.
pub(in super::super) fn can_run(scenario: AnyScenario) -> Result<(), AppError> {
    Ok(Job::new(scenario).map(drop)?)
}

/// Runs a scenario; what refuses it is a result as well.
pub(in super::super) fn numbers(scenario: AnyScenario) -> Numbers {
    let refused = |error: RunError| Numbers {
        code: ExitCode::BadInput as u8,
        reason: error.to_string(),
        metrics: Vec::new(),
    };
    let run = Job::new(scenario).and_then(|job| job.run(&mut |_, _| ()));
    run.map_or_else(refused, |outcome| {
        let outside = outside(&outcome.bounds);
        let (code, reason) = match &outcome.stop {
            Some(stop) => (ExitCode::Stopped, format!("stopped: {stop}")),
            None if outside.is_empty() => (ExitCode::Done, String::new()),
            None => (ExitCode::OutsideBounds, outside.join("; ")),
        };
        Numbers {
            code: code as u8,
            reason,
            metrics: outcome.metrics.iter().map(|(_, value)| *value).collect(),
        }
    })
}
