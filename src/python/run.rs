//! Runs.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::call::detached;
use super::error::raised;
use super::scenario::{Scenario, SetKey, edited};
use super::table::Table;
use crate::app::{AppError, FinishedRun, RunFolder};

/// A run that has ended.
#[pyclass(module = "idc._idc", frozen)]
pub(super) struct Run(pub(super) FinishedRun);

#[pymethods]
impl Run {
    /// Its numbers by name.
    #[getter]
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let metrics = PyDict::new(py);
        for (name, value) in self.0.metrics() {
            metrics.set_item(name, value)?;
        }
        Ok(metrics)
    }

    /// Its recording.
    fn samples(&self) -> PyResult<Table> {
        Table::of_recording(self.0.recording())
    }

    /// Reason for an early stop.
    #[getter]
    fn stopped(&self) -> Option<String> {
        self.0.stop()
    }

    /// Results outside their bounds.
    #[getter]
    fn outside(&self) -> PyResult<Vec<String>> {
        self.0.outside().map_err(|error| raised(&error))
    }

    /// summary.json.
    fn summary(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, None, |_| {
            serde_json::to_string(&self.0.result()?).map_err(AppError::from)
        })
    }

    /// Its page.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, None, |_| self.0.page())
    }
}

/// Runs a scenario. Of a folder: whether new files take the place of old ones, and whether recording.rrd and recording.mcap are among them.
#[pyfunction]
pub(super) fn run(
    py: Python<'_>,
    scenario: &Scenario,
    set: Vec<SetKey>,
    effects: Vec<String>,
    out: Option<(PathBuf, bool, bool, bool)>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Run> {
    let folder = out.map(|(path, force, recorded, with_bag)| RunFolder {
        path,
        force,
        recorded,
        with_bag,
    });
    let work = |reporter: &mut super::call::Reporter| {
        let scenario = edited(scenario, set, &effects)?;
        scenario.run(folder.as_ref(), &mut |done, total| {
            reporter.report(done, total);
        })
    };
    detached(py, progress, work).map(Run)
}
