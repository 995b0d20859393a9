//! Recordings of rigs, as files of either form.

use std::path::Path;

use crate::plant::Chain;
use crate::recording::csv::{read_csv, read_readings};
use crate::recording::parquet::read_parquet;
use crate::recording::{Recording, RecordingError};

/// Reads a recording: a Parquet table by its extension, otherwise comma-separated values. Of a rig with a part of the device not every input is asked for.
///
/// # Errors
/// Those of the file's form.
pub(super) fn read_rig(chain: Chain, path: &Path) -> Result<Recording, RecordingError> {
    if path
        .extension()
        .is_some_and(|extension| extension == "parquet")
    {
        return Ok(read_parquet(path)?.recording);
    }
    let read = if chain == Chain::Whole {
        read_csv(path)?
    } else {
        read_readings(path)?
    };
    Ok(read.recording)
}
