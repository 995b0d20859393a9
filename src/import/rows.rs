//! Rows of numbers as a log has them, before units, and where a map's columns stand in it.

use std::path::Path;

use super::error::ImportError;
use super::map::{Column, FileMap};

/// Names that a message lists, at most.
const LISTED: usize = 12;

/// Something that a user should know of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Remark {
    /// Rows that were dropped as the map asks, at the start and at the end.
    Dropped([usize; 2]),
    /// Rows, from 1 in the file, that repeat the one before them.
    Repeated(Vec<u64>),
    /// Rows whose time is that of the row before them; the first of each counts.
    Stamped(Vec<u64>),
    /// It is cut off, and the map accepts what is left: what that is.
    Truncated(String),
    /// Rows without a stamp, their time being zero among those that count from 1970.
    Unstamped(Vec<u64>),
    /// Its rows go back in time, the newest first, and were turned round.
    Reversed,
    /// Something about its files, a sentence.
    Note(String),
    /// Rows of other variables than the map means.
    Others(usize),
    /// Rows that hold nothing in the map's columns, as those of another clock.
    Hollow(usize),
    /// Lines that are no rows, left out as the map asks.
    Strays(Vec<Stray>),
    /// Its last line does not end, and its last number may have lost digits.
    Unended(u64),
}

/// A line among the rows that is none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stray {
    /// Its number, from 1.
    pub line: u64,
    /// Its beginning.
    pub text: String,
}

/// Times as they are written.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Times {
    /// In the map's unit.
    Numbers(Vec<f64>),
    /// Stamps [ns].
    Nanoseconds(Vec<i64>),
}

impl Times {
    /// Their number.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Nanoseconds(stamps) => stamps.len(),
        }
    }

    /// The places of rows that follow each other at a rate.
    pub fn counts(rows: usize) -> Vec<f64> {
        (0..rows).map(|row| row as f64).collect()
    }

    /// Rows that follow each other at a rate.
    pub fn of_rate(rows: usize) -> Self {
        Self::Numbers(Self::counts(rows))
    }
}

impl Default for Times {
    fn default() -> Self {
        Self::Numbers(Vec::new())
    }
}

/// Rows of numbers as they are written, before units.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Rows {
    /// Which of the map's channels they are.
    pub channels: Vec<usize>,
    /// Times.
    pub time: Times,
    /// Numbers of each of those channels.
    pub columns: Vec<Vec<f64>>,
    /// Where each row stands, from 1.
    pub lines: Vec<u64>,
    /// Data left out while reading.
    pub remarks: Vec<Remark>,
    /// Rows that are there for these channels, where some of them were left out while reading.
    pub there: Option<usize>,
    /// Whether what the map drops was dropped while reading.
    pub is_trimmed: bool,
}

/// Where a map's columns stand among named or numbered ones.
pub(super) fn places(
    path: &Path,
    map: &FileMap,
    names: Option<&[String]>,
    count: usize,
) -> Result<(Option<usize>, Vec<usize>), ImportError> {
    let place = |column: &Column| place(path, column, names, count);
    let time = map.time.as_ref().map(|time| place(&time.column));
    let channels = map.channels.iter().map(|channel| place(&channel.column));
    Ok((time.transpose()?, channels.collect::<Result<_, _>>()?))
}

/// Where a column stands among named or numbered ones.
pub(super) fn place(
    path: &Path,
    column: &Column,
    names: Option<&[String]>,
    count: usize,
) -> Result<usize, ImportError> {
    match column {
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
                    Some(names) => nearest_first(name, names),
                    None => format!("{count} columns without names: `names_line` says where they stand, or give a number"),
                },
            })
        }
    }
}

/// The names there are, the nearest first.
pub(super) fn nearest_first(wanted: &str, names: &[String]) -> String {
    let wanted = wanted.to_lowercase();
    let mut sorted: Vec<&String> = names.iter().collect();
    sorted.sort_by(|a, b| {
        let near = |name: &str| strsim::jaro_winkler(&wanted, &name.to_lowercase());
        near(b).total_cmp(&near(a))
    });
    let listed = sorted.iter().take(LISTED);
    let mut quoted: Vec<String> = listed.map(|name| format!("`{name}`")).collect();
    if sorted.len() > LISTED {
        quoted.push(format!("{} more", sorted.len() - LISTED));
    }
    quoted.join(", ")
}
