//! A map drafted by looking at logs: how they are written, what their columns are and in what units, each with how sure it is and why. What cannot be told
//! is asked for in a comment.
//!
//! ```text
//! logs -> layout and columns (`text`, `forms`) -> quantities (`names`, `assign`) and units (`units`) -> map (`write`)
//! ```

use std::path::{Path, PathBuf};

use super::error::ImportError;
use super::map::{Column, Pressure};
use super::units::LogUnit;

mod assign;
mod forms;
mod marks;
mod names;
mod text;
mod time;
mod units;
mod write;

/// A map's text with what is left to be told by its owner.
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
struct Because {
    is_certain: bool,
    why: String,
}

impl Because {
    fn certain(why: impl Into<String>) -> Self {
        Self {
            is_certain: true,
            why: why.into(),
        }
    }

    fn likely(why: impl Into<String>) -> Self {
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
struct SaidUnit {
    unit: &'static LogUnit,
    /// Against what, where it says that of a pressure.
    pressure: Option<Pressure>,
    because: Because,
}

/// Kinds of a column's cells.
#[derive(Debug, Clone, PartialEq)]
enum Cells {
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
    },
    /// Something else.
    Other,
}

/// A column of a log.
#[derive(Debug, Clone, PartialEq)]
struct Seen {
    /// Its name in the map.
    column: Column,
    /// Its name, for people and to be recognised.
    name: String,
    /// Of a bag: the joint whose element it is.
    joint: Option<String>,
    /// Of a bag: the frames that its messages are of.
    frames: Vec<String>,
    unit: Option<SaidUnit>,
    cells: Cells,
}

impl Seen {
    /// Its numbers, those of states among them.
    fn numbers(&self) -> &[f64] {
        match &self.cells {
            Cells::Numbers(numbers) | Cells::States(numbers) => numbers,
            Cells::Stamps { .. } | Cells::Other => &[],
        }
    }

    /// Least and largest number; none where there are none.
    fn range(&self) -> Option<[f64; 2]> {
        let there = self.numbers().iter().filter(|value| value.is_finite());
        there.fold(None, |range, value| {
            let [low, high] = range.unwrap_or([*value; 2]);
            Some([low.min(*value), high.max(*value)])
        })
    }
}

/// A key of the map with its value as written, and how sure that is.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Line {
    key: &'static str,
    value: String,
    because: Because,
}

/// A log as it was seen.
#[derive(Debug, Clone, PartialEq)]
struct Looked {
    path: PathBuf,
    /// Lines of the map on its form.
    head: Vec<Line>,
    columns: Vec<Seen>,
    /// Whether the times are those at which messages were logged, not their stamps.
    time: TimeSeen,
}

/// Where the times are, as far as the form tells.
#[derive(Debug, Clone, PartialEq, Eq)]
enum TimeSeen {
    /// In a column.
    Column,
    /// In the messages: all of them have a stamp, or when they were logged.
    Messages { stamped: bool },
}

impl Looked {
    /// Whether another log is written in the same way, with the same columns.
    fn is_like(&self, other: &Self) -> bool {
        let plain = |log: &Self| -> Vec<(&'static str, String)> {
            let head = log.head.iter();
            head.map(|line| (line.key, line.value.clone())).collect()
        };
        let names = |log: &Self| -> Vec<String> {
            let columns = log.columns.iter();
            columns.map(|column| column.name.clone()).collect()
        };
        plain(self) == plain(other) && names(self) == names(other)
    }
}

/// Drafts a map for logs. Those that are alike make a recording each; those that are not are taken to be parts of one.
///
/// # Errors
/// A log that cannot be read, whose encoding cannot be told, or whose numbers mix decimal marks.
pub fn draft(title: &str, paths: &[PathBuf]) -> Result<Draft, ImportError> {
    let mut kinds: Vec<(Looked, Vec<PathBuf>)> = Vec::new();
    for path in paths {
        let looked = look(path)?;
        match kinds.iter_mut().find(|(kind, _)| kind.is_like(&looked)) {
            Some((kind, alike)) => {
                alike.push(path.clone());
                for (own, more) in kind.columns.iter_mut().zip(&looked.columns) {
                    // Ranges are those of all; the first log's rows stand first. A column may be empty in one of them.
                    match &mut own.cells {
                        Cells::Numbers(numbers) | Cells::States(numbers) => {
                            numbers.extend_from_slice(more.numbers());
                        }
                        Cells::Other => own.cells = more.cells.clone(),
                        Cells::Stamps { .. } => {}
                    }
                }
            }
            None => kinds.push((looked, vec![path.clone()])),
        }
    }
    Ok(write::draft(title, &kinds))
}

fn look(path: &Path) -> Result<Looked, ImportError> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    match ending.to_lowercase().as_str() {
        "parquet" => forms::parquet(path),
        "mat" => forms::mat(path),
        "mcap" | "db3" => forms::bag(path),
        _ if path.is_dir() => forms::bag(path),
        _ => text::look(path),
    }
}
