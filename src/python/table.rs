//! Tables, handed over without a copy: <https://arrow.apache.org/docs/format/CDataInterface/PyCapsuleInterface.html>.

use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use super::error::raised;
use crate::recording::arrow_table::ArrowTable;
use crate::recording::long_column::LongColumn;
use crate::recording::{Recording, RecordingError};

/// A table in memory.
#[pyclass(module = "idc._idc", frozen)]
pub(super) struct Table(ArrowTable);

impl Table {
    /// Of a recording.
    pub(super) fn of_recording(recording: &Recording) -> PyResult<Self> {
        Self::of(ArrowTable::of_recording(recording))
    }

    /// Of columns by name.
    pub(super) fn of_columns(columns: &[(String, LongColumn)]) -> PyResult<Self> {
        Self::of(ArrowTable::of_columns(columns))
    }

    fn of(made: Result<ArrowTable, RecordingError>) -> PyResult<Self> {
        made.map(Self).map_err(|error| raised(&error.into()))
    }
}

#[pymethods]
impl Table {
    /// Names of its columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.0.columns()
    }

    fn __len__(&self) -> usize {
        self.0.rows()
    }

    /// It for whoever takes Arrow. A schema that is asked for is not made.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        drop(requested_schema);
        PyCapsule::new(py, self.0.stream(), Some(c"arrow_array_stream".to_owned()))
    }
}
