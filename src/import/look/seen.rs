//! A log as it was seen: its columns, and how sure what is said of them is.

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::import::map::{Column, Pressure};
use crate::import::stamps;
use crate::import::units::LogUnit;

/// A map's text with what is left to its owner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Draft {
    /// The map, commented.
    pub text: String,
    /// Questions that remain open, a sentence each; the map is not complete without an answer.
    pub open: Vec<String>,
    /// Quantities that were found, with their columns.
    pub found: Vec<(String, String)>,
}

/// Certainty of something, and its reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Because {
    pub is_certain: bool,
    pub why: String,
}

impl Because {
    pub fn certain(why: impl Into<String>) -> Self {
        Self {
            is_certain: true,
            why: why.into(),
        }
    }

    pub fn likely(why: impl Into<String>) -> Self {
        Self {
            is_certain: false,
            why: why.into(),
        }
    }
}

impl std::fmt::Display for Because {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sure = if self.is_certain { "certain" } else { "likely" };
        write!(f, "{sure}: {}", self.why)
    }
}

/// A unit that a name or a row of units says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SaidUnit {
    pub unit: &'static LogUnit,
    /// Against what, where it says that of a pressure.
    pub pressure: Option<Pressure>,
    pub because: Because,
}

/// Kinds of a column's cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cells {
    /// Numbers, NaN where there is none.
    Numbers(Vec<f64>),
    /// Of two states.
    States(Vec<f64>),
    /// Stamps: have they dates, have they times; and how many of them differ.
    Stamps {
        has: [bool; 2],
        distinct: usize,
        rows: usize,
        because: Because,
        /// Their open question.
        problem: Option<String>,
        /// Their times [ns], where they can be read.
        times: Vec<i64>,
    },
    /// Something else.
    Other,
}

impl Cells {
    /// Stamps, as they are written.
    pub fn stamped(texts: &[String]) -> Self {
        let filled: Vec<String> = texts
            .iter()
            .filter(|text| !text.is_empty())
            .cloned()
            .collect();
        let first = filled.first().map_or("", String::as_str);
        let distinct: BTreeSet<&String> = filled.iter().collect();
        let read = stamps::nanoseconds(&filled, stamps::Reading::default());
        Self::Stamps {
            has: stamps::parts(first).unwrap_or_default(),
            distinct: distinct.len(),
            rows: filled.len(),
            because: Because::certain(format!("stamps such as `{first}`")),
            problem: (read.as_ref().err())
                .map(|unread| format!("`{}` needs {}", filled[unread.index], unread.expected)),
            times: read.unwrap_or_default(),
        }
    }
}

/// A column of a log.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Seen {
    /// Its name in the map.
    pub column: Column,
    /// Its name, for people and to be recognised.
    pub name: String,
    /// Of a bag: the joint whose element it is.
    pub joint: Option<String>,
    /// Of a bag: the frames that its messages are of.
    pub frames: Vec<String>,
    pub unit: Option<SaidUnit>,
    pub cells: Cells,
}

impl Seen {
    /// Its numbers, those of states among them.
    pub fn numbers(&self) -> &[f64] {
        match &self.cells {
            Cells::Numbers(numbers) | Cells::States(numbers) => numbers,
            Cells::Stamps { .. } | Cells::Other => &[],
        }
    }

    /// Least and largest number; none where there are none.
    pub fn range(&self) -> Option<[f64; 2]> {
        let there = self.numbers().iter().filter(|value| value.is_finite());
        there.fold(None, |range, value| {
            let [low, high] = range.unwrap_or([*value; 2]);
            Some([low.min(*value), high.max(*value)])
        })
    }
}

/// A key of the map with its value as written, and how sure that is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Line {
    pub key: &'static str,
    pub value: String,
    pub because: Because,
}

/// A log as it was seen.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Looked {
    pub path: PathBuf,
    /// Lines of the map on its form.
    pub head: Vec<Line>,
    pub columns: Vec<Seen>,
    /// Whether the times are those at which messages were logged, not their stamps.
    pub time: TimeSeen,
    /// Keys of its form that cannot be determined, and the question.
    pub asked: Vec<(&'static str, String)>,
    /// What was left out of it and where, a sentence each.
    pub notes: Vec<String>,
    /// Rates that its header says, with the column from which on each holds.
    pub rates: Vec<SaidRate>,
    /// The first field of each column, for people.
    pub samples: Vec<String>,
    /// Units that its line of units names and nobody here knows, by column.
    pub odd_units: Vec<Option<String>>,
    /// Where each of its rows has another variable: those.
    pub variables: Vec<Variable>,
}

/// A rate that a header says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SaidRate {
    /// Column from which on it holds, from 0.
    pub place: usize,
    /// Samples a second [Hz].
    pub rate: f64,
    /// The words that say it.
    pub words: String,
}

/// A variable of a log in which each row has another one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    /// The column that names it.
    pub chooser: Column,
    /// Its name there.
    pub value: String,
    /// Its numbers, named as it is.
    pub column: Seen,
    /// The other columns, at its rows.
    pub columns: Vec<Seen>,
}

/// Where the times are, as far as the form tells.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) enum TimeSeen {
    /// In a column.
    #[default]
    Column,
    /// In the messages: the column, and why that.
    Messages {
        column: &'static str,
        because: Because,
    },
    /// In the properties of waveforms.
    Waveforms,
}

impl Looked {
    /// Whether another log is written in the same way, with the same columns.
    pub fn is_like(&self, other: &Self) -> bool {
        let plain = |log: &Self| -> Vec<(&'static str, String)> {
            let head = log.head.iter();
            // What one log of a kind lacks another may have.
            head.filter(|line| !["missing", "skip_stray_lines"].contains(&line.key))
                .map(|line| (line.key, line.value.clone()))
                .collect()
        };
        let names = |log: &Self| -> Vec<String> {
            let columns = log.columns.iter();
            columns.map(|column| column.name.clone()).collect()
        };
        plain(self) == plain(other) && names(self) == names(other)
    }
}
