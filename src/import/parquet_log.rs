//! A log as a Parquet table.

use std::path::Path;

use super::error::ImportError;
use super::map::{ChannelMap, FileMap, TimeMap};
use super::numbers::Marks;
use super::rows::{Rows, Times, places};
use super::{signature, stamps, units, words};
use crate::recording::Unit;
use crate::recording::table::{Cells, Table};

/// Reads the rows of a table.
pub(super) fn read(path: &Path, map: &FileMap) -> Result<Rows, ImportError> {
    signature::check(path, "parquet", "a Parquet table")?;
    let table = Table::open(path, map.limit)?;
    let names = table.names();
    let (time_place, channel_places) = places(path, map, Some(&names), names.len())?;
    let wanted: Vec<usize> = time_place.iter().chain(&channel_places).copied().collect();
    let mut cells = table.read(&wanted)?.into_iter();
    let time = match &map.time {
        Some(time) => (cells.next())
            .map(|cells| times(path, time, map.sample_rate.is_some(), cells))
            .transpose()?,
        None => None,
    };
    let pairs = cells.zip(&map.channels);
    let columns = pairs.map(|(cells, channel)| values(path, channel, cells));
    let columns: Vec<Vec<f64>> = columns.collect::<Result<_, _>>()?;
    let time = time.unwrap_or_else(|| Times::of_rate(columns.first().map_or(0, Vec::len)));
    let count = time.len();
    Ok(Rows {
        channels: (0..map.channels.len()).collect(),
        time,
        columns,
        lines: (1..=count as u64).collect(),
        ..Rows::default()
    })
}

/// Values of a channel; numbers and words of two states may stand there as texts.
fn values(path: &Path, channel: &ChannelMap, cells: Cells) -> Result<Vec<f64>, ImportError> {
    let Cells::Texts(texts) = cells else {
        return Ok(numbers(&cells));
    };
    let of_states = channel.unit.si == Unit::One;
    let number = |(row, text): (usize, &Option<String>)| {
        let text = text.as_deref().unwrap_or("").trim();
        let number = if of_states {
            PLAIN.number_or_word(text)
        } else {
            PLAIN.number(text)
        };
        number.ok_or_else(|| ImportError::Number {
            file: path.to_owned(),
            line: row as u64 + 1,
            column: channel.column.clone(),
            found: text.to_owned(),
            expected: if of_states {
                format!("a number or a word such as {}", words::EXAMPLES)
            } else {
                "a number".to_owned()
            },
        })
    };
    texts.iter().enumerate().map(number).collect()
}

/// Marks of numbers that stand as texts in a table.
const PLAIN: Marks = Marks {
    decimal: '.',
    thousands: None,
};

/// Stamps are numbers too, as of when a valve was switched [s]; of texts those that are numbers.
pub(super) fn numbers(cells: &Cells) -> Vec<f64> {
    match cells {
        Cells::Numbers(numbers) => numbers.clone(),
        Cells::Nanoseconds(stamps) => stamps
            .iter()
            .map(|stamp| stamp.map_or(f64::NAN, |stamp| stamp as f64 * 1e-9))
            .collect(),
        Cells::Texts(texts) => {
            let number = |text: &Option<String>| PLAIN.number_or_word(text.as_deref()?.trim());
            texts
                .iter()
                .map(|text| number(text).unwrap_or(f64::NAN))
                .collect()
        }
    }
}

/// Times of a column that says its unit itself, or whose unit the map says.
pub(super) fn times(
    path: &Path,
    map: &TimeMap,
    counts: bool,
    cells: Cells,
) -> Result<Times, ImportError> {
    let empty = |row: usize| ImportError::Number {
        file: path.to_owned(),
        line: row as u64 + 1,
        column: map.column.clone(),
        found: String::new(),
        expected: "a time".to_owned(),
    };
    match cells {
        Cells::Texts(texts) if map.unit.is_some() || counts => {
            let numbers = Cells::Numbers(numbers(&Cells::Texts(texts)));
            times(path, map, counts, numbers)
        }
        Cells::Texts(texts) => {
            if let Some(row) = texts.iter().position(Option::is_none) {
                return Err(empty(row));
            }
            let texts: Vec<String> = texts.into_iter().flatten().collect();
            let read = stamps::nanoseconds(&texts, map.reading());
            read.map(Times::Nanoseconds)
                .map_err(|unread| ImportError::Number {
                    file: path.to_owned(),
                    line: unread.index as u64 + 1,
                    column: map.column.clone(),
                    found: texts[unread.index].clone(),
                    expected: unread.expected,
                })
        }
        Cells::Numbers(numbers) => {
            if map.unit.is_none() && !counts {
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
