//! `idc diagnose`: from a folder with a rig file and recordings to what the model lacks, for one case or many.

mod all;
mod board;
mod cell_scene;
mod comparison_files;
mod fit_picture;
mod flange_picture;
mod in_process;
mod one;
mod outputs;
mod postures_picture;
mod removal_picture;
mod shared;
pub(super) mod stages;
mod unlisted_picture;

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

pub(super) use all::natural;
pub(super) use comparison_files::read_comparison;
pub use in_process::{CaseRequest, DiagnosedCase, diagnose_case};

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, output_folder};
use super::interrupt::Interruptible;
use super::output::say;
use super::progress::StagedLine;
use super::terminal::{say_aside, shown_path};
use crate::diagnosis::effort::EffortLimit;
use crate::diagnosis::search::progress::Progress;
use crate::plant::LawText;
use crate::replay::LoadedCell;
use crate::scenario::effects::law_of_line;
use stages::Stages;

#[derive(Debug, Args)]
pub(super) struct DiagnoseArguments {
    /// Folder with rig.toml, arm.toml or postures.toml and the recordings that it names; with --all, a folder of such folders.
    case: PathBuf,
    /// Folder for diagnosis.json, prediction.csv, improved.toml and account.txt [default: runs/<name of the case's folder>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Scenario file of a recorded cell (kind = "recorded_cell"): cases then hold recordings alone, and one without measured columns is to be predicted.
    #[arg(long)]
    scenario: Option<PathBuf>,
    /// A recording beside those that rig.toml names or, of a cell, that are in the folder, as often as needed. Where --out holds a diagnosis of the
    /// others, it is gone on from and takes the recording in: what is settled stays, and odds are those of all recordings.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["all", "resume"])]
    with_recording: Vec<PathBuf>,
    /// Diagnose every folder in it that holds a rig.toml, an arm.toml or a postures.toml, each into a folder of its name, and state what they show together of parts that they share.
    #[arg(long)]
    all: bool,
    /// Go on where it was stopped: what has been diagnosed already is left as it is.
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Put new diagnoses in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Cases at a time with --all [default: 1, on all processors]; the processors are shared among them, and results do not depend on it.
    #[arg(long, requires = "all", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// A law of your own, tried beside the tool's: where it acts, an expression in SI, and what is to be found, as in
    /// "piston_force: -c * max(v, 0); c = 100..1000"; variables and ports stand in scenarios/README.md
    #[arg(long = "try", value_name = "LAW", value_parser = law_of_line, allow_hyphen_values = true, conflicts_with = "all")]
    tried: Option<LawText>,
    /// Stop the search after so many model evaluations, with the best answer so
    /// far: the same answer each time
    #[arg(long, value_name = "EVALUATIONS", help_heading = "Limits",
        value_parser = clap::value_parser!(u64).range(1..))]
    effort: Option<u64>,
    /// Stop the search after so long (90s, 5min, 1h), with the best answer so far;
    /// it says the --effort that comes to the same
    #[arg(long, value_name = "TIME", help_heading = "Limits", value_parser = duration,
        conflicts_with = "effort")]
    limit: Option<Duration>,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print on stderr what the search tries, and what each explanation would cost.
    #[arg(long, conflicts_with_all = ["quiet", "all"])]
    verbose: bool,
    /// Print what diagnosis.json holds instead of the account; with --all, one line for each case, and one of what they show together.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

impl DiagnoseArguments {
    /// Limit of the search.
    fn limit(&self) -> EffortLimit {
        match (self.effort, self.limit) {
            (Some(evaluations), _) => EffortLimit::Evaluations(evaluations),
            (None, Some(time)) => EffortLimit::Time(time),
            (None, None) => EffortLimit::None,
        }
    }
}

