//! report.html: what a folder of results holds, as one file for a browser; or the same as Markdown on standard output.

use std::path::{Path, PathBuf};

use clap::Args;

use super::diagnose::read_comparison;
use super::error::{AppError, ExitCode};
use super::files::{
    BALANCE, CELL, COMPARISON, DESIGN, DIAGNOSIS, DRAWING, EDGE, EDGE_PROFILE, FRONT, LEAN,
    OverwritePolicy, REPORT, ROBUSTNESS, SAMPLES, is_same, prepare_file,
};
use super::fleet::{self, FLEET};
use super::output::say;
use super::terminal::shown_path;
use super::vary::{self, SWEEP};
use crate::design::StudyDocument;
use crate::diagnosis::answer::Answer;
use crate::document::{Document, html, markdown};
use crate::recording::atomic::write_text;
use crate::recording::csv::EdgeProfile;
use crate::recording::parquet::read_parquet;
use crate::recording::{Recording, RecordingError};
use crate::report::{self, RunReport, SUMMARY, Sketches};

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
  idc report runs/step --out runs/step_for_you.html
  # conclusion and tables as Markdown, as for the summary of a CI job
  idc report runs/step --markdown";

/// Length of a picture that a page takes in at most [byte]; ours have a twentieth of it.
const LARGEST_PICTURE: u64 = 4_000_000;

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
    /// Print conclusion and tables as Markdown instead; no file is written.
    #[arg(long, conflicts_with_all = ["out", "force", "quiet", "json"])]
    markdown: bool,
}

/// How a document is written.
type Renderer = fn(&Document<'_>) -> String;

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
    if arguments.markdown {
        let (_, text) = rendered(folder, markdown)?;
        say(&text)?;
        return Ok(ExitCode::Done);
    }
    let (kind, text) = rendered(folder, html)?;
    let default = || folder.join(REPORT);
    let out = arguments.out.clone().unwrap_or_else(default);
    let policy = match &arguments.out {
        Some(_) => OverwritePolicy::of(arguments.force),
        // The page of the results themselves, made anew.
        None => OverwritePolicy::Replace,
    };
    let _claim = prepare_file(&out, "--out", policy)?;
    write_text(&out, &text)?;
    if arguments.json {
        let message = serde_json::json!({"kind": kind, "file": out.display().to_string(), "bytes": text.len()});
        say(&format!("{message}\n"))?;
    } else if !arguments.quiet {
        let size = text.len() as f64 / 1e6;
        say(&format!(
            "page of the {kind} written to {} ({size:.1} MB)\n",
            shown_path(&out)
        ))?;
    }
    Ok(ExitCode::Done)
}

/// What kind of result a folder holds, and its document as text.
fn rendered(folder: &Path, render: Renderer) -> Result<(&'static str, String), AppError> {
    let found = if folder.join(DIAGNOSIS).is_file() {
        let answer: Answer = read_json(&folder.join(DIAGNOSIS))?;
        (
            "diagnosis",
            render(&report::diagnosis(&answer, &read_comparison(folder)?)),
        )
    } else if folder.join(SUMMARY).is_file() {
        ("run", run_page(folder, render)?)
    } else if folder.join(SWEEP).is_file() {
        let swept = read_json(&folder.join(SWEEP))?;
        (
            "sweep",
            render(&vary::document(&swept, &|wanted| {
                vary::columns(&folder.join(vary::RUNS), wanted)
            })?),
        )
    } else if folder.join(FLEET).is_file() {
        let found = read_json(&folder.join(FLEET))?;
        ("fleet", render(&fleet::document(&found)))
    } else if folder.join(DESIGN).is_file() {
        let study: StudyDocument = read_json(&folder.join(DESIGN))?;
        ("study", render(&report::study(&study)))
    } else {
        return Err(AppError::NoResults {
            folder: folder.display().to_string(),
        });
    };
    Ok(found)
}

/// The page of a run, from its folder.
fn run_page(folder: &Path, render: Renderer) -> Result<String, AppError> {
    let picture = |name: &str| picture(&folder.join(name));
    // A bench has none, nor has a run of an older version.
    let space = folder.join(DRAWING);
    let profile = folder.join(EDGE_PROFILE);
    let profile = profile.is_file().then(|| EdgeProfile::read(&profile));
    let profile = profile.transpose()?;
    let report = RunReport {
        result: &read_json(&folder.join(SUMMARY))?,
        recording: &read_samples(folder)?,
        sketches: &Sketches {
            cell: picture(CELL)?,
            edge: picture(EDGE)?,
            lean: picture(LEAN)?,
            space: space.is_file().then(|| read_json(&space)).transpose()?,
        },
        profile: profile.as_ref(),
    };
    Ok(render(&report.document()))
}

/// A picture, if it is there.
fn picture(path: &Path) -> Result<Option<String>, RecordingError> {
    let Some(data) = path.metadata().ok().filter(std::fs::Metadata::is_file) else {
        return Ok(None);
    };
    if data.len() > LARGEST_PICTURE {
        let reason = format!(
            "it has {} bytes, expected a picture of at most {LARGEST_PICTURE}, as idc run writes it; without the file the page has no picture",
            data.len()
        );
        return Err(RecordingError::read(path, reason));
    }
    let text = crate::file::read_text(path);
    Ok(Some(text.map_err(|e| RecordingError::read(path, e))?))
}

/// Signals of a run, from its folder.
pub(super) fn read_samples(folder: &Path) -> Result<Recording, AppError> {
    Ok(read_parquet(&folder.join(SAMPLES))?.recording)
}

pub(super) fn read_json<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, AppError> {
    let text = crate::file::read_text(path).map_err(|e| RecordingError::read(path, e))?;
    let read = serde_json::from_str(&text);
    Ok(read.map_err(|e| RecordingError::read(path, e))?)
}
