//! Diagnoses, predictions, and results side by side.

use std::path::PathBuf;

use pyo3::prelude::*;

use super::call::detached;
use super::error::raised;
use super::run::Run;
use super::table::Table;
use crate::app::{
    AppError, CaseRequest, Compared, DiagnosedCase, compared, diagnose_case, predict_table_of,
};

/// Parts of a diagnosis's progress: the share of the whole that lies behind is a guess.
const PARTS: usize = 100;

/// A diagnosis.
#[pyclass(module = "idc._idc", frozen)]
pub(super) struct Diagnosis(DiagnosedCase);

#[pymethods]
impl Diagnosis {
    /// File and text of the improved model.
    #[getter]
    fn improved(&self) -> (PathBuf, String) {
        let (path, text) = self.0.improved();
        (path.to_owned(), text.to_owned())
    }

    /// diagnosis.json.
    fn document(&self) -> String {
        self.0.document().to_owned()
    }

    /// account.txt.
    fn account(&self) -> String {
        self.0.account().to_owned()
    }

    /// Recordings beside models.
    fn comparison(&self) -> PyResult<Table> {
        Table::of_columns(&self.0.comparison())
    }

    /// Its page.
    fn page(&self, py: Python<'_>) -> String {
        py.detach(|| self.0.page())
    }
}

/// Diagnoses a case.
#[pyfunction]
pub(super) fn diagnose(
    py: Python<'_>,
    case: PathBuf,
    scenario: Option<PathBuf>,
    tried: Option<String>,
    limits: (Option<u64>, Option<f64>),
    out: Option<(PathBuf, bool)>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Diagnosis> {
    let (effort, limit) = limits;
    let request = CaseRequest {
        folder: case,
        scenario,
        tried,
        effort,
        limit,
        out,
    };
    detached(py, progress, |reporter| {
        let mut behind = 0;
        let diagnosed = diagnose_case(&request, &mut |_, share| {
            let own = share.map_or(0, |share| (share * PARTS as f64) as usize);
            behind = behind.max(own.min(PARTS - 1));
            reporter.report(behind, PARTS);
        })?;
        reporter.report(PARTS, PARTS);
        Ok(diagnosed)
    })
    .map(Diagnosis)
}

/// What a model predicts for a recording's inputs: the table, and how far off it is as JSON.
#[pyfunction]
pub(super) fn predict(
    py: Python<'_>,
    model: PathBuf,
    text: Option<String>,
    inputs: PathBuf,
) -> PyResult<(Table, String)> {
    let predicted = detached(py, None, |_| {
        predict_table_of(&model, text.as_deref(), &inputs)
    })?;
    let table = Table::of_columns(&predicted.columns)?;
    Ok((table, predicted.document.to_string()))
}

/// Results that are compared.
#[derive(FromPyObject)]
pub(super) enum Results<'py> {
    Runs(Vec<(String, PyRef<'py, Run>)>),
    Diagnoses(Vec<(String, PyRef<'py, Diagnosis>)>),
    Folders(Vec<PathBuf>),
}

/// Results side by side: as JSON, and as a page.
#[pyfunction]
pub(super) fn compare(results: Results<'_>) -> PyResult<(String, String)> {
    let of = match &results {
        Results::Runs(runs) => {
            let runs = runs.iter().map(|(name, run)| (name.clone(), &run.0));
            Compared::Runs(runs.collect())
        }
        Results::Diagnoses(all) => {
            let all = all.iter().map(|(name, one)| (name.clone(), &one.0));
            Compared::Diagnoses(all.collect())
        }
        Results::Folders(folders) => Compared::Folders(folders),
    };
    let (document, page) = compared(&of).map_err(|error: AppError| raised(&error))?;
    Ok((document.to_string(), page))
}
