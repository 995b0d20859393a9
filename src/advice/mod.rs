//! What would make a job possible that is refused: changes of its scenario, each of which passes the whole check and a whole run before it is given.

mod amounts;
mod candidates;
mod edge;
mod kind;
mod places;
mod remedy;
mod trial;

use crate::cell::{CellError, Setup};
use crate::scenario::KeyValue;

pub use places::{anywhere, pose_edits};
pub use remedy::{Advice, Remedy};
pub use trial::{Effort, RunOptions, RunOutcome, Trial};

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
