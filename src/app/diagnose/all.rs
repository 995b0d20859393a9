//! Many cases, some at a time; one that fails does not stop the others.

use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::super::error::{AppError, ExitCode};
use super::super::files::{OverwritePolicy, claim_folder};
use super::super::interrupt::Interruptible;
use super::super::output::say;
use super::super::progress;
use super::super::terminal::{say_aside, shown_path};
use super::one::{Prepared, is_case};
use super::shared::{SharedFamily, SharingCase, shared};
use crate::case::{RIG, is_cell_case};
use crate::diagnosis::answer::{Answer, Verdict};
use crate::diagnosis::effort::EffortLimit;
use crate::document::{Block, Cell, Column, Document, Section, Style, Table, text};
use crate::replay::LoadedCell;
use crate::scenario::rig_file::load_rig;

/// Outcome of a case.
pub(super) struct Outcome {
    name: String,
    result: Result<Done, String>,
}

struct Done {
    answer: Answer,
    /// What became of what stood there already.
    note: Option<String>,
}

/// Of a case that stood there, as it would be done now.
const KEPT: &str = "stood already";

/// Diagnoses all cases below a folder, `jobs` at a time.
pub(super) fn run(
    folder: &Path,
    (cell, limit): (Option<&LoadedCell>, EffortLimit),
    out: &Path,
    policy: OverwritePolicy,
    jobs: usize,
    silent: bool,
) -> Result<Vec<Outcome>, AppError> {
    let names = cases(folder, cell.is_some())?;
    let claim = claim_folder(out)?;
    let bar = progress::cases(names.len(), silent);
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = jobs.min(names.len());
    let waiting: Mutex<VecDeque<(usize, String)>> =
        Mutex::new(names.iter().cloned().enumerate().collect());
    let outcomes: Mutex<Vec<(usize, Outcome)>> = Mutex::default();
    let interruptible = Interruptible::of_many(names.len(), "cases are diagnosed", out);
    let work = || {
        let next = || locked(&waiting).pop_front();
        while let Some((index, name)) = next() {
            let case = folder.join(&name);
            let result = caught(|| one(&case, (cell, limit), &out.join(&name), policy));
            if result.is_ok() {
                interruptible.one_more();
            }
            let mut done = locked(&outcomes);
            let (count, all) = (done.len() + 1, names.len());
            progress::without_bar(&format!("{count} of {all} cases: {name}"), silent);
            done.push((index, Outcome { name, result }));
            bar.inc(1);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                // A pool of its own: in a shared one a case would wait for parts of another, and its time would be that of both.
                let threads = (processors / jobs).max(1);
                match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                    Ok(pool) => pool.install(work),
                    Err(_) => work(),
                }
            });
        }
    });
    bar.finish_and_clear();
    drop(claim);
    // Empty where none came to a diagnosis.
    drop(std::fs::remove_dir(out));
    let mut outcomes = outcomes
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    outcomes.sort_by_key(|(index, _)| *index);
    Ok(outcomes.into_iter().map(|(_, outcome)| outcome).collect())
}

/// What the cases know together, by the parts that their rig files state.
pub(super) fn known_together(folder: &Path, outcomes: &[Outcome]) -> Vec<SharedFamily> {
    let cases = outcomes.iter().filter_map(|outcome| {
        Some(SharingCase {
            name: &outcome.name,
            answer: &outcome.result.as_ref().ok()?.answer,
            // A table of runs has no rig.
            rig: load_rig(&folder.join(&outcome.name).join(RIG)).ok()?,
        })
    });
    shared(&cases.collect::<Vec<_>>())
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A fault of ours in one case is no reason to lose the others.
fn caught(work: impl FnOnce() -> Result<Done, AppError>) -> Result<Done, String> {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(result) => result.map_err(|error| error.to_string()),
        Err(_) => Err("a fault of the program, see above; please report it".to_owned()),
    }
}

fn one(
    case: &Path,
    (cell, limit): (Option<&LoadedCell>, EffortLimit),
    out: &Path,
    policy: OverwritePolicy,
) -> Result<Done, AppError> {
    let prepared = Prepared::new((case, &[]), (cell, None, limit), Some((out, policy)))?;
    let mut again = None;
    if policy == OverwritePolicy::Keep {
        match prepared.existing()? {
            Some(Ok(existing)) => {
                return Ok(Done {
                    answer: existing.answer,
                    note: Some(KEPT.to_owned()),
                });
            }
            Some(Err(why)) => {
                say_aside(&format!("note: {}: {why}; diagnosed again", case.display()));
                again = Some(format!("done again: {why}"));
            }
            None => (),
        }
    }
    let finished = prepared.run(&mut |_| ())?;
    Ok(Done {
        answer: finished.answer,
        note: again,
    })
}

