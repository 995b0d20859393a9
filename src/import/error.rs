//! Faults of a log and its map.

use std::path::PathBuf;

use super::map::Column;
use crate::recording::RecordingError;

/// A log that cannot be imported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The file cannot be read at all.
    #[error("cannot read {}: {cause}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        cause: String,
    },
    /// A file of another form than the map says, or of one that is not read.
    #[error("{} is {what}; expected {expected}: {advice}", file.display())]
    Form {
        /// The file.
        file: PathBuf,
        /// Its form.
        what: String,
        /// The form expected.
        expected: String,
        /// The remedy.
        advice: String,
    },
    /// A text whose encoding cannot be determined, or is not the map's.
    #[error("the encoding of {} cannot be determined: {seen}; `encoding` in the map's [[file]] names it: \
        encoding = \"windows-1252\", \"utf-8\", \"utf-16le\", \"windows-1251\", \"ibm866\" or another", file.display())]
    Encoding {
        /// The file.
        file: PathBuf,
        /// The observation.
        seen: String,
    },
    /// The map names a column that is not there.
    #[error("{} has no {column}; there are {there}", file.display())]
    NoColumn {
        /// The file.
        file: PathBuf,
        /// The column.
        column: Column,
        /// The channels that are there.
        there: String,
    },
    /// The map names a column by a name that several have.
    #[error("{} has {} columns `{name}`, numbers {}: give the number of the one that is meant", file.display(), columns.len(), listed(columns))]
    SameName {
        /// The file.
        file: PathBuf,
        /// The name.
        name: String,
        /// The columns, from 1.
        columns: Vec<usize>,
    },
    /// No row is of the variable that the map means.
    #[error("{}: no row has `{value}` in {column}; there are {there}", file.display())]
    NoRows {
        /// The file.
        file: PathBuf,
        /// The column.
        column: Column,
        /// What should stand there.
        value: String,
        /// What stands there.
        there: String,
    },
    /// Fields that are not quoted where the same mark stands between them and in their numbers.
    #[error("{}:{line}: {found} fields, expected {expected}: `{mark}` stands between fields and before decimals, so that fields with decimals must be quoted", file.display())]
    Unquoted {
        /// The file.
        file: PathBuf,
        /// Its line, from 1.
        line: u64,
        /// The mark.
        mark: char,
        /// Fields found.
        found: usize,
        /// Fields expected.
        expected: usize,
    },
    /// Most rows would be left out.
    #[error("{}: {used} of {there} rows would be used, expected nine in ten at least: {why}; `accept_unused_rows = true` in the map's [[file]] uses those", file.display())]
    Unused {
        /// The file.
        file: PathBuf,
        /// Rows used.
        used: usize,
        /// Rows there.
        there: usize,
        /// Why the others are not, and what would help.
        why: String,
    },
    /// A row with too few fields.
    #[error("{}:{line}: {found} fields, expected at least {expected}, as the map's columns need", file.display())]
    Fields {
        /// The file.
        file: PathBuf,
        /// Its line, from 1.
        line: u64,
        /// Fields found.
        found: usize,
        /// Fields needed.
        expected: usize,
    },
    /// A field that is no number.
    #[error("{}:{line}: {column} is `{found}`, expected {expected}", file.display())]
    Number {
        /// The file.
        file: PathBuf,
        /// Its line, from 1.
        line: u64,
        /// The column.
        column: Column,
        /// The text that stands there.
        found: String,
        /// The right form.
        expected: String,
    },
    /// A log that is cut off.
    #[error("{} is cut off or damaged: {found}; {rest}; {advice}", file.display())]
    Truncated {
        /// The file.
        file: PathBuf,
        /// The sign of it.
        found: String,
        /// The readable part of it.
        rest: String,
        /// The right form.
        advice: String,
    },
    /// Times whose unit the map should give, or should not.
    #[error("{}: {column} holds {found}, expected {expected}", file.display())]
    TimeUnit {
        /// The file.
        file: PathBuf,
        /// The column.
        column: Column,
        /// Its content.
        found: String,
        /// The text expected in the map.
        expected: String,
    },
    /// A column whose values are no numbers.
    #[error("{}: {column} is {found}, expected {expected}", file.display())]
    Kind {
        /// The file.
        file: PathBuf,
        /// The column.
        column: Column,
        /// The kind found.
        found: String,
        /// The right form.
        expected: String,
    },
    /// Columns of different lengths.
    #[error("{}: {column} has {found} values, expected {expected}, as many as there are times", file.display())]
    Length {
        /// The file.
        file: PathBuf,
        /// The column.
        column: Column,
        /// Its values.
        found: usize,
        /// Times.
        expected: usize,
    },
    /// A clock that stands still.
    #[error("{}: all {rows} rows have the same time, expected it to increase", file.display())]
    Still {
        /// The file.
        file: PathBuf,
        /// Its rows.
        rows: usize,
    },
    /// A time that goes back.
    #[error("{}:{line}: time {found} s after {before} s, expected it to increase{advice}", file.display())]
    Time {
        /// The file.
        file: PathBuf,
        /// Its line, from 1.
        line: u64,
        /// The time [s].
        found: f64,
        /// The time before it [s].
        before: f64,
        /// The likely form, if that is known.
        advice: &'static str,
    },
    /// A clock that starts again.
    #[error("{}:{line}: time {found} s after {before} s: the clock starts again there, and with it another recording; `idc import --split` writes each by itself (of a map with one [[file]]), `drop_last_rows = {}` in [[file]] takes the one before, `drop_first_rows = {}` the one after", file.display(), dropped[1], dropped[0])]
    Restart {
        /// The file.
        file: PathBuf,
        /// Its line, from 1.
        line: u64,
        /// The time [s].
        found: f64,
        /// The time before it [s].
        before: f64,
        /// Rows at the start and at the end that are to be dropped for either part.
        dropped: [usize; 2],
    },
    /// Nothing is left.
    #[error("{}: of {rows} rows the map drops {dropped}, expected 2 at least to be left", file.display())]
    TooShort {
        /// The file.
        file: PathBuf,
        /// Its rows.
        rows: usize,
        /// Those dropped.
        dropped: usize,
    },
    /// The map names no file, and none was given.
    #[error("{} names no file for its [[file]] number {number}: give one after the map", map.display())]
    NoFile {
        /// The map.
        map: PathBuf,
        /// Which of its files.
        number: usize,
    },
    /// Two clocks that cannot be set against each other.
    #[error("{}: its clock cannot be found: at no offset does its `{own}` rise and fall with `{first}` of the first file (correlation {correlation:.2} at best, 0.5 is needed)", file.display())]
    Clock {
        /// The file.
        file: PathBuf,
        /// Quantity of the first file.
        first: String,
        /// Quantity of this one.
        own: String,
        /// The best correlation [1].
        correlation: f64,
    },
    /// Logs of different times.
    #[error("{} goes from {:.3} to {:.3} s and does not overlap {}, from {:.3} to {:.3} s; `clock_offset_s` or `clock = \"unknown\"` sets its clock right",
        file.display(), own[0], own[1], first_file.display(), first[0], first[1])]
    Apart {
        /// The file.
        file: PathBuf,
        /// From when to when it goes [s].
        own: [f64; 2],
        /// The first file.
        first_file: PathBuf,
        /// From when to when that goes [s].
        first: [f64; 2],
    },
    /// The channels together make no recording.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

/// Numbers of columns for a message.
fn listed(columns: &[usize]) -> String {
    const MOST: usize = 6;
    let mut numbers: Vec<String> = columns.iter().take(MOST).map(usize::to_string).collect();
    if columns.len() > MOST {
        numbers.push("...".to_owned());
    }
    numbers.join(", ")
}
