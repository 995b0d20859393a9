//! `idc compare`: several runs, or several diagnoses, side by side.

mod numbers;
mod page;

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::error::{AppError, ExitCode};
use super::files::{DIAGNOSIS, OverwritePolicy, SAMPLES, SUMMARY, is_same, prepare_file};
use super::output::say;
use super::report::{RunResult, read_json, read_run};
use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::words::{capital, display_name, of_column, percent};
use crate::document::html;
use crate::metrics::Label;
use crate::recording::atomic::write_text;
use numbers::{Compared, MOST, Row, text};

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

/// Parameter of an effect that says which joint it is about.
const JOINT: &str = "joint";

#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Folders with results, two to seven; the first is what the others are compared with.
    #[arg(num_args = 1..=MOST, required = true, value_name = "FOLDER")]
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
        prepare_file(out, "--out", OverwritePolicy::of(arguments.force))?;
        write_text(out, &html(&page::page(&compared)))?;
    }
    if arguments.json {
        return print_json(&compared, arguments.out.as_deref());
    }
    if !arguments.quiet {
        say(&text(&compared))?;
        if let Some(out) = &arguments.out {
            say(&format!("\nwritten to {}\n", out.display()))?;
        }
    }
    Ok(ExitCode::Done)
}

/// Writes the page of runs: the numbers of all of them, signals of as many as there are colours.
pub(super) fn write_page(folders: &[PathBuf], page: &Path) -> Result<(), AppError> {
    Ok(write_text(page, &html(&page::page(&read(folders)?)))?)
}

/// Which of so many runs are drawn over one another: from the first to the last, evenly.
fn drawn(count: usize) -> Vec<usize> {
    match count {
        0..=MOST => (0..count).collect(),
        _ => (0..MOST)
            .map(|place| place * (count - 1) / (MOST - 1))
            .collect(),
    }
}

fn read(folders: &[PathBuf]) -> Result<Compared, AppError> {
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
        return Ok(of_diagnoses(
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
    let documents = folders.iter().map(|f| read_json(&f.join(SUMMARY)));
    let documents = documents.collect::<Result<Vec<Value>, _>>()?;
    let drawn: Vec<(usize, RunResult<'static>)> = drawn(folders.len())
        .into_iter()
        .map(|place| Ok((place, read_run(&folders[place])?)))
        .collect::<Result<_, AppError>>()?;
    Ok(of_runs(names, &documents, drawn))
}

fn of_runs(
    names: Vec<String>,
    documents: &[Value],
    drawn: Vec<(usize, RunResult<'static>)>,
) -> Compared {
    let mut labels: Vec<Label> = Vec::new();
    for (label, _) in drawn.iter().flat_map(|(_, run)| run.metrics()) {
        if !labels.iter().any(|known| known.key == label.key) {
            labels.push(label);
        }
    }
    let row = |label: Label| {
        let value = |document: &Value| document["summary"][label.key].as_f64();
        Row {
            unit: label.unit.to_owned(),
            key: label.key.to_owned(),
            factor: 1.0,
            values: documents.iter().map(value).collect(),
            name: label.name,
        }
    };
    Compared {
        rows: labels.into_iter().map(row).collect(),
        verdicts: documents.iter().map(title).collect(),
        names,
        drawn,
    }
}

fn title(document: &Value) -> String {
    document["title"].as_str().unwrap_or("a run").to_owned()
}

fn of_diagnoses(names: Vec<String>, answers: &[Answer]) -> Compared {
    let mut rows: Vec<Row> = Vec::new();
    let mut add = |name: String, unit: &str, factor, place: usize, key: String, value| {
        let index = match rows.iter().position(|row| row.key == key) {
            Some(index) => index,
            None => {
                rows.push(Row {
                    name,
                    unit: unit.to_owned(),
                    key,
                    factor,
                    values: vec![None; answers.len()],
                });
                rows.len() - 1
            }
        };
        rows[index].values[place] = Some(value);
    };
    for (place, answer) in answers.iter().enumerate() {
        for effect in &answer.effects {
            // Frictions of two joints are two effects.
            let of_joint = |(name, joint): &&(String, Estimate)| name == JOINT && joint.value > 0.0;
            let own = match effect.parameters.iter().find(of_joint) {
                Some((_, joint)) => format!("{}_{}", effect.name, joint.value),
                None => effect.name.clone(),
            };
            let words = own.replace('_', " ");
            let key = format!("{own}.probability");
            add(
                format!("{words}: probability"),
                "",
                1.0,
                place,
                key,
                effect.confidence,
            );
            let numbers = effect.parameters.iter().filter(|(name, _)| name != JOINT);
            for (name, estimate) in numbers {
                let (display_name, unit, factor) = display_name(name);
                let key = format!("{own}.{name}");
                add(
                    format!("{words}: {display_name}"),
                    unit,
                    factor,
                    place,
                    key,
                    estimate.value,
                );
            }
        }
        for error in &answer.details.prediction {
            let (display_name, unit, factor) = of_column(&error.channel);
            let key = format!("prediction.{}", error.channel);
            let name = format!("error of {display_name}, not fitted to");
            add(name, unit, factor, place, key, error.after);
        }
    }
    let verdict = |answer: &Answer| {
        let headline = capital(&answer.details.account.headline.replace('_', " "));
        match answer.details.explained_share {
            Some(share) => format!("{headline} ({} of the mismatch explained)", percent(share)),
            None => headline,
        }
    };
    Compared {
        names,
        verdicts: answers.iter().map(verdict).collect(),
        rows,
        drawn: Vec::new(),
    }
}

fn print_json(compared: &Compared, out: Option<&Path>) -> Result<ExitCode, AppError> {
    let row = |row: &Row| json!({"key": row.key, "name": row.name, "values": row.values});
    let document = json!({
        "folders": compared.names,
        "verdicts": compared.verdicts,
        "numbers": compared.rows.iter().map(row).collect::<Vec<Value>>(),
        "page": out,
    });
    say(&format!("{}\n", serde_json::to_string_pretty(&document)?))?;
    Ok(ExitCode::Done)
}
