//! What would make a job possible, looked for when it is refused, and reported with the refusal.

use std::io::IsTerminal as _;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::error::AppError;
use super::progress;
use super::terminal::say_aside;
use crate::advice::{Advice, Effort, Remedy, RunOptions, RunOutcome, Trial, advise};
use crate::cell::{Cell, CellError};
use crate::run::{RunError, run_cell};
use crate::scenario::{KeyValue, ScenarioTemplate};

/// Time that a search of the usual extent may take [s]; it is shorter unless the computer is slow or busy.
const PATIENCE: f64 = 20.0;
/// Where there is no terminal nothing is reported of a search that takes less.
const SHORT: Duration = Duration::from_secs(2);

/// Extent of the search for advice.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct AdviceArguments {
    /// Extent of the search for changes that make a refused job possible: 1 for the usual one, at most 20 s; 0 for none, 3 for three times as much.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = factor)]
    effort: f64,
}

fn factor(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok();
    let value = value.filter(|value| (0.0..=1000.0).contains(value));
    value.ok_or_else(|| "expected a number from 0 to 1000".to_owned())
}

impl AdviceArguments {
    /// A refusal of a cell with what would help; `given` are changes of the file that are there already.
    pub(super) fn with_advice(
        self,
        error: AppError,
        template: &ScenarioTemplate,
        given: &[KeyValue],
        quiet: bool,
    ) -> AppError {
        let advice = match &error {
            AppError::Run(run) => match &**run {
                RunError::Cell(refusal) => self.search(template, given, refusal, quiet),
                _ => return error,
            },
            _ => return error,
        };
        match advice.tried.is_empty() {
            true => error,
            false => AppError::Advised {
                source: Box::new(error),
                advice: Box::new(advice),
            },
        }
    }

    /// Looks for what would help.
    pub(super) fn search(
        self,
        template: &ScenarioTemplate,
        given: &[KeyValue],
        refusal: &CellError,
        quiet: bool,
    ) -> Advice {
        if self.effort == 0.0 {
            return Advice::default();
        }
        let begin = Instant::now();
        let patience = Duration::from_secs_f64(PATIENCE * self.effort);
        let line = progress::spinner("looking for what would make it possible", quiet);
        // Where there is no terminal the line is not drawn.
        let plain = !quiet && !std::io::stderr().is_terminal();
        let tell = |what: &'static str| {
            let words = format!("looking for what would make it possible: {what}");
            if plain && begin.elapsed() > SHORT {
                say_aside(&words);
            }
            progress::words(&line, &words);
        };
        let keep_on = || begin.elapsed() < patience;
        let trial = Trial::new(
            template,
            given,
            Effort::times(self.effort),
            &RunOptions {
                runs: &outcome,
                tell: &tell,
                keep_on: &keep_on,
            },
        );
        let advice = advise(&trial, refusal);
        line.finish_and_clear();
        advice
    }
}

/// Runs a cell to its end.
pub(super) fn outcome(cell: &Cell) -> Option<RunOutcome> {
    let finished = run_cell(cell, &mut |_| ()).ok()?;
    let summary = &finished.summary;
    let share = |percent: f64| 1e-2 * percent;
    Some(RunOutcome {
        stopped: finished.stop.is_some(),
        force: summary.force_mean_n,
        lost: summary.loss_of_contact_share_percent.map(share),
        torque: summary.joint_torque_share_percent.map(share),
    })
}

/// Remedies for programs: kind, words, and keys with their values.
pub(super) fn as_json(advice: &Advice) -> Value {
    let one = |remedy: &Remedy| {
        let set = remedy.edits.iter();
        let set = set.map(|edit| (edit.key().to_owned(), value(edit)));
        let set: serde_json::Map<String, Value> = set.collect();
        serde_json::json!({ "kind": remedy.kind, "words": remedy.words, "set": set })
    };
    Value::Array(advice.remedies.iter().map(one).collect())
}

/// A value as JSON: numbers, truth values and lists are themselves, texts are texts.
fn value(edit: &KeyValue) -> Value {
    let shown = edit.shown();
    serde_json::from_str(&shown).unwrap_or(Value::String(shown))
}
