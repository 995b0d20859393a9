//! Recordings of a real rig as comma-separated values: one header line, SI units, pressures gauge, an empty field where there is no value.
//!
//! Faults are refused with file, line and column: no number where there must be one, time that does not increase, values that are implausible as SI
//! (bar for pascal, mm for m). Single readings may be implausible, as sensors go wild; a whole column may not. A line that repeats the one before it is left out.

use std::path::Path;

use super::atomic::write_atomic;
use super::{RecordedChannel, Recording, RecordingError};
use crate::stats::median_step;
use crate::unit::column_name;
use columns::{COLUMNS, Column, TIME};

mod cell;
mod columns;
mod edge_profile;
mod line;
mod log;
mod named;
mod table;
#[cfg(test)]
mod tests;

pub use cell::{CellRecording, read_cell_csv};
pub use columns::{column_of, plausible_range};
pub use edge_profile::EdgeProfile;
pub use line::line_of;
#[cfg(feature = "parquet")]
pub(super) use log::no_stamps;
pub use log::{Log, read_log_csv};
pub use named::{NamedColumns, header_of, read_named};

/// A recording with what its file holds besides.
#[derive(Debug, Clone, PartialEq)]
pub struct CsvRecording {
    /// The recording; channels whose column the file lacks are absent.
    pub recording: Recording,
    /// Lines, from 1, that repeated the line before them and were left out.
    pub repeated: Vec<u64>,
    /// Columns that mean nothing here and were left out.
    pub ignored: Vec<String>,
}

/// Reads a recording.
///
/// # Errors
/// File, line and column of what is wrong, what was found and what was expected.
pub fn read_csv(path: &Path) -> Result<CsvRecording, RecordingError> {
    read(path, true, true)
}

/// Reads a recording whose measured columns may be in any unit: whoever reads it finds out which.
///
/// # Errors
/// As [`read_csv`], but for measured values that are implausible as SI.
pub fn read_csv_in_any_unit(path: &Path) -> Result<CsvRecording, RecordingError> {
    read(path, true, false)
}

/// Reads what was measured, or predicted, without the inputs that drove the rig; those that are there are read as well.
///
/// # Errors
/// As [`read_csv`].
pub fn read_readings(path: &Path) -> Result<CsvRecording, RecordingError> {
    read(path, false, true)
}

fn read(path: &Path, with_inputs: bool, in_si: bool) -> Result<CsvRecording, RecordingError> {
    let table = table::read(path, &COLUMNS)?;
    let mut channels = Vec::new();
    for (column, values) in COLUMNS.iter().zip(&table.columns) {
        match values {
            Some(values) => {
                if in_si || column.is_input {
                    check_plausible(path, column, values, &table.lines)?;
                }
                channels.push(RecordedChannel::new(
                    column.quantity,
                    column.unit,
                    values.clone(),
                ));
            }
            None if column.is_input && with_inputs => {
                return Err(RecordingError::Column {
                    path: path.to_owned(),
                    column: column.name.to_owned(),
                    found: "missing".to_owned(),
                    expected: "it beside the other inputs".to_owned(),
                });
            }
            None => {}
        }
    }
    check_step(path, &table.time)?;
    Ok(CsvRecording {
        recording: Recording::new(table.time, channels, Vec::new())?,
        repeated: table.repeated,
        ignored: table.ignored,
    })
}

/// Writes columns of values beside their times [s]; a value that is not finite becomes an empty field.
///
/// # Errors
/// The file cannot be written; nothing is left in its place.
pub fn write_csv(
    path: &Path,
    time: &[f64],
    columns: &[(&str, &[f64])],
) -> Result<(), RecordingError> {
    write_atomic(path, |file| write_columns(file, time, columns))
}

