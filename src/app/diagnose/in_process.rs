//! A diagnosis for a caller in the same process: what it finds stays in memory, and files are written where a folder is asked for.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::super::error::AppError;
use super::super::files::OverwritePolicy;
use super::comparison_files::columns_of_recordings;
use super::one::Prepared;
use super::outputs::Finished;
use super::stages::Stages;
use crate::case::IMPROVED;
use crate::diagnosis::answer::Answer;
use crate::diagnosis::effort::EffortLimit;
use crate::diagnosis::search::progress::Progress;
use crate::document::html;
use crate::recording::long_column::LongColumn;
use crate::replay::LoadedCell;
use crate::report;
use crate::scenario::effects::law_of_line;

/// What is asked of a diagnosis.
#[derive(Debug, Clone, Default)]
pub struct CaseRequest {
    /// Folder with the recordings and what they are of.
    pub folder: PathBuf,
    /// Scenario of a recorded cell, of which the folder holds recordings alone.
    pub scenario: Option<PathBuf>,
    /// A law of one's own, tried beside the tool's.
    pub tried: Option<String>,
    /// Model evaluations after which the search stops.
    pub effort: Option<u64>,
    /// Time after which the search stops [s].
    pub limit: Option<f64>,
    /// Folder for the files, and whether new ones take the place of old ones.
    pub out: Option<(PathBuf, bool)>,
}

/// A case that was diagnosed.
pub struct DiagnosedCase {
    finished: Finished,
    improved: PathBuf,
}

impl CaseRequest {
    fn limit(&self) -> EffortLimit {
        match (self.effort, self.limit) {
            (Some(evaluations), _) => EffortLimit::Evaluations(evaluations),
            (None, Some(seconds)) => EffortLimit::Time(Duration::from_secs_f64(seconds)),
            (None, None) => EffortLimit::None,
        }
    }
}

/// Diagnoses a case as `idc diagnose` does. `progress` is given the words of the stage, and the share of the whole that lies behind [1] where that is known.
///
/// # Errors
/// What is wrong with the case, or a folder that cannot be written.
pub fn diagnose_case(
    request: &CaseRequest,
    progress: &mut dyn FnMut(&str, Option<f64>),
) -> Result<DiagnosedCase, AppError> {
    let cell = request
        .scenario
        .as_deref()
        .map(LoadedCell::load)
        .transpose()?;
    let tried = request.tried.as_deref().map(law_of_line).transpose();
    let tried = tried.map_err(|fault| AppError::Tried {
        reason: fault.to_string(),
    })?;
    let out = request
        .out
        .as_ref()
        .map(|(out, force)| (out.as_path(), OverwritePolicy::of(*force)));
    let prepared = Prepared::new(
        (&request.folder, &[]),
        (cell.as_ref(), tried, request.limit()),
        out,
    )?;
    let mut stages = Stages::default();
    let finished = prepared.run(&mut |now: &Progress<'_>| {
        let (words, behind) = stages.shown(now);
        progress(&words, behind);
    })?;
    let folder = out.map_or(request.folder.as_path(), |(out, _)| out);
    Ok(DiagnosedCase {
        finished,
        improved: folder.join(IMPROVED),
    })
}

impl DiagnosedCase {
    /// The finding.
    pub fn answer(&self) -> &Answer {
        &self.finished.answer
    }

    /// diagnosis.json.
    pub fn document(&self) -> &str {
        &self.finished.document
    }

    /// account.txt.
    pub fn account(&self) -> &str {
        &self.finished.account
    }

    /// The improved file: where it stands or, where nothing was written, could stand, and its text.
    pub fn improved(&self) -> (&Path, &str) {
        (&self.improved, &self.finished.improved)
    }

    /// Recordings beside models, as comparison.parquet has them.
    pub fn comparison(&self) -> Vec<(String, LongColumn)> {
        columns_of_recordings(&self.finished.comparison)
    }

    /// Its page, with all charts.
    pub fn page(&self) -> String {
        html(&report::diagnosis(
            &self.finished.answer,
            &self.finished.comparison,
        ))
    }
}
