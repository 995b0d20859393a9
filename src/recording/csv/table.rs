//! The fields of a file: numbers in their columns.

use std::path::Path;

use super::super::RecordingError;
use super::columns::{Column, TIME};
use super::line::line_of;

/// Content of a file.
pub(super) struct ParsedTable {
    /// Sample times [s], increasing.
    pub time: Vec<f64>,
    /// Values in the order of the columns asked for, NaN for an empty field; none for a column that the file lacks.
    pub columns: Vec<Option<Vec<f64>>>,
    /// Line of each sample, from 1.
    pub lines: Vec<u64>,
    /// Lines that repeat the one before.
    pub repeated: Vec<u64>,
    /// Columns that mean nothing here.
    pub ignored: Vec<String>,
}

/// Where the columns stand in a line.
struct Places {
    time: usize,
    columns: Vec<Option<usize>>,
    ignored: Vec<String>,
}

/// Reads a file's fields.
pub(super) fn read(path: &Path, columns: &[Column]) -> Result<ParsedTable, RecordingError> {
    let text = crate::file::read_text(path).map_err(|e| RecordingError::read(path, e))?;
    let text = text.trim_start_matches('\u{feff}');
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| fault(path, text, &e))?.clone();
    let places = places(path, &header, columns)?;
    let mut table = ParsedTable {
        time: Vec::new(),
        columns: places
            .columns
            .iter()
            .map(|place| place.map(|_| Vec::new()))
            .collect(),
        lines: Vec::new(),
        repeated: Vec::new(),
        ignored: places.ignored,
    };
    let mut before = csv::StringRecord::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(path, text, &e))?;
        let line = line_of(text, record.position());
        if !table.time.is_empty() && record == before {
            table.repeated.push(line);
            continue;
        }
        let time = time(path, line, &record[places.time], table.time.last().copied())?;
        table.time.push(time);
        table.lines.push(line);
        for (index, values) in table.columns.iter_mut().enumerate() {
            if let (Some(values), Some(place)) = (values, places.columns[index]) {
                let name = columns[index].name;
                values.push(value(path, line, name, &record[place])?);
            }
        }
        before = record;
    }
    check_held(path, &table, columns)?;
    if table.time.len() < 2 {
        return Err(RecordingError::read(
            path,
            format!("{} samples, expected at least 2", table.time.len()),
        ));
    }
    Ok(table)
}

pub(super) fn fault(path: &Path, text: &str, error: &csv::Error) -> RecordingError {
    let line = line_of(text, error.position());
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            len, expected_len, ..
        } => RecordingError::Fields {
            path: path.to_owned(),
            line,
            found: *len,
            expected: *expected_len,
        },
        _ => RecordingError::read(path, error),
    }
}

/// Finds the columns by their names.
fn places(
    path: &Path,
    header: &csv::StringRecord,
    columns: &[Column],
) -> Result<Places, RecordingError> {
    let refuse = |column: &str, found: String, expected: String| RecordingError::Column {
        path: path.to_owned(),
        column: column.to_owned(),
        found,
        expected,
    };
    let known = || std::iter::once(TIME).chain(columns.iter().map(|column| column.name));
    let mut ignored = Vec::new();
    for (index, name) in header.iter().enumerate() {
        // Of a file that is no recording nothing is shown.
        let is_ours = header.iter().any(|name| name == TIME);
        if is_ours && header.iter().take(index).any(|other| other == name) {
            return Err(refuse(name, "there twice".to_owned(), "it once".to_owned()));
        }
        if known().any(|known| known == name) || is_of_band(name, known()) {
            continue;
        }
        if let Some(right) = known().find(|right| stem(right) == stem(name)) {
            let expected = format!("the column `{right}`, in SI");
            return Err(refuse(name, "unknown".to_owned(), expected));
        }
        ignored.push(name.to_owned());
    }
    let place = |name: &str| header.iter().position(|column| column == name);
    let time = place(TIME).ok_or_else(|| {
        let names: Vec<&str> = known().collect();
        let expected = format!("the columns {}", names.join(", "));
        refuse(TIME, "missing".to_owned(), expected)
    })?;
    Ok(Places {
        time,
        columns: columns.iter().map(|column| place(column.name)).collect(),
        ignored,
    })
}