/// Names of the folders that hold a case, `case-2` before `case-10`.
fn cases(folder: &Path, of_cell: bool) -> Result<Vec<String>, AppError> {
    let refuse = |reason: String| AppError::NoCases {
        folder: folder.display().to_string(),
        reason,
    };
    let entries = std::fs::read_dir(folder).map_err(|error| refuse(error.to_string()))?;
    let paths: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    let mut names: Vec<String> = paths
        .iter()
        .filter(|path| {
            if of_cell {
                is_cell_case(path)
            } else {
                is_case(path)
            }
        })
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    if names.is_empty() {
        let reason = if of_cell {
            "none in it has recordings"
        } else {
            "none in it has a rig.toml or an arm.toml"
        };
        return Err(refuse(reason.to_owned()));
    }
    names.sort_by(|a, b| natural(a).cmp(&natural(b)).then_with(|| a.cmp(b)));
    Ok(names)
}

/// A name as runs of digits, by their value, and of other letters.
pub(in super::super) fn natural(name: &str) -> Vec<(u128, String)> {
    let mut parts: Vec<(u128, String)> = Vec::new();
    let mut rest = name;
    while !rest.is_empty() {
        let text = rest
            .find(|c: char| c.is_ascii_digit())
            .unwrap_or(rest.len());
        let (word, after) = rest.split_at(text);
        let digits = after
            .find(|c: char| !c.is_ascii_digit())
            .unwrap_or(after.len());
        let (number, after) = after.split_at(digits);
        parts.push((0, word.to_owned()));
        parts.push((number.parse().unwrap_or(u128::MAX), String::new()));
        rest = after;
    }
    parts
}

/// Prints what became of the cases.
pub(super) fn report(
    outcomes: &[Outcome],
    shared: &[SharedFamily],
    out: &Path,
    quiet: bool,
    json: bool,
) -> Result<ExitCode, AppError> {
    if json {
        for outcome in outcomes {
            let line = match &outcome.result {
                Ok(done) => serde_json::json!({ "case": outcome.name, "diagnosis": done.answer }),
                Err(error) => serde_json::json!({ "case": outcome.name, "error": error }),
            };
            say(&format!("{line}\n"))?;
        }
        if !shared.is_empty() {
            say(&format!("{}\n", serde_json::json!({ "shared": shared })))?;
        }
    } else if !quiet {
        let cases = Section::new("", vec![Block::Table(table(outcomes))]);
        let families = shared.iter().map(SharedFamily::section);
        let document = Document {
            sections: std::iter::once(cases).chain(families).collect(),
            ..Document::default()
        };
        say(&text(&document, Style::Plain))?;
        say(&format!("written to {}\n", shown_path(out)))?;
    }
    let failed: Vec<&Outcome> = outcomes.iter().filter(|o| o.result.is_err()).collect();
    for outcome in &failed {
        // As JSON they stand among the results.
        if let (Err(error), false) = (&outcome.result, json) {
            say_aside(&format!("error: {}: {error}", outcome.name));
        }
    }
    if failed.is_empty() {
        return Ok(ExitCode::Done);
    }
    Err(AppError::CasesFailed {
        failed: failed.len(),
        of: outcomes.len(),
    })
}

fn table(outcomes: &[Outcome]) -> Table {
    let row = |outcome: &Outcome| {
        let [verdict, seconds, effects] = match &outcome.result {
            Ok(Done { answer, note }) => {
                let effects = answer.effects.iter();
                let effects = effects.map(|e| e.name.clone() + &e.parameters.place_words());
                let effects: Vec<String> = effects.collect();
                let note = note.as_ref().map(|note| format!("  ({note})"));
                let effects = effects.join(" + ") + &note.unwrap_or_default();
                let seconds = format!("{:.1}", answer.seconds);
                [word(answer.verdict).to_owned(), seconds, effects]
            }
            Err(_) => ["failed".to_owned(), String::new(), String::new()],
        };
        let cells = [outcome.name.clone(), verdict, seconds, effects];
        cells.map(Cell::from).to_vec()
    };
    let columns = Column::list("case | verdict | #seconds | effects");
    Table::new("", columns, outcomes.iter().map(row).collect())
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Explained => "explained",
        Verdict::NothingMissing => "nothing missing",
        Verdict::Unlisted => "unlisted",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_count_by_their_value() {
        let mut names = ["case-10", "case-2", "b", "case-2b", "case-02", "10", "9"];
        names.sort_by(|a, b| natural(a).cmp(&natural(b)).then_with(|| a.cmp(b)));
        assert_eq!(
            names,
            ["9", "10", "b", "case-02", "case-2", "case-2b", "case-10"]
        );
    }
}