/// Writes a recording as comma-separated values, its columns named as [`read_csv`] and [`read_cell_csv`] take them: those of sensors by their short names. A quantity
/// that would have the name of its sensor's column, as in a simulated recording that holds both, is `true_` and that name.
///
/// # Errors
/// The file cannot be written; nothing is left in its place.
pub fn write_recording(path: &Path, recording: &Recording) -> Result<(), RecordingError> {
    let channels = recording.channels();
    let mut names = Vec::with_capacity(channels.len());
    for own in channels {
        let name = column_of(&own.quantity, own.unit);
        let is_of_sensor = |other: &RecordedChannel| {
            other.quantity != own.quantity && column_of(&other.quantity, other.unit) == name
        };
        let is_plain = name == column_name(&own.quantity, own.unit);
        names.push(match is_plain && channels.iter().any(is_of_sensor) {
            true => format!("true_{name}"),
            false => name,
        });
    }
    let values = channels.iter().map(|channel| channel.values.as_slice());
    let columns: Vec<(&str, &[f64])> = names.iter().map(String::as_str).zip(values).collect();
    write_csv(path, recording.time(), &columns)
}

/// As [`write_csv`], as a text.
///
/// # Errors
/// None that is to be expected: a text can always be written.
pub fn columns_text(time: &[f64], columns: &[(&str, &[f64])]) -> Result<String, RecordingError> {
    let mut bytes = Vec::new();
    let fail = |cause: String| RecordingError::write(Path::new("columns"), cause);
    write_columns(&mut bytes, time, columns).map_err(|error| fail(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| fail(error.to_string()))
}

fn write_columns(
    output: impl std::io::Write,
    time: &[f64],
    columns: &[(&str, &[f64])],
) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(output);
    let names = columns.iter().map(|(name, _)| *name);
    writer.write_record(std::iter::once(TIME).chain(names))?;
    for (row, time) in time.iter().enumerate() {
        writer.write_field(format!("{time:?}"))?;
        for (_, values) in columns {
            let value = values[row];
            let text = if value.is_finite() {
                format!("{value:?}")
            } else {
                String::new()
            };
            writer.write_field(text)?;
        }
        writer.write_record(None::<&[u8]>)?;
    }
    writer.flush()?;
    Ok(())
}

/// Share of a sensor's readings that may be wild [1].
const MOST_WILD: f64 = 0.02;

fn check_plausible(
    path: &Path,
    column: &Column,
    values: &[f64],
    lines: &[u64],
) -> Result<(), RecordingError> {
    let [low, high] = column.range;
    let symbol = column.unit.symbol();
    let refuse = |line: u64, found: String, expected: String| RecordingError::Line {
        path: path.to_owned(),
        line,
        column: column.name.to_owned(),
        found,
        expected,
    };
    let outside = |value: &f64| *value < low || *value > high;
    let count = values.iter().filter(|value| outside(value)).count();
    let allowed = if column.is_input { 0.0 } else { MOST_WILD };
    if count as f64 > allowed * values.len() as f64
        && let Some(index) = values.iter().position(outside)
    {
        let mut expected = format!("{low} to {high} {symbol}");
        if let Some(other) = column.larger_than_si {
            expected += &format!(" (it looks like {other}; recordings are in SI)");
        }
        let found = format!("{} {symbol}", values[index]);
        return Err(refuse(lines[index], found, expected));
    }
    let largest = values.iter().copied().fold(0.0, f64::max);
    if largest > 0.0 && largest < column.least_maximum {
        let index = values
            .iter()
            .position(|value| *value == largest)
            .unwrap_or(0);
        let expected = format!(
            "at least {} {symbol} somewhere (it looks like bar or kPa; recordings are in SI)",
            column.least_maximum
        );
        return Err(refuse(
            lines[index],
            format!("{largest} {symbol} at most"),
            expected,
        ));
    }
    Ok(())
}

/// Times in milliseconds would make samples seconds apart.
fn check_step(path: &Path, time: &[f64]) -> Result<(), RecordingError> {
    const LONGEST: f64 = 0.2;
    let step = median_step(time);
    if step <= LONGEST {
        return Ok(());
    }
    Err(RecordingError::Column {
        path: path.to_owned(),
        column: TIME.to_owned(),
        found: format!("in steps of {step} s"),
        expected: format!("steps of at most {LONGEST} s (it looks like ms; recordings are in SI)"),
    })
}
