//! The files of a run: recording.rrd, samples.parquet, summary.json; all three appear, or none.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::error::AppError;
use super::picture::scene_of;
use super::run::Finished;
use crate::cell::Cell;
use crate::metrics::{Summary, Verdict};
use crate::recording::atomic::{UnfinishedFolder, write_text};
use crate::recording::parquet::write_parquet;
use crate::recording::rerun::{Opening, RerunOptions, write_rrd};
use crate::report::markdown;

const RECORDING: &str = "recording.rrd";
const SAMPLES: &str = "samples.parquet";
const SUMMARY: &str = "summary.json";
/// All of them.
pub(super) const NAMES: [&str; 3] = [RECORDING, SAMPLES, SUMMARY];

/// A folder that was found to be writable before the run.
pub(super) struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// Makes the folder and tries it, so that a long run does not end with nothing.
    pub(super) fn prepare(path: &Path) -> Result<Self, AppError> {
        let refuse = |reason: String| AppError::OutputFolder {
            folder: path.display().to_string(),
            reason,
        };
        if path.exists() && !path.is_dir() {
            return Err(refuse("there is a file of that name".to_owned()));
        }
        std::fs::create_dir_all(path).map_err(|error| refuse(error.to_string()))?;
        if let Some(name) = NAMES.iter().find(|name| path.join(name).is_dir()) {
            return Err(refuse(format!("{name} in it is a folder")));
        }
        drop(UnfinishedFolder::within(path)?);
        Ok(Self {
            path: path.to_owned(),
        })
    }

    /// Its path.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the three files.
    pub(super) fn write(
        &self,
        cell: &Cell,
        finished: &Finished,
        document: &SummaryDocument,
        opening: Opening,
    ) -> Result<(), AppError> {
        let unfinished = UnfinishedFolder::within(&self.path)?;
        let title = &cell.scenario.title;
        let metadata = BTreeMap::from([
            ("title".to_owned(), title.clone()),
            (
                "program".to_owned(),
                format!("idc {}", env!("CARGO_PKG_VERSION")),
            ),
        ]);
        write_parquet(
            &unfinished.path().join(SAMPLES),
            &finished.recording,
            &metadata,
        )?;
        let options = RerunOptions {
            summary_markdown: markdown(title, &finished.summary, document.expectations),
            opening,
            ..RerunOptions::default()
        };
        let scene = scene_of(cell, &finished.recording, &finished.frames)?;
        write_rrd(
            &unfinished.path().join(RECORDING),
            &finished.recording,
            &scene,
            &options,
        )?;
        write_text(&unfinished.path().join(SUMMARY), &document.text()?)?;
        unfinished.finish(&NAMES)?;
        Ok(())
    }
}

/// What summary.json holds, and `--json` prints.
#[derive(serde::Serialize)]
pub(super) struct SummaryDocument<'a> {
    schema: u32,
    scenario: String,
    title: &'a str,
    /// What stopped the run early; null if it ran to its end.
    stopped: Option<String>,
    summary: &'a Summary,
    expectations: &'a [Verdict],
    joint_names: Vec<&'a str>,
    samples: usize,
    notes: &'a [String],
}

impl<'a> SummaryDocument<'a> {
    /// The document of a run.
    pub(super) fn new(cell: &'a Cell, finished: &'a Finished, expectations: &'a [Verdict]) -> Self {
        Self {
            schema: 1,
            scenario: cell.scenario.path.display().to_string(),
            title: &cell.scenario.title,
            stopped: finished.stop.as_ref().map(ToString::to_string),
            summary: &finished.summary,
            expectations,
            joint_names: cell
                .arm
                .chain
                .joints
                .iter()
                .map(|joint| joint.name.as_str())
                .collect(),
            samples: finished.recording.sample_count(),
            notes: &cell.notes,
        }
    }

    /// As JSON.
    pub(super) fn text(&self) -> Result<String, AppError> {
        Ok(serde_json::to_string_pretty(self)?)
    }
}
