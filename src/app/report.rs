//! report.html: what a folder of results holds, as one file for a browser.

mod charts;
mod design;
mod diagnosis;
mod estimated;
mod finished_edge;
mod judged;
mod provenance;
mod robustness;
mod run;
mod run_result;
mod signals;
mod tables;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;

use super::diagnose::read_comparison;
use super::error::{AppError, ExitCode};
use super::files::{
    BALANCE, CELL, COMPARISON, DESIGN, DIAGNOSIS, DRAWING, EDGE, EDGE_PROFILE, FRONT, LEAN,
    OverwritePolicy, REPORT, ROBUSTNESS, SAMPLES, SUMMARY, is_same, prepare_file,
};
use super::fleet::{self, FLEET};
use super::output::say;
use super::vary::{self, SWEEP};
use crate::diagnosis::answer::Answer;
use crate::diagnosis::difference::comparison::Comparison;
use crate::document::html;
use crate::recording::RecordingError;
use crate::recording::atomic::write_text;
use crate::recording::csv::EdgeProfile;
use crate::recording::parquet::read_parquet;

pub(super) use charts::{lacking, robust_range, variable};
pub(super) use provenance::sources;
pub(super) use run::{of_run, page_of_run};
pub(super) use run_result::RunResult;
pub(super) use signals::{ROLES, chart_groups};

/// For the help.
pub(super) const EXAMPLES: &str = "\
The folder is one that run, diagnose or design wrote; they write the page
themselves at their end. It is one file that needs no network: it can be mailed,
printed, and opened on a phone.

Examples:
  # the page anew, from the other files of the folder
  idc run scenarios/paper_step.toml --out runs/step --quiet
  idc report runs/step
  # elsewhere
  idc report runs/step --out runs/step_for_you.html";

#[derive(Debug, Args)]
pub(super) struct ReportArguments {
    /// Folder with the results of a run, a diagnosis or a study.
    folder: PathBuf,
    /// File for the page [default: report.html in the folder].
    #[arg(long)]
    out: Option<PathBuf>,
    /// Put the page in place of a file that --out names.
    #[arg(long)]
    force: bool,
    /// Print nothing but errors.
    #[arg(long)]
    quiet: bool,
    /// Print what was written as JSON.
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

/// Writes the page of a folder.
pub(super) fn run(arguments: &ReportArguments) -> Result<ExitCode, AppError> {
    let folder = &arguments.folder;
    let inputs = [
        DIAGNOSIS,
        COMPARISON,
        BALANCE,
        SUMMARY,
        SAMPLES,
        CELL,
        EDGE,
        EDGE_PROFILE,
        LEAN,
        DRAWING,
        DESIGN,
        FRONT,
        ROBUSTNESS,
        SWEEP,
        vary::RUNS,
        FLEET,
    ];
    if let Some(out) = &arguments.out
        && inputs.iter().any(|name| is_same(&folder.join(name), out))
    {
        return Err(AppError::Overwrites {
            file: out.display().to_string(),
        });
    }
    let (kind, text) = if folder.join(DIAGNOSIS).is_file() {
        let answer: Answer = read_json(&folder.join(DIAGNOSIS))?;
        (
            "diagnosis",
            of_diagnosis(&answer, &read_comparison(folder)?),
        )
    } else if folder.join(SUMMARY).is_file() {
        ("run", of_run(&read_run(folder)?))
    } else if folder.join(SWEEP).is_file() {
        let swept = read_json(&folder.join(SWEEP))?;
        ("sweep", vary::page_of(&swept, &folder.join(vary::RUNS))?)
    } else if folder.join(FLEET).is_file() {
        let found = read_json(&folder.join(FLEET))?;
        ("fleet", fleet::page_of(&found)?)
    } else if folder.join(DESIGN).is_file() {
        let document = read_json(&folder.join(DESIGN))?;
        let pictures =
            [FRONT, ROBUSTNESS].map(|name| std::fs::read_to_string(folder.join(name)).ok());
        let shown = pictures.each_ref().map(Option::as_deref);
        ("study", of_design(&document, shown))
    } else {
        return Err(AppError::NoResults {
            folder: folder.display().to_string(),
        });
    };
    if let Some(out) = &arguments.out {
        prepare_file(out, "--out", OverwritePolicy::of(arguments.force))?;
    }
    let default = || folder.join(REPORT);
    let out = arguments.out.clone().unwrap_or_else(default);
    write_text(&out, &text)?;
    if arguments.json {
        let message = serde_json::json!({"kind": kind, "file": out.display().to_string(), "bytes": text.len()});
        say(&format!("{message}\n"))?;
    } else if !arguments.quiet {
        let size = text.len() as f64 / 1e6;
        say(&format!(
            "page of the {kind} written to {} ({size:.1} MB)\n",
            out.display()
        ))?;
    }
    Ok(ExitCode::Done)
}

/// The page of a diagnosis.
pub(super) fn of_diagnosis(answer: &Answer, comparison: &Comparison) -> String {
    html(&diagnosis::page(answer, comparison))
}

/// The page of a design study: design.json, and front.svg and robustness.svg where there are such.
pub(super) fn of_design(document: &Value, [front, robustness]: [Option<&str>; 2]) -> String {
    let robustness = robustness::robustness(document, robustness);
    html(&design::page(document, front, robustness))
}

/// A run as its folder has it.
pub(super) fn read_run(folder: &Path) -> Result<RunResult<'static>, AppError> {
    let picture = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
    // A bench has none, nor has a run of an older version.
    let space = folder.join(DRAWING);
    let space = space.is_file().then(|| read_json(&space)).transpose()?;
    let profile = folder.join(EDGE_PROFILE);
    let profile = profile.is_file().then(|| EdgeProfile::read(&profile));
    let profile = profile.transpose()?;
    Ok(RunResult {
        document: read_json(&folder.join(SUMMARY))?,
        recording: Cow::Owned(read_parquet(&folder.join(SAMPLES))?.recording),
        cell: picture(CELL).map(Cow::Owned),
        edge: picture(EDGE).map(Cow::Owned),
        lean: picture(LEAN).map(Cow::Owned),
        space: space.map(Cow::Owned),
        profile: profile.map(Cow::Owned),
    })
}

pub(super) fn read_json<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, AppError> {
    let text = std::fs::read_to_string(path).map_err(|e| RecordingError::read(path, e))?;
    let read = serde_json::from_str(&text);
    Ok(read.map_err(|e| RecordingError::read(path, e))?)
}
