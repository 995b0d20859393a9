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
    pub fn run(&self, progress: &mut dyn FnMut(usize, usize)) -> Result<Outcome, RunError> {
        Ok(match self {
            Self::Cell(cell) => {
                let run = run_cell(cell, &mut |s| progress(s.steps(), s.total_steps()))?;
                Outcome {
                    bounds: run.bounds(cell)?,
                    metrics: values(METRICS, &run.summary),
                    recording: run.recording,
                    stop: run.stop.map(|stop| stop.to_string()),
                }
            }
            Self::Bench(rig) => {
                let run = run_bench(rig, &mut |s| progress(s.steps(), s.total_steps()))?;
                Outcome {
                    bounds: run.bounds(rig)?,
                    metrics: values(BENCH_METRICS, &run.summary),
                    recording: run.recording,
                    stop: run.stop.map(|stop| stop.to_string()),
                }
            }
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
