//! `idc prove`, `idc sweep` and `idc laboratory`: the diagnosis on cases of which the truth is known, but not to it.

use std::path::{Path, PathBuf};

use super::diagnose::answer_case;
use clap::Args;

use super::error::{AppError, ExitCode};
use super::files::{OutputFolder, Standing, prepare_file};
use super::output::say;
use super::progress;
use crate::laboratory::{shipped, write_case};
use crate::proof::{Claims, Diagnose, SweepPlan, folders, page, prove, sweep};
use crate::recording::atomic::write_text;

#[derive(Debug, Args)]
pub(super) struct ProveArguments {
    /// Folder of cases, each a folder with rig.toml and recordings.
    #[arg(long, default_value = "assets/proof/cases")]
    cases: PathBuf,
    /// Folder of what is sealed, opened only once all is diagnosed [default: the folder `sealed` beside that of the cases].
    #[arg(long)]
    sealed: Option<PathBuf>,
    /// Names of the cases to take [default: all].
    #[arg(long, num_args = 1..)]
    only: Vec<String>,
    /// Folder for the answers.
    #[arg(long, default_value = "runs/proof", help_heading = "Output")]
    out: PathBuf,
    /// Cases at a time [default: as many as there are processors].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Print the score as JSON.
    #[arg(long, help_heading = "Output")]
    json: bool,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
}

#[derive(Debug, Args)]
pub(super) struct SweepArguments {
    /// Folder for the outcomes, one file for each case.
    #[arg(long, help_heading = "Output")]
    out: PathBuf,
    /// Effects by name, divided by commas [default: all of the vocabulary].
    #[arg(long, value_delimiter = ',')]
    effects: Vec<String>,
    /// Devices for each size of each effect.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(0..=1000))]
    seeds: u64,
    /// Sizes of each effect.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=16))]
    sizes: u16,
    /// Devices with nothing missing.
    #[arg(long, default_value_t = 150)]
    empty: u64,
    /// Which devices are drawn: another number, others.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u64).range(0..1_000_000))]
    draw: u64,
    /// Length of each recording [s].
    #[arg(long, default_value_t = 4.0, value_parser = duration)]
    duration_s: f64,
    /// Cases at a time [default: as many as there are processors].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Go on where it was stopped.
    #[arg(long)]
    resume: bool,
    /// File for the tables [default: CONFUSION.md in the output folder].
    #[arg(long, help_heading = "Output")]
    page: Option<PathBuf>,
    /// Put new results in place of old ones.
    #[arg(long, conflicts_with = "resume", help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print the outcomes as JSON.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// Length of a recording [s].
fn duration(text: &str) -> Result<f64, String> {
    let expected = || format!("`{text}` is no length of a recording, expected 2 to 60 s");
    let value: f64 = text.parse().map_err(|_| expected())?;
    if (2.0..=60.0).contains(&value) {
        Ok(value)
    } else {
        Err(expected())
    }
}

#[derive(Debug, Args)]
pub(super) struct LaboratoryArguments {
    /// Folder for `cases` and `sealed`.
    #[arg(long, help_heading = "Output")]
    out: PathBuf,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print as JSON which cases were written.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

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
    let option = if arguments.page.is_some() {
        "--page"
    } else {
        "--out"
    };
    plan.check()?;
    prepare_file(
        &file,
        option,
        Standing::of(arguments.force || arguments.resume),
    )?;
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
        let document = serde_json::json!({ "cases": names, "folder": cases.display().to_string(), "sealed": sealed.display().to_string() });
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