/// A time with its unit.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    let units = [("min", 60.0), ("ms", 1e-3), ("s", 1.0), ("h", 3600.0)];
    let read = units.iter().find_map(|(unit, factor)| {
        let value: f64 = text.strip_suffix(unit)?.trim_end().parse().ok()?;
        (value > 0.0 && value * factor < 1e9).then(|| Duration::from_secs_f64(value * factor))
    });
    read.ok_or_else(|| {
        "expected a time above zero with its unit: s, min or h, as in 120s".to_owned()
    })
}

/// Diagnoses and writes.
pub(super) fn run(arguments: &DiagnoseArguments) -> Result<ExitCode, AppError> {
    let out = output_folder(arguments.out.as_ref(), &arguments.case);
    let policy = match (arguments.resume, arguments.force) {
        (true, _) => OverwritePolicy::Keep,
        (_, true) => OverwritePolicy::Replace,
        _ => OverwritePolicy::Refuse,
    };
    let cell = arguments
        .scenario
        .as_deref()
        .map(LoadedCell::load)
        .transpose()?;
    let cell = cell.as_ref();
    if arguments.all {
        // One at a time on all processors is no slower in all, and each is done sooner.
        let jobs = arguments.jobs.map_or(1, usize::from);
        let silent = arguments.quiet || arguments.json;
        let of = (cell, arguments.limit());
        let outcomes = all::run(&arguments.case, of, &out, policy, jobs, silent)?;
        // A cell's cases have one file of it, and no parts to tell apart.
        let shared = match cell {
            Some(_) => Vec::new(),
            None => all::known_together(&arguments.case, &outcomes),
        };
        return all::report(&outcomes, &shared, &out, arguments.quiet, arguments.json);
    }
    let silent = arguments.quiet || arguments.json || arguments.verbose;
    let _interruptible = Interruptible::of_one("diagnosis", &out);
    let line = StagedLine::new(&stages::first(), silent);
    let tried = arguments.tried.clone();
    let mut prepared = one::Prepared::new(
        (&arguments.case, &arguments.with_recording),
        (cell, tried, arguments.limit()),
        Some((&out, policy)),
    )?;
    if let Some(why) = prepared.begins_anew()? {
        say_aside(&format!(
            "note: {}: {why}; diagnosed from the beginning",
            out.display()
        ));
    }
    if policy == OverwritePolicy::Keep {
        match prepared.existing()? {
            Some(Ok(existing)) => {
                line.end();
                return show_existing(arguments, &out, &existing);
            }
            Some(Err(why)) => {
                say_aside(&format!("note: {}: {why}; diagnosed again", out.display()));
            }
            None => (),
        }
    }
    let mut stages = Stages::default();
    line.tell(Stages::begun(), None);
    let finished = prepared.run(&mut |progress: &Progress<'_>| {
        let (words, behind) = stages.shown(progress);
        line.tell(words, behind);
        if arguments.verbose {
            say_aside(&progress.to_string());
        }
    });
    line.end();
    let finished = finished?;
    if arguments.json {
        say(&finished.document)?;
    } else if !arguments.quiet {
        say(&finished.account)?;
        say(&format!(
            "\nwritten to {}: {}\n",
            shown_path(&out),
            finished.names.join(", ")
        ))?;
    }
    Ok(ExitCode::Done)
}

fn show_existing(
    arguments: &DiagnoseArguments,
    out: &std::path::Path,
    existing: &one::Existing,
) -> Result<ExitCode, AppError> {
    if arguments.json {
        say(&existing.document)?;
    } else if !arguments.quiet {
        say(&format!("{} holds a diagnosis already\n", out.display()))?;
    }
    Ok(ExitCode::Done)
}

/// Diagnoses a case into a folder, in place of what stands there.
pub(super) fn answer_case(
    case: &std::path::Path,
    out: &std::path::Path,
) -> Result<crate::diagnosis::answer::Answer, AppError> {
    let prepared = one::Prepared::new(
        (case, &[]),
        (None, None, EffortLimit::None),
        Some((out, OverwritePolicy::Replace)),
    )?;
    Ok(prepared.run(&mut |_| ())?.answer)
}
