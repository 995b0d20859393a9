//! Recordings of rigs, as files of either form.

use std::path::Path;

use super::error::CaseError;
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::plant::{CHANNELS, DeviceParts};
use crate::recording::csv::{read_csv, read_csv_in_any_unit, read_readings};
use crate::recording::samples::read_table;
use crate::recording::{Recording, RecordingError};

/// Reads a recording: a Parquet table by its extension, otherwise comma-separated values. Of a rig with a part of the device not every input is asked for.
///
/// # Errors
/// Those of the file's form.
pub fn read_rig(parts: DeviceParts, path: &Path) -> Result<Recording, RecordingError> {
    if path
        .extension()
        .is_some_and(|extension| extension == "parquet")
    {
        return read_table(path);
    }
    let read = if parts == DeviceParts::Whole {
        read_csv(path)?
    } else {
        read_readings(path)?
    };
    Ok(read.recording)
}

/// Reads a recording of a whole device whose measured columns may be in any unit; none where that does not help, or it is a table with units of its own.
pub fn read_in_any_unit(parts: DeviceParts, path: &Path) -> Option<Recording> {
    let is_table = path.extension().is_some_and(|e| e == "parquet");
    let read = || read_csv_in_any_unit(path).ok();
    (parts == DeviceParts::Whole && !is_table)
        .then(read)??
        .recording
        .into()
}

/// Checks that a prediction is made of numbers throughout. `rig` and `inputs` are the files that it is of.
///
/// # Errors
/// [`CaseError::NotFinite`] with the first that is none.
pub fn check_finite(
    rig: &str,
    inputs: &str,
    time: &[f64],
    predicted: &[Vec<f64>; CHANNELS.len()],
) -> Result<(), CaseError> {
    for (column, values) in COLUMNS.into_iter().zip(predicted) {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(CaseError::NotFinite {
                rig: rig.to_owned(),
                inputs: inputs.to_owned(),
                time: time[index],
                column,
                value: values[index],
            });
        }
    }
    Ok(())
}

/// The columns of a prediction: those of a whole device that it has sensors of, that of the output of a part.
pub fn shown_columns(
    parts: DeviceParts,
    sensors: [bool; CHANNELS.len()],
    predicted: &[Vec<f64>; CHANNELS.len()],
) -> Vec<(&'static str, &[f64])> {
    let output = parts.output().map(|channel| channel as usize);
    let columns = COLUMNS.into_iter().zip(predicted).enumerate();
    columns
        .filter(|(place, _)| output.map_or(sensors[*place], |output| output == *place))
        .map(|(_, (column, values))| (column, values.as_slice()))
        .collect()
}

/// The samples of a run.
pub(super) const SAMPLES: &str = "samples.parquet";

/// Whether a file holds the samples of a run.
pub(super) fn is_run(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name == SAMPLES)
}
