//! A log as a Parquet table.

use std::path::Path;

use super::error::ImportError;
use super::map::{FileMap, TimeMap};
use super::rows::{Rows, Times, places};
use super::units;
use crate::recording::Unit;
use crate::recording::table::{Cells, Table};

/// Reads the rows of a table.
pub(super) fn read(path: &Path, map: &FileMap) -> Result<Rows, ImportError> {
    let table = Table::open(path)?;
    let names = table.names();
    let (time_place, channel_places) = places(path, map, Some(&names), names.len())?;
    let wanted: Vec<usize> = time_place.iter().chain(&channel_places).copied().collect();
    let mut cells = table.read(&wanted)?.into_iter();
    let time = match (&map.time, cells.next()) {
        (Some(time), Some(cells)) => times(path, time, cells)?,
        // A Parquet's map has a time.
        _ => Times::default(),
    };
    let columns: Vec<Vec<f64>> = cells.map(numbers).collect();
    let count = match &time {
        Times::Numbers(numbers) => numbers.len(),
        Times::Nanoseconds(stamps) => stamps.len(),
    };
    Ok(Rows {
        channels: (0..map.channels.len()).collect(),
        time,
        columns,
        lines: (1..=count as u64).collect(),
        remarks: Vec::new(),
    })
}

/// Stamps are numbers too, as of when a valve was switched [s].
fn numbers(cells: Cells) -> Vec<f64> {
    match cells {
        Cells::Numbers(numbers) => numbers,
        Cells::Nanoseconds(stamps) => stamps
            .iter()
            .map(|stamp| stamp.map_or(f64::NAN, |stamp| stamp as f64 * 1e-9))
            .collect(),
    }
}

fn times(path: &Path, map: &TimeMap, cells: Cells) -> Result<Times, ImportError> {
    let empty = |row: usize| ImportError::Number {
        file: path.to_owned(),
        line: row as u64 + 1,
        column: map.column.clone(),
        found: String::new(),
        expected: "a time".to_owned(),
    };
    match cells {
        Cells::Numbers(numbers) => {
            if map.unit.is_none() {
                return Err(ImportError::TimeUnit {
                    file: path.to_owned(),
                    column: map.column.clone(),
                    found: "numbers".to_owned(),
                    expected: format!(
                        "`unit` in [file.time]: one of {}",
                        units::of_kind(Unit::Second).join(", ")
                    ),
                });
            }
            match numbers.iter().position(|number| !number.is_finite()) {
                Some(row) => Err(empty(row)),
                None => Ok(Times::Numbers(numbers)),
            }
        }
        Cells::Nanoseconds(stamps) => {
            if let Some(unit) = map.unit {
                return Err(ImportError::TimeUnit {
                    file: path.to_owned(),
                    column: map.column.clone(),
                    found: "stamps, which say their unit themselves".to_owned(),
                    expected: format!("no `unit = \"{}\"` in [file.time]", unit.name),
                });
            }
            let all: Option<Vec<i64>> = stamps.iter().copied().collect();
            match all {
                Some(stamps) => Ok(Times::Nanoseconds(stamps)),
                None => Err(empty(
                    stamps.iter().position(Option::is_none).unwrap_or_default(),
                )),
            }
        }
    }
}
