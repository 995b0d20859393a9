//! What would make a job possible that is refused: changes of its scenario, each of which passes the whole check and a whole run before it is given.

mod amounts;
mod candidates;
mod edge;
mod places;
mod trial;

use std::fmt;

use crate::cell::{CellError, Setup};
use crate::scenario::KeyValue;

pub use places::{anywhere, pose_edits};
pub use trial::{Effort, Manner, RunOutcome, Trial};

/// A change of a scenario with which its job can be done.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedy {
    /// What is changed, one word for programs.
    pub kind: &'static str,
    /// What is changed, for people.
    pub words: String,
    /// Keys of the scenario with their values then.
    pub edits: Vec<KeyValue>,
}

/// Changes to a scenario each of which alone makes its job possible.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Advice {
    /// The changes, in the order in which they were looked for.
    pub remedies: Vec<Remedy>,
    /// Kinds of change that were looked for.
    pub tried: Vec<&'static str>,
    /// Whether the search ended before all was tried, its extent being used up.
    pub cut_short: bool,
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let edits = self.edits.iter();
        let edits = edits.map(|edit| format!("{} = {}", edit.key(), edit.shown()));
        let edits: Vec<_> = edits.collect();
        write!(f, "{}: {}", self.words, edits.join(" and "))
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.tried.is_empty() {
            return Ok(());
        }
        if self.remedies.is_empty() {
            let tried = self.tried.join(", ");
            write!(
                f,
                "; no change was found with which it can be done (tried: {tried})"
            )?;
        } else {
            let ways = self.remedies.iter().map(ToString::to_string);
            let ways: Vec<_> = ways.collect();
            write!(f, "; it can be done with {}", ways.join(", or with "))?;
        }
        if self.cut_short {
            write!(f, "; not all was tried, --effort 3 searches longer")?;
        }
        Ok(())
    }
}

/// Changes that are made one after the other, where the first ends one refusal and meets another.
const AFTER_ANOTHER: usize = 3;

/// Looks for what would make a job possible.
#[must_use]
pub fn advise(trial: &Trial<'_>, refusal: &CellError) -> Advice {
    advise_in(trial, refusal, AFTER_ANOTHER)
}

fn advise_in(before: &Trial<'_>, refusal: &CellError, left: usize) -> Advice {
    let mut advice = Advice::default();
    let trial = &before.of(&[], refusal);
    let Some(scenario) = trial.scenario(&[]) else {
        return advice;
    };
    let kinds = candidates::kinds(&scenario, refusal);
    if kinds.is_empty() {
        return advice;
    }
    let setup = Setup::load(scenario.clone()).ok();
    trial.know(setup.as_ref().map(|setup| setup.notes.clone()));
    let mut last_resort = false;
    for kind in kinds {
        if kind.is_last_resort() && !advice.remedies.is_empty() {
            last_resort = true;
            continue;
        }
        if trial.is_over() {
            break;
        }
        trial.begin(kind.name());
        advice.tried.push(kind.name());
        let found = candidates::remedy(kind, trial, &scenario, setup.as_ref(), refusal);
        advice.remedies.extend(found);
    }
    advice.cut_short = trial.is_over() && !last_resort;
    if advice.remedies.is_empty()
        && left > 1
        && let Some((edits, other)) = trial.other_refusal()
    {
        let then = trial.of(&edits, refusal);
        let further = advise_in(&then, &other, left - 1);
        advice
            .remedies
            .extend(further.remedies.into_iter().map(|remedy| {
                let both = merged(&edits, remedy.edits);
                Remedy {
                    words: format!("several changes, the last {}", remedy.words),
                    edits: both,
                    ..remedy
                }
            }));
        advice.tried.push("several changes");
    }
    advice
}

/// Changes one after the other: of a key that both have the later.
fn merged(first: &[KeyValue], then: Vec<KeyValue>) -> Vec<KeyValue> {
    let again = |edit: &&KeyValue| then.iter().all(|later| later.key() != edit.key());
    let kept: Vec<KeyValue> = first.iter().filter(again).cloned().collect();
    kept.into_iter().chain(then).collect()
}
