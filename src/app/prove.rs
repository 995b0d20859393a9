//! `idc prove`, `idc sweep` and `idc laboratory`: the diagnosis on cases of which the truth is known, but not to it.

use std::path::Path;

use super::cli::{LaboratoryArguments, ProveArguments, SweepArguments};
use super::diagnose::answer_case;
use super::error::{AppError, ExitCode};
use super::files::{OutputFolder, Standing, prepare_file};
use super::output::say;
use super::progress;
use crate::laboratory::{shipped, write_case};
use crate::proof::{Claims, Diagnose, SweepPlan, folders, page, prove, sweep};
use crate::recording::atomic::write_text;

/// The program's own diagnosis of a case.
fn diagnose() -> Box<Diagnose<'static>> {
    Box::new(|case: &Path, out: &Path| answer_case(case, out).map_err(|error| error.to_string()))
}

fn jobs(asked: Option<u16>) -> usize {
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.map_or_else(processors, usize::from)
}

/// Proves and prints the score.
pub(super) fn run_prove(arguments: &ProveArguments) -> Result<ExitCode, AppError> {
    let beside = || {
        arguments
            .cases
            .parent()
            .unwrap_or(Path::new(""))
            .join("sealed")
    };
    let sealed = arguments.sealed.clone().unwrap_or_else(beside);
    let jobs = jobs(arguments.jobs);
    let out = &arguments.out;
    prepare_proof(arguments)?;
    let bar = progress::bar("proving", arguments.json);
    let summary = prove(
        &arguments.cases,
        &sealed,
        &arguments.only,
        out,
        jobs,
        &*diagnose(),
        &|done, total| progress::tell(&bar, done, total),
    );
    bar.finish_and_clear();
    let summary = summary?;
    let short = summary.shortfalls(&Claims::PAGE);
    if arguments.json {
        say(&(serde_json::to_string_pretty(&summary)? + "\n"))?;
    } else {
        say(&summary.text())?;
        for sentence in &short {
            say(&format!("falls short: {sentence}\n"))?;
        }
    }
    Ok(if short.is_empty() {
        ExitCode::Done
    } else {
        ExitCode::OutsideBounds
    })
}

/// Sweeps and writes the tables.
pub(super) fn run_sweep(arguments: &SweepArguments) -> Result<ExitCode, AppError> {
    let plan = SweepPlan {
        effects: arguments.effects.clone(),
        seeds: arguments.seeds,
        draw: arguments.draw,
        sizes: usize::from(arguments.sizes),
        empty: arguments.empty,
        duration: arguments.duration_s,
        jobs: jobs(arguments.jobs),
        resume: arguments.resume,
        replace: arguments.force,
    };
    let usual = || arguments.out.join("CONFUSION.md");
    let file = arguments.page.clone().unwrap_or_else(usual);
    // The tables of a sweep that goes on take the place of its own earlier ones.
    prepare_file(&file, Standing::of(arguments.force || arguments.resume))?;
    let silent = arguments.quiet || arguments.json;
    let bar = progress::bar("sweeping", silent);
    let tell = |done: usize, total: usize, line: &str| {
        progress::tell(&bar, done, total);
        if silent {
        } else if bar.is_hidden() {
            eprintln!("{done} of {total}: {line}");
        } else {
            bar.println(format!("{done} of {total}: {line}"));
        }
    };
    let outcomes = sweep(&plan, &arguments.out, &*diagnose(), &tell);
    bar.finish_and_clear();
    let outcomes = outcomes?;
    write_text(&file, &page(&outcomes))?;
    if arguments.json {
        say(&(serde_json::to_string_pretty(&outcomes)? + "\n"))?;
    } else if !arguments.quiet {
        say(&format!(
            "{} outcomes, tables in {}\n",
            outcomes.len(),
            file.display()
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Writes the project's own cases.
pub(super) fn run_laboratory(arguments: &LaboratoryArguments) -> Result<ExitCode, AppError> {
    let out = &arguments.out;
    let [cases, sealed] = ["cases", "sealed"].map(|name| out.join(name));
    if let Some(stands) = [&cases, &sealed].into_iter().find(|path| path.exists())
        && !arguments.force
    {
        return Err(AppError::FolderStands {
            folder: out.display().to_string(),
            name: stands.file_name().unwrap_or_default().display().to_string(),
        });
    }
    let recipes = shipped();
    let bar = progress::bar("making", arguments.quiet || arguments.json);
    let mut names = Vec::new();
    for (index, recipe) in recipes.iter().enumerate() {
        let case = recipe.make().map_err(crate::proof::ProofError::from)?;
        write_case(&case, &cases.join(&recipe.name), Some(&sealed))?;
        progress::tell(&bar, index + 1, recipes.len());
        names.push(&recipe.name);
    }
    bar.finish_and_clear();
    if arguments.json {
        let document = serde_json::json!({ "cases": names, "folder": cases, "sealed": sealed });
        say(&format!("{document:#}\n"))?;
    } else if !arguments.quiet {
        say(&format!(
            "{} cases written to {}, their truth to {}\n",
            names.len(),
            cases.display(),
            sealed.display()
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Refuses to prove into a folder that holds an answer to one of the cases, or cannot be written.
fn prepare_proof(arguments: &ProveArguments) -> Result<(), AppError> {
    let folders = folders(&arguments.cases, &arguments.only)?;
    for (name, _) in folders.iter().filter(|_| !arguments.force) {
        let answer = Path::new(name).join("diagnosis.json");
        if arguments.out.join(&answer).exists() {
            return Err(AppError::FolderStands {
                folder: arguments.out.display().to_string(),
                name: answer.display().to_string(),
            });
        }
    }
    OutputFolder::prepare(&arguments.out, &[], Standing::Replace)?;
    Ok(())
}
