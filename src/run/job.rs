//! A scenario that can be run, of a cell or of a bench.

use std::path::Path;

use super::bench::{FinishedBench, run_bench};
use super::cell::{FinishedCell, run_cell};
use super::error::RunError;
use crate::cell::Cell;
use crate::metrics::{
    BENCH_METRICS, BoundCheck, METRICS, Metric, check, check_cell, validate, validate_cell,
};
use crate::recording::Recording;
use crate::rig::Rig;
use crate::scenario::{AnyScenario, load_any};

/// A scenario that can be run.
pub enum Job {
    /// Of a cell.
    Cell(Box<Cell>),
    /// Of a bench.
    Bench(Box<Rig>),
}

/// What a run gave.
pub struct Outcome {
    /// The recording, until the run ended or was stopped.
    pub recording: Recording,
    /// Metrics by their name in summary.json, unit included, in the order of their list; none where the run does not determine one.
    pub metrics: Vec<(&'static str, Option<f64>)>,
    /// Bounds that the scenario sets on them.
    pub bounds: Vec<BoundCheck>,
    /// Reason for an early stop.
    pub stop: Option<String>,
}

/// A run that has ended, with all that its page is made of.
pub enum Finished {
    /// Of a cell.
    Cell(Box<FinishedCell>),
    /// Of a bench.
    Bench(Box<FinishedBench>),
}

impl Finished {
    /// Its recording, until it ended or was stopped.
    #[must_use]
    pub fn recording(&self) -> &Recording {
        match self {
            Self::Cell(run) => &run.recording,
            Self::Bench(run) => &run.recording,
        }
    }

    /// Metrics by their name in summary.json, unit included, in the order of their list; none where the run does not determine one.
    #[must_use]
    pub fn metrics(&self) -> Vec<(&'static str, Option<f64>)> {
        match self {
            Self::Cell(run) => values(METRICS, &run.summary),
            Self::Bench(run) => values(BENCH_METRICS, &run.summary),
        }
    }

    /// Reason for an early stop.
    #[must_use]
    pub fn stop(&self) -> Option<String> {
        match self {
            Self::Cell(run) => run.stop.as_ref().map(ToString::to_string),
            Self::Bench(run) => run.stop.as_ref().map(ToString::to_string),
        }
    }
}

impl Job {
    /// Reads a scenario file and checks it to its end.
    ///
    /// # Errors
    /// Those of the file, and of [`Job::new`].
    pub fn load(path: &Path) -> Result<Self, RunError> {
        Self::new(load_any(path)?)
    }

    /// Checks a scenario to its end: bounds, path, supply, stability.
    ///
    /// # Errors
    /// An unknown metric, or a job that cannot be done.
    pub fn new(scenario: AnyScenario) -> Result<Self, RunError> {
        Ok(match scenario {
            AnyScenario::Cell(cell) => {
                let known = validate_cell(&cell.expect, &cell.expect_of_passes());
                known.map_err(RunError::metrics(&cell.path))?;
                Self::Cell(Box::new(Cell::new(*cell)?))
            }
            AnyScenario::Bench(bench) => {
                let known = validate(BENCH_METRICS, &bench.expect);
                known.map_err(RunError::metrics(&bench.path))?;
                Self::Bench(Box::new(Rig::new(*bench)?))
            }
        })
    }

    /// Notes before it begins.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        match self {
            Self::Cell(cell) => &cell.setup.notes,
            Self::Bench(_) => &[],
        }
    }

    /// Simulates and measures it. `progress` is given steps done and in all.
    ///
    /// # Errors
    /// Nothing could be recorded or measured.
    pub fn finish(&self, progress: &mut dyn FnMut(usize, usize)) -> Result<Finished, RunError> {
        Ok(match self {
            Self::Cell(cell) => {
                let run = run_cell(cell, &mut |s| progress(s.steps(), s.total_steps()))?;
                Finished::Cell(Box::new(run))
            }
            Self::Bench(rig) => {
                let run = run_bench(rig, &mut |s| progress(s.steps(), s.total_steps()))?;
                Finished::Bench(Box::new(run))
            }
        })
    }

    /// Bounds that the scenario sets on the numbers of a run of it.
    ///
    /// # Errors
    /// An unknown metric.
    pub fn bounds(&self, finished: &Finished) -> Result<Vec<BoundCheck>, RunError> {
        match (self, finished) {
            (Self::Cell(cell), Finished::Cell(run)) => run.bounds(cell),
            (Self::Bench(rig), Finished::Bench(run)) => run.bounds(rig),
            // Of another job: none are of it.
            _ => Ok(Vec::new()),
        }
    }

    /// As `finish`: what is asked for most.
    ///
    /// # Errors
    /// Nothing could be recorded or measured.
    pub fn run(&self, progress: &mut dyn FnMut(usize, usize)) -> Result<Outcome, RunError> {
        let finished = self.finish(progress)?;
        Ok(Outcome {
            bounds: self.bounds(&finished)?,
            metrics: finished.metrics(),
            stop: finished.stop(),
            recording: match finished {
                Finished::Cell(run) => run.recording,
                Finished::Bench(run) => run.recording,
            },
        })
    }
}

impl FinishedCell {
    /// Bounds that the cell's scenario sets on its numbers.
    ///
    /// # Errors
    /// An unknown metric.
    pub fn bounds(&self, cell: &Cell) -> Result<Vec<BoundCheck>, RunError> {
        let scenario = &cell.setup.scenario;
        check_cell(
            &self.summary,
            &scenario.expect,
            &scenario.expect_of_passes(),
        )
        .map_err(RunError::metrics(&scenario.path))
    }
}

impl FinishedBench {
    /// Bounds that the bench's scenario sets on its numbers.
    ///
    /// # Errors
    /// An unknown metric.
    pub fn bounds(&self, rig: &Rig) -> Result<Vec<BoundCheck>, RunError> {
        check(BENCH_METRICS, &self.summary, &rig.scenario.expect)
            .map_err(RunError::metrics(&rig.scenario.path))
    }
}

/// Metrics of a summary.
fn values<S>(metrics: &[Metric<S>], summary: &S) -> Vec<(&'static str, Option<f64>)> {
    let of = |metric: &Metric<S>| {
        let value = (metric.value)(summary).filter(|value| value.is_finite());
        (metric.name, value)
    };
    metrics.iter().map(of).collect()
}
