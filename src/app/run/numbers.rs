//! A run of which only the numbers are wanted: nothing is written.

use serde::{Deserialize, Serialize};

use super::super::bench::run_rig;
use super::super::error::{AppError, ExitCode};
use super::cell_run::run_cell;
use super::job::{Job, judged};
use crate::metrics::{self, BENCH_METRICS, BoundCheck, METRICS, Metric, MetricsError};
use crate::scenario::AnyScenario;

/// The numbers of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in super::super) struct Numbers {
    /// Its exit code, as that of `idc run`.
    pub code: u8,
    /// What stopped it, was refused, or lies outside its bounds; empty where all is well.
    pub reason: String,
    /// Its metrics in the order of their list, none where it does not determine one; empty where it was refused.
    pub metrics: Vec<Option<f64>>,
}

/// Whether a scenario can be run, as far as is known before it is.
pub(in super::super) fn can_run(scenario: AnyScenario) -> Result<(), AppError> {
    Job::new(scenario).map(drop)
}

/// Names and units of the metrics of a kind of scenario.
pub(in super::super) fn metric_names(is_bench: bool) -> Vec<&'static str> {
    match is_bench {
        true => BENCH_METRICS.iter().map(|metric| metric.name).collect(),
        false => METRICS.iter().map(|metric| metric.name).collect(),
    }
}

/// Runs a scenario; what refuses it is a result as well.
pub(in super::super) fn numbers(scenario: AnyScenario) -> Numbers {
    let refused = |error: AppError| Numbers {
        code: ExitCode::BadInput as u8,
        reason: error.to_string(),
        metrics: Vec::new(),
    };
    Job::new(scenario)
        .and_then(measured)
        .unwrap_or_else(refused)
}

fn measured(job: Job) -> Result<Numbers, AppError> {
    match job {
        Job::Cell(cell) => {
            let mut run = run_cell(&cell, &mut |_, _| ())?;
            // How long it took says nothing about the scenario.
            run.summary.timing = None;
            let scenario = &cell.scenario;
            let verdicts =
                metrics::check_cell(&run.summary, &scenario.expect, &scenario.expect_of_passes());
            let file = scenario.path.display().to_string();
            of(METRICS, &run.summary, run.stop.as_ref(), verdicts, file)
        }
        Job::Bench(rig) => {
            let mut run = run_rig(&rig, &mut |_, _| ())?;
            run.summary.timing = None;
            let scenario = &rig.scenario;
            let verdicts = metrics::check(BENCH_METRICS, &run.summary, &scenario.expect);
            let file = scenario.path.display().to_string();
            of(
                BENCH_METRICS,
                &run.summary,
                run.stop.as_ref(),
                verdicts,
                file,
            )
        }
    }
}

fn of<S>(
    metrics: &[Metric<S>],
    summary: &S,
    stop: Option<&impl std::fmt::Display>,
    verdicts: Result<Vec<BoundCheck>, MetricsError>,
    file: String,
) -> Result<Numbers, AppError> {
    let verdicts = verdicts.map_err(|source| AppError::Metrics { file, source })?;
    let (code, told) = judged(stop, &verdicts);
    let values = metrics.iter().map(|metric| (metric.value)(summary));
    Ok(Numbers {
        code: code as u8,
        reason: told.join("; "),
        metrics: values
            .map(|value| value.filter(|v| v.is_finite()))
            .collect(),
    })
}
