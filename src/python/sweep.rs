//! Sweeps.

use std::path::PathBuf;

use pyo3::prelude::*;

use super::call::detached;
use super::error::raised;
use super::scenario::Scenario;
use super::table::Table;
use crate::app::{AppError, SweepOfRuns, SweepRequest, between, vary_scenario};
use crate::vary::{Values, Variable};

/// A sweep that was run.
#[pyclass(module = "idc._idc", frozen)]
pub(super) struct Sweep(SweepOfRuns);

#[pymethods]
impl Sweep {
    /// A row for each run.
    fn table(&self) -> PyResult<Table> {
        Table::of_columns(self.0.columns())
    }

    /// vary.json.
    fn document(&self) -> PyResult<String> {
        let text = serde_json::to_string(self.0.swept());
        text.map_err(|error| raised(&error.into()))
    }

    /// Its page.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| self.0.page()).map_err(|error| raised(&error))
    }
}

/// The values that a key may have: those of a list as they are typed, or the ends of a range.
#[derive(FromPyObject)]
pub(super) enum GivenValues {
    Listed(Vec<String>),
    Whole(i64, i64),
    Range(f64, f64),
}

/// Runs a scenario with many other values.
#[pyfunction]
pub(super) fn vary(
    py: Python<'_>,
    scenario: &Scenario,
    variables: Vec<(String, GivenValues)>,
    effects: Vec<String>,
    points: (String, u64, Option<usize>),
    out: Option<(PathBuf, bool)>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Sweep> {
    let (sampling, seed, jobs) = points;
    let variable = |(key, values): (String, GivenValues)| Variable {
        values: match values {
            GivenValues::Listed(texts) => Values::Listed(texts),
            GivenValues::Range(low, high) => between(low, high),
            // Of a count the ends alone need be checked.
            GivenValues::Whole(low, high) if scenario.0.is_count(&key, low, &[]) => {
                Values::Whole([low, high])
            }
            GivenValues::Whole(low, high) => {
                Values::Listed((low..=high).map(|value| value.to_string()).collect())
            }
        },
        key,
    };
    let variables = variables.into_iter().map(variable).collect();
    detached(py, progress, |reporter| {
        let request = SweepRequest {
            variables,
            effects,
            sampling: sampling.parse().map_err(AppError::from)?,
            seed,
            jobs,
            out,
        };
        vary_scenario(&scenario.0, &request, &mut |done, total| {
            reporter.report(done, total);
        })
    })
    .map(Sweep)
}
