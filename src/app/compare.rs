//! `idc compare`: several runs, or several diagnoses, side by side.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::diagnose::DiagnosedCase;
use super::error::{AppError, ExitCode};
use super::files::{DIAGNOSIS, OverwritePolicy, SAMPLES, is_same, prepare_file};
use super::output::say;
use super::report::{read_json, read_samples};
use super::run::FinishedRun;
use super::terminal::shown_path;
use crate::document::{Style, html, text};
use crate::recording::Recording;
use crate::recording::atomic::write_text;
use crate::report::{ComparedNumber, Comparison, MOST_DRAWN, SUMMARY};
use crate::run::RunResult;

/// For the help.
pub(super) const EXAMPLES: &str = "\
Numbers of the second and further folders stand beside their change against the
first. Folders hold runs, or diagnoses, not both.

Examples:
  # two runs: numbers side by side, and a page with signals over one another
  idc run scenarios/paper_step.toml --out runs/step --quiet
  idc run scenarios/hand_push.toml --out runs/push --quiet
  idc compare runs/step runs/push --out runs/step_and_push.html
  # the same numbers for a program
  idc compare runs/step runs/push --json";

#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Folders with results, two to seven; the first is what the others are compared with.
    #[arg(num_args = 1..=MOST_DRAWN, required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// File for a page: numbers side by side, signals of runs over one another.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Put the page in place of a file of that name.
    #[arg(long)]
    force: bool,
    /// Print nothing but errors.
    #[arg(long)]
    quiet: bool,
    /// Print the numbers as JSON.
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

/// Compares and prints.
pub(super) fn run(arguments: &CompareArguments) -> Result<ExitCode, AppError> {
    if let [alone] = arguments.folders.as_slice() {
        return Err(AppError::ComparedWithNothing {
            folder: alone.display().to_string(),
        });
    }
    let compared = read(&arguments.folders)?;
    if let Some(out) = &arguments.out {
        let inputs = [DIAGNOSIS, SUMMARY, SAMPLES];
        let mut inputs =
            (arguments.folders.iter()).flat_map(|folder| inputs.map(|name| folder.join(name)));
        if inputs.any(|input| is_same(&input, out)) {
            return Err(AppError::Overwrites {
                file: out.display().to_string(),
            });
        }
        let _claim = prepare_file(out, "--out", OverwritePolicy::of(arguments.force))?;
        write_text(out, &html(&compared.document()))?;
    }
    if arguments.json {
        return print_json(&compared, arguments.out.as_deref());
    }
    if !arguments.quiet {
        say(&text(&compared.document(), Style::Plain))?;
        if let Some(out) = &arguments.out {
            say(&format!("\nwritten to {}\n", shown_path(out)))?;
        }
    }
    Ok(ExitCode::Done)
}

/// What is compared by a caller in the same process.
pub enum Compared<'a> {
    /// Folders with results of one kind.
    Folders(&'a [PathBuf]),
    /// Runs, with their names.
    Runs(Vec<(String, &'a FinishedRun)>),
    /// Diagnoses, with their names.
    Diagnoses(Vec<(String, &'a DiagnosedCase)>),
}

/// Compares as `idc compare` does: the document that --json prints, and the page.
///
/// # Errors
/// A folder that cannot be compared.
pub fn compared(of: &Compared<'_>) -> Result<(Value, String), AppError> {
    let comparison = match of {
        Compared::Folders(folders) => read(folders)?,
        Compared::Diagnoses(all) => {
            let names = all.iter().map(|(name, _)| name.clone()).collect();
            let answers = all.iter().map(|(_, case)| case.answer().clone());
            Comparison::of_diagnoses(names, &answers.collect::<Vec<_>>())
        }
        Compared::Runs(all) => {
            let names = all.iter().map(|(name, _)| name.clone()).collect();
            let results = all.iter().map(|(_, run)| run.result());
            let results = results.collect::<Result<Vec<RunResult>, _>>()?;
            let drawn = drawn(all.len()).into_iter();
            let drawn = drawn.map(|place| (place, all[place].1.recording().clone()));
            Comparison::of_runs(names, &results, drawn.collect())
        }
    };
    Ok((as_json(&comparison), html(&comparison.document())))
}

/// Writes the page of runs: the numbers of all of them, signals of as many as there are colours.
pub(super) fn write_page(folders: &[PathBuf], page: &Path) -> Result<(), AppError> {
    Ok(write_text(page, &html(&read(folders)?.document()))?)
}

/// Which of so many runs are drawn over one another: from the first to the last, evenly.
fn drawn(count: usize) -> Vec<usize> {
    match count {
        0..=MOST_DRAWN => (0..count).collect(),
        _ => (0..MOST_DRAWN)
            .map(|place| place * (count - 1) / (MOST_DRAWN - 1))
            .collect(),
    }
}

fn read(folders: &[PathBuf]) -> Result<Comparison, AppError> {
    let diagnosed = |folder: &PathBuf| folder.join(DIAGNOSIS).is_file();
    let is_run = |folder: &PathBuf| folder.join(SUMMARY).is_file();
    for folder in folders {
        if !diagnosed(folder) && !is_run(folder) {
            return Err(AppError::NotCompared {
                folder: folder.display().to_string(),
            });
        }
    }
    let names = folders.iter().map(|f| f.display().to_string()).collect();
    if folders.iter().all(diagnosed) {
        let answers = folders.iter().map(|f| read_json(&f.join(DIAGNOSIS)));
        return Ok(Comparison::of_diagnoses(
            names,
            &answers.collect::<Result<Vec<_>, _>>()?,
        ));
    }
    let odd = folders.iter().find(|folder| diagnosed(folder));
    let run = folders.iter().find(|folder| !diagnosed(folder));
    if let (Some(odd), Some(run)) = (odd, run) {
        return Err(AppError::MixedResults {
            diagnosis: odd.display().to_string(),
            run: run.display().to_string(),
        });
    }
    let results = folders.iter().map(|f| read_json(&f.join(SUMMARY)));
    let results = results.collect::<Result<Vec<RunResult>, _>>()?;
    let drawn: Vec<(usize, Recording)> = drawn(folders.len())
        .into_iter()
        .map(|place| Ok((place, read_samples(&folders[place])?)))
        .collect::<Result<_, AppError>>()?;
    Ok(Comparison::of_runs(names, &results, drawn))
}

fn print_json(compared: &Comparison, out: Option<&Path>) -> Result<ExitCode, AppError> {
    let mut document = as_json(compared);
    document["page"] = json!(out);
    say(&format!("{}\n", serde_json::to_string_pretty(&document)?))?;
    Ok(ExitCode::Done)
}

fn as_json(compared: &Comparison) -> Value {
    let number = |number: &ComparedNumber| json!({"key": number.key, "name": number.name, "values": number.values});
    json!({
        "folders": compared.names,
        "verdicts": compared.verdicts,
        "numbers": compared.numbers.iter().map(number).collect::<Vec<Value>>(),
    })
}
