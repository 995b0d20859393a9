//! The numbers of a log, whatever its form: series against their own times, in SI.

use std::path::Path;

use super::error::ImportError;
use super::map::{Column, FileMap, Form};
use super::text;

/// What a log holds of a map's channels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// One for each channel of the map, in its order.
    pub series: Vec<Series>,
    /// What was left out, or mended, for people.
    pub remarks: Vec<Remark>,
}

/// Values against times.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Times [s], increasing.
    pub time: Vec<f64>,
    /// Values [SI], NaN where the log has none.
    pub values: Vec<f64>,
}

/// Something that a user should know of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Remark {
    /// Rows that were dropped as the map asks, at the start and at the end.
    Dropped([usize; 2]),
    /// Rows, from 1 in the file, that repeat the one before them.
    Repeated(Vec<u64>),
    /// Rows whose time is that of the row before them; the first of each counts.
    Stamped(Vec<u64>),
    /// The last row is torn: it ends before its last field.
    Torn(u64),
}

/// Rows of numbers as they are written, before units.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Rows {
    /// Times, in the map's unit.
    pub time: Vec<f64>,
    /// Numbers of each channel of the map.
    pub columns: Vec<Vec<f64>>,
    /// Where each row stands, from 1.
    pub lines: Vec<u64>,
    /// What was left out while reading.
    pub remarks: Vec<Remark>,
}

/// Reads a log as its map says.
///
/// # Errors
/// The file, its row and column that do not fit the map, and what would.
pub fn read_log(path: &Path, map: &FileMap) -> Result<Log, ImportError> {
    let rows = match &map.form {
        Form::Text(form) => text::read(path, form, map)?,
        Form::Parquet | Form::Mat5 | Form::Mcap => {
            return Err(ImportError::Read {
                file: path.to_owned(),
                cause: "this form is not read yet".to_owned(),
            });
        }
    };
    of_rows(path, map, rows)
}

/// Rows in SI, those left out that the map drops or that say nothing new.
fn of_rows(path: &Path, map: &FileMap, rows: Rows) -> Result<Log, ImportError> {
    let Rows {
        time,
        columns,
        lines,
        mut remarks,
    } = rows;
    let [first, last] = map.dropped;
    let count = time.len();
    let kept = first..count.saturating_sub(last);
    if kept.len() < 2 {
        return Err(ImportError::TooShort {
            file: path.to_owned(),
            rows: count,
            dropped: first + last,
        });
    }
    if first + last > 0 {
        remarks.push(Remark::Dropped([first, last]));
    }
    let unit = map.time.as_ref().map(|time| time.unit);
    let seconds = |row: usize| unit.map_or(time[row], |unit| unit.to_si(time[row]));
    let (mut taken, mut repeated, mut stamped) = (Vec::new(), Vec::new(), Vec::new());
    let same = |a: f64, b: f64| a == b || (a.is_nan() && b.is_nan());
    for row in kept {
        if let Some(&before) = taken.last() {
            if seconds(row) < seconds(before) {
                return Err(ImportError::Time {
                    file: path.to_owned(),
                    line: lines[row],
                    found: seconds(row),
                    before: seconds(before),
                });
            }
            if seconds(row) == seconds(before) {
                let repeats = columns.iter().all(|c| same(c[row], c[before]));
                if repeats { &mut repeated } else { &mut stamped }.push(lines[row]);
                continue;
            }
        }
        taken.push(row);
    }
    if !repeated.is_empty() {
        remarks.push(Remark::Repeated(repeated));
    }
    if !stamped.is_empty() {
        remarks.push(Remark::Stamped(stamped));
    }
    let time: Vec<f64> = taken.iter().map(|row| seconds(*row)).collect();
    let channels = map.channels.iter().zip(&columns);
    let series = channels.map(|(channel, numbers)| Series {
        time: time.clone(),
        values: taken
            .iter()
            .map(|row| channel.to_si(numbers[*row]))
            .collect(),
    });
    Ok(Log {
        series: series.collect(),
        remarks,
    })
}

/// Where a map's columns stand among named or numbered ones.
pub(super) fn places(
    path: &Path,
    map: &FileMap,
    names: Option<&[String]>,
    count: usize,
) -> Result<(Option<usize>, Vec<usize>), ImportError> {
    let place = |column: &Column| match column {
        Column::Number(number) if *number <= count => Ok(number - 1),
        Column::Number(_) => Err(ImportError::NoColumn {
            file: path.to_owned(),
            column: column.clone(),
            there: format!("{count} columns"),
        }),
        Column::Name(name) => {
            let found = names.and_then(|names| names.iter().position(|known| known == name));
            found.ok_or_else(|| ImportError::NoColumn {
                file: path.to_owned(),
                column: column.clone(),
                there: match names {
                    Some(names) => named(name, names),
                    None => format!("{count} columns without names: `names_line` says where they stand, or give a number"),
                },
            })
        }
    };
    let time = map.time.as_ref().map(|time| place(&time.column));
    let channels = map.channels.iter().map(|channel| place(&channel.column));
    Ok((time.transpose()?, channels.collect::<Result<_, _>>()?))
}

/// The names there are, the nearest first.
fn named(wanted: &str, names: &[String]) -> String {
    let mut sorted: Vec<&String> = names.iter().collect();
    sorted.sort_by(|a, b| {
        let near = |name: &str| strsim::jaro_winkler(wanted, name);
        near(b).total_cmp(&near(a))
    });
    let quoted: Vec<String> = sorted.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}
