//! Tables handed over in memory by Arrow's C data interface, to whoever takes it in the same process.

use arrow::array::{RecordBatch, RecordBatchIterator};
use arrow::ffi_stream::FFI_ArrowArrayStream;

use super::long_column::LongColumn;
use super::long_table::batch_of_columns;
use super::parquet::batch_of;
use super::{Recording, RecordingError};

/// What a consumer takes: <https://arrow.apache.org/docs/format/CStreamInterface.html>.
pub type ArrowStream = FFI_ArrowArrayStream;

/// A table.
#[derive(Debug, Clone)]
pub struct ArrowTable(RecordBatch);

impl ArrowTable {
    /// A recording, as samples.parquet has it.
    ///
    /// # Errors
    /// Its columns make no table.
    pub fn of_recording(recording: &Recording) -> Result<Self, RecordingError> {
        batch_of(recording).map(Self).map_err(|e| refused(&e))
    }

    /// Columns by name, all of one length.
    ///
    /// # Errors
    /// They make no table.
    pub fn of_columns(columns: &[(String, LongColumn)]) -> Result<Self, RecordingError> {
        batch_of_columns(columns).map(Self).map_err(|e| refused(&e))
    }

    /// Names of its columns.
    pub fn columns(&self) -> Vec<String> {
        let schema = self.0.schema();
        let fields = schema.fields().iter();
        fields.map(|field| field.name().clone()).collect()
    }

    /// Number of its rows.
    pub fn rows(&self) -> usize {
        self.0.num_rows()
    }

    /// It as one batch. Nothing is copied: the values are shared until the last who has them lets go.
    pub fn stream(&self) -> ArrowStream {
        let batches = std::iter::once(Ok(self.0.clone()));
        let reader = RecordBatchIterator::new(batches, self.0.schema());
        FFI_ArrowArrayStream::new(Box::new(reader))
    }
}

fn refused(error: &arrow::error::ArrowError) -> RecordingError {
    RecordingError::read(std::path::Path::new("a table in memory"), error)
}
