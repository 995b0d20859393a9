//! Scenarios, read once.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::prelude::*;

use super::error::{plain, raised};
use crate::app;
use crate::app::{AppError, EditedScenario};
use crate::scenario::{KeyValue, ScenarioTemplate};

/// A scenario.
#[pyclass(module = "idc._idc", frozen)]
pub(super) struct Scenario(pub(super) Arc<ScenarioTemplate>);

/// A value as it is set.
#[derive(FromPyObject)]
pub(super) enum SetValue {
    Switch(bool),
    Whole(i64),
    Number(f64),
    Text(String),
}

/// A key, its value, and whether a text is one as a file has it.
pub(super) type SetKey = (String, SetValue, bool);

/// Keys with other values.
pub(super) fn edits(set: Vec<SetKey>) -> Vec<KeyValue> {
    let edit = |(key, value, is_literal): SetKey| match value {
        SetValue::Switch(on) => KeyValue::typed(key, if on { "true" } else { "false" }),
        SetValue::Whole(whole) => KeyValue::typed(key, &whole.to_string()),
        SetValue::Number(number) => KeyValue::number(key, number),
        SetValue::Text(text) if is_literal => KeyValue::typed(key, &text),
        SetValue::Text(text) => KeyValue::text(key, &text),
    };
    set.into_iter().map(edit).collect()
}

/// A scenario with effects and values; messages name them as Python's arguments, not as flags.
pub(super) fn edited(
    scenario: &Scenario,
    set: Vec<SetKey>,
    effects: &[String],
) -> Result<EditedScenario, AppError> {
    EditedScenario::new(Arc::clone(&scenario.0), effects, edits(set))
}

#[pymethods]
impl Scenario {
    /// Its file.
    #[getter]
    fn path(&self) -> PathBuf {
        self.0.path().to_owned()
    }

    /// Its name for people.
    #[getter]
    fn title(&self) -> String {
        self.0.title().to_owned()
    }

    /// Whether it is of a bench.
    #[getter]
    fn is_bench(&self) -> bool {
        self.0.is_bench()
    }

    /// Its text, as a file has it.
    #[getter]
    fn text(&self) -> PyResult<String> {
        self.0.text(&[]).map_err(|error| raised(&error.into()))
    }
}

/// Reads a scenario file.
#[pyfunction]
pub(super) fn load(py: Python<'_>, path: PathBuf) -> PyResult<Scenario> {
    let read = py.detach(|| ScenarioTemplate::read(&path));
    read.map(|template| Scenario(Arc::new(template)))
        .map_err(|error| raised(&error.into()))
}

/// A scenario of its tables and keys; its paths lead from a folder.
#[pyfunction]
pub(super) fn of_json(text: &str, folder: PathBuf) -> PyResult<Scenario> {
    let tables = serde_json::from_str(text).map_err(|error| plain(error.to_string()))?;
    let path = folder.join("<dict>");
    let made = ScenarioTemplate::of_json(&path, &tables);
    made.map(|template| Scenario(Arc::new(template)))
        .map_err(|error| raised(&error.into()))
}

/// What a file describes, as JSON.
#[pyfunction]
pub(super) fn check_file(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    py.detach(|| app::check_file(Path::new(&path)))
        .map_err(|error| raised(&error))
}

/// What a scenario describes, as JSON.
#[pyfunction]
pub(super) fn check_scenario(py: Python<'_>, scenario: &Scenario) -> PyResult<String> {
    py.detach(|| app::check_scenario(&scenario.0))
        .map_err(|error| raised(&error))
}
