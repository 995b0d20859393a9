//! A run for a caller in the same process: what it gives stays in memory, and files are written where a folder is asked for.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::error::{AppError, ExitCode};
use super::super::files::{OutputFolder, OverwritePolicy, RUN_NAMES};
use super::job::{Parts, RunOptions, code};
use super::settings::{blamed, with_flags};
use super::source::Source;
use crate::document::{Style, html};
use crate::recording::Recording;
use crate::run::{Finished, Job, RunError, RunResult, apply_effects};
use crate::scenario::{EffectRequest, KeyValue, ScenarioTemplate};
use crate::viewer::Opening;

/// A scenario with other values for some of its keys.
#[derive(Debug, Clone)]
pub struct EditedScenario {
    template: Arc<ScenarioTemplate>,
    edits: Vec<KeyValue>,
}

/// Where the files of a run go.
#[derive(Debug, Clone)]
pub struct RunFolder {
    /// The folder.
    pub path: PathBuf,
    /// Whether new results take the place of old ones.
    pub force: bool,
    /// Whether recording.rrd is written.
    pub recorded: bool,
    /// Whether recording.mcap is written.
    pub with_bag: bool,
}

/// A run that has ended.
pub struct FinishedRun {
    scenario: EditedScenario,
    job: Job,
    finished: Finished,
}

/// Edits of a scenario that put in effects of the catalogue, each as `--with` takes it.
///
/// # Errors
/// An effect that cannot be put in as it is asked for.
pub(in crate::app) fn edits_of(
    effects: &[String],
    template: &ScenarioTemplate,
) -> Result<Vec<KeyValue>, AppError> {
    let requests = effects.iter().map(|text| EffectRequest::parse(text));
    let requests = requests.collect::<Result<Vec<_>, _>>();
    let requests = requests.map_err(|reason| RunError::With { reason })?;
    Ok(apply_effects(&requests, template)?)
}

impl EditedScenario {
    /// A scenario with effects of the catalogue, each as `--with` takes it, and other values.
    ///
    /// # Errors
    /// An effect that cannot be put in as it is asked for.
    pub fn new(
        template: Arc<ScenarioTemplate>,
        effects: &[String],
        set: Vec<KeyValue>,
    ) -> Result<Self, AppError> {
        let mut edits = edits_of(effects, &template)?;
        edits.extend(set);
        Ok(Self { template, edits })
    }

    /// The job that it describes, checked to its end.
    ///
    /// # Errors
    /// Those of a value by its key, and a job that cannot be done.
    pub fn job(&self) -> Result<Job, AppError> {
        let named = |error: AppError| match self.edits.is_empty() {
            true => error,
            false => with_flags(error, &self.edits),
        };
        let refused = |error| match self.edits.is_empty() {
            true => AppError::from(error),
            false => blamed(error, &self.edits, &self.template),
        };
        let scenario = self.template.with(&self.edits).map_err(refused)?;
        Job::new(scenario).map_err(|error| named(error.into()))
    }

    /// Runs it; `progress` is given steps done and in all.
    ///
    /// # Errors
    /// As of `job`; nothing could be recorded or measured, or a folder that cannot be written.
    pub fn run(
        self,
        folder: Option<&RunFolder>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<FinishedRun, AppError> {
        let job = self.job()?;
        let finished = match folder {
            None => job.finish(progress)?,
            Some(folder) => self.write(&job, folder, progress)?,
        };
        Ok(FinishedRun {
            scenario: self,
            job,
            finished,
        })
    }

    /// As `idc run` does it.
    fn write(
        &self,
        job: &Job,
        wanted: &RunFolder,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Finished, AppError> {
        let policy = OverwritePolicy::of(wanted.force);
        let folder = OutputFolder::prepare(&wanted.path, &RUN_NAMES, policy)?;
        let source = match self.edits.is_empty() && !self.template.is_text() {
            true => Source::file(self.template.path()),
            false => Source::varied(&self.template, &self.edits, None, folder.path())?,
        };
        let options = RunOptions {
            recorded: wanted.recorded,
            with_bag: wanted.with_bag,
            opening: Opening::Following,
            style: Style::Plain,
        };
        let outcome = job.perform(&source, &folder, options, None, progress)?;
        Ok(outcome.finished)
    }
}

impl FinishedRun {
    /// A run that was done step by step.
    pub fn of_steps(scenario: EditedScenario, job: Job, finished: Finished) -> Self {
        Self {
            scenario,
            job,
            finished,
        }
    }

    /// Its recording.
    pub fn recording(&self) -> &Recording {
        self.finished.recording()
    }

    /// Metrics by their name in summary.json, in the order of their list.
    pub fn metrics(&self) -> Vec<(&'static str, Option<f64>)> {
        self.finished.metrics()
    }

    /// Its numbers, as summary.json has them.
    ///
    /// # Errors
    /// A file that is no longer there.
    pub fn result(&self) -> Result<RunResult, AppError> {
        Ok(self.parts()?.result)
    }

    /// Its page, with all charts.
    ///
    /// # Errors
    /// As of `result`.
    pub fn page(&self) -> Result<String, AppError> {
        let parts = self.parts()?;
        let profile = match &self.finished {
            Finished::Cell(run) => run.edge.as_ref(),
            Finished::Bench(_) => None,
        };
        Ok(html(&parts.report(self.recording(), profile).document()))
    }

    /// Exit code that `idc run` would have.
    ///
    /// # Errors
    /// As of `result`.
    pub fn code(&self) -> Result<ExitCode, AppError> {
        Ok(code(&self.result()?))
    }

    /// Reason for an early stop.
    pub fn stop(&self) -> Option<String> {
        self.finished.stop()
    }

    /// Results that lie outside the bounds of the scenario, a sentence each.
    ///
    /// # Errors
    /// An unknown metric.
    pub fn outside(&self) -> Result<Vec<String>, AppError> {
        Ok(crate::run::outside(&self.job.bounds(&self.finished)?))
    }

    /// File of its scenario.
    pub fn path(&self) -> &Path {
        self.scenario.template.path()
    }

    fn parts(&self) -> Result<Parts, AppError> {
        let EditedScenario { template, edits } = &self.scenario;
        let source = Source::in_memory(template, edits)?;
        let (origin, _) = self.job.provenance(&source)?;
        let origin = source.origin(origin);
        match (&self.job, &self.finished) {
            (Job::Cell(cell), Finished::Cell(run)) => Parts::of_cell(cell, run, origin),
            (Job::Bench(rig), Finished::Bench(run)) => Parts::of_bench(rig, run, origin),
            _ => unreachable!("a run is of its job"),
        }
    }
}
