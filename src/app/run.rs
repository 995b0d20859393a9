//! `idc run`: from a scenario to its recording and numbers, once or with `--set` for each of several values.

mod cell_run;
mod command;
mod in_process;
mod job;
mod numbers;
mod settings;
mod source;
mod table;
mod variants;

pub(super) use cell_run::{Listener, RunPart};
pub(super) use command::RunArguments;
pub(super) use in_process::edits_of;
pub use in_process::{EditedScenario, FinishedRun, RunFolder};
pub(super) use numbers::{Numbers, can_run, numbers};
pub(super) use settings::blamed;

use super::error::{AppError, ExitCode};
use super::files::{VARIED, is_same};
use crate::run::apply_effects;
use crate::scenario::{ScenarioTemplate, load_any};
use command::one;
use settings::product;

/// Runs a scenario, or each of its variants.
pub(super) fn run(arguments: &RunArguments) -> Result<ExitCode, AppError> {
    let mut variants = product(&arguments.settings)?;
    let Some(template) = (!arguments.settings.is_empty() || !arguments.effects.is_empty())
        .then(|| ScenarioTemplate::read(&arguments.scenario))
        .transpose()?
    else {
        return one(arguments, load_any(&arguments.scenario)?, None);
    };
    let effects = apply_effects(&arguments.effects, &template)?;
    for variant in &mut variants {
        variant.edits.splice(0..0, effects.iter().cloned());
    }
    if let Some(input) = (variants.iter())
        .map(|variant| arguments.folder().join(&variant.name).join(VARIED))
        .find(|copy| is_same(copy, &arguments.scenario))
    {
        let file = input.display().to_string();
        return Err(AppError::Overwrites { file });
    }
    let [alone] = variants.as_slice() else {
        if arguments.view.is_some() {
            let runs = variants.len();
            return Err(AppError::ViewOfSeveral { runs });
        }
        return variants::run(arguments, &template, &variants);
    };
    let scenario =
        (template.with(&alone.edits)).map_err(|error| blamed(error, &alone.edits, &template))?;
    one(arguments, scenario, Some((&template, alone)))
}