/// Whether a column is an end of the band of a predicted column, or says where that is known ground: a prediction is read as a recording without them.
fn is_of_band<'a>(name: &str, mut known: impl Iterator<Item = &'a str>) -> bool {
    let ends = ["_low", "_high"];
    let of = ends.into_iter().find_map(|end| name.strip_suffix(end));
    name == "known_ground" || of.is_some_and(|of| known.any(|known| known == of))
}

/// Part of a column's name besides its unit: `force` of `force_n`, `force_kN` and `Force`.
fn stem(name: &str) -> String {
    const STEMS: [&str; 8] = [
        "time",
        "set_pressure",
        "solenoid",
        "surface",
        "regulator_pressure",
        "stroke",
        "force",
        "acceleration",
    ];
    let lower = name.to_lowercase();
    let is_unit = |rest: &str| {
        rest.is_empty()
            || rest
                .strip_prefix('_')
                .is_some_and(|unit| unit.split('_').all(|word| word.len() <= 3))
    };
    let stem = STEMS
        .iter()
        .find(|stem| lower.strip_prefix(*stem).is_some_and(is_unit));
    stem.map_or(lower.clone(), |stem| (*stem).to_owned())
}

fn time(path: &Path, line: u64, text: &str, before: Option<f64>) -> Result<f64, RecordingError> {
    let refuse = |found: String, expected: String| RecordingError::Line {
        path: path.to_owned(),
        line,
        column: TIME.to_owned(),
        found,
        expected,
    };
    let time = match text.parse::<f64>() {
        Ok(time) if time.is_finite() => time,
        _ => return Err(refuse(format!("{text:?}"), "a time in s".to_owned())),
    };
    match before {
        Some(before) if time <= before => {
            let expected = format!("more than the {before} s of the sample before it");
            Err(refuse(format!("{time} s"), expected))
        }
        _ => Ok(time),
    }
}

/// A field as a number, NaN if it is empty.
pub(super) fn value(
    path: &Path,
    line: u64,
    column: &str,
    text: &str,
) -> Result<f64, RecordingError> {
    if text.is_empty() {
        return Ok(f64::NAN);
    }
    match text.parse::<f64>() {
        Ok(value) if value.is_nan() || value.is_finite() => Ok(value),
        _ => Err(RecordingError::Line {
            path: path.to_owned(),
            line,
            column: column.to_owned(),
            found: format!("{text:?}"),
            expected: "a finite number, or nothing".to_owned(),
        }),
    }
}

/// Commands are held, so one that is lost is known by the one before it; the valve has two positions.
fn check_held(path: &Path, table: &ParsedTable, columns: &[Column]) -> Result<(), RecordingError> {
    for (column, values) in columns.iter().zip(&table.columns) {
        let Some(values) = values.as_ref().filter(|_| column.is_held) else {
            continue;
        };
        let refuse = |line: u64, found: String, expected: &str| RecordingError::Line {
            path: path.to_owned(),
            line,
            column: column.name.to_owned(),
            found,
            expected: expected.to_owned(),
        };
        if values.first().is_some_and(|first| first.is_nan()) {
            let expected = "what is commanded at the start";
            return Err(refuse(table.lines[0], "empty".to_owned(), expected));
        }
        let is_valve = column.name == "solenoid";
        let wrong = values
            .iter()
            .position(|value| is_valve && !value.is_nan() && *value != 0.0 && *value != 1.0);
        if let Some(index) = wrong {
            let expected = "1 to extend or 0 to retract";
            return Err(refuse(
                table.lines[index],
                values[index].to_string(),
                expected,
            ));
        }
    }
    Ok(())
}
