//! The runs of `--set` side by side, in a terminal: what varies against the numbers that matter most.

use std::path::PathBuf;

use serde_json::Value;

use super::super::error::ExitCode;
use super::settings::{Variant, short};
use crate::metrics::{labels, most_important};
use crate::quantity::column;
use crate::quantity::display_name::display_name;

/// Columns of a terminal.
const WIDTH: usize = 80;
/// Letters of a heading's line at least, of a value that varies at most.
const NARROW: usize = 9;
const LONGEST: usize = 24;

/// A variant that has been run.
pub(super) struct Done {
    /// Its folder.
    pub folder: PathBuf,
    /// Its values in place of the scenario's, and its name.
    pub variant: Variant,
    /// Content of summary.json.
    pub document: Value,
}

impl Done {
    /// Its exit code.
    pub(super) fn code(&self) -> ExitCode {
        let verdicts = self.document["expectations"].as_array();
        let outside = |verdict: &Value| verdict["kept"] == false;
        if !self.document["stopped"].is_null() {
            ExitCode::Stopped
        } else if verdicts.is_some_and(|verdicts| verdicts.iter().any(outside)) {
            ExitCode::OutsideBounds
        } else {
            ExitCode::Done
        }
    }
}

/// A column: lines of its heading, and its cells.
struct Column {
    heading: Vec<String>,
    cells: Vec<String>,
}

impl Column {
    /// One with this heading, broken into lines.
    fn new(heading: &str, cells: Vec<String>) -> Self {
        let mut lines: Vec<String> = vec![String::new()];
        for word in heading.split(' ') {
            match lines.last_mut() {
                Some(line) if line.is_empty() => word.clone_into(line),
                Some(line) if line.chars().count() + 1 + word.chars().count() <= NARROW => {
                    *line += &format!(" {word}");
                }
                _ => lines.push(word.to_owned()),
            }
        }
        Self {
            heading: lines,
            cells,
        }
    }

    fn width(&self) -> usize {
        let texts = self.heading.iter().chain(&self.cells);
        texts.map(|text| text.chars().count()).max().unwrap_or(0)
    }
}

/// The table.
pub(super) fn table(runs: &[Done]) -> String {
    let mut columns = varied(runs);
    let last = Column::new(
        "bounds",
        runs.iter().map(|run| word(run).to_owned()).collect(),
    );
    let taken = |columns: &[Column]| {
        columns
            .iter()
            .map(|column| column.width() + 2)
            .sum::<usize>()
    };
    for column in metrics(runs) {
        if taken(&columns) + column.width() + 2 + last.width() <= WIDTH {
            columns.push(column);
        }
    }
    columns.push(last);
    let lines = columns.iter().map(|column| column.heading.len()).max();
    let lines = lines.unwrap_or(0);
    let mut text = String::new();
    let mut row = |cell: &dyn Fn(&Column) -> String| {
        let cells = columns.iter().map(|column| {
            let width = column.width();
            format!("{:>width$}", cell(column))
        });
        text += cells.collect::<Vec<_>>().join("  ").trim_end();
        text.push('\n');
    };
    for line in 0..lines {
        // Headings stand on their values.
        row(&|column| {
            let above = lines - column.heading.len();
            let own = line.checked_sub(above);
            own.map_or_else(String::new, |own| column.heading[own].clone())
        });
    }
    for run in 0..runs.len() {
        row(&|column| column.cells[run].clone());
    }
    text
}

/// A column for each key that varies.
fn varied(runs: &[Done]) -> Vec<Column> {
    let Some(first) = runs.first() else {
        return Vec::new();
    };
    let varies = |place: &usize| {
        let value = |run: &Done| run.variant.edits[*place].shown();
        runs.iter().any(|run| value(run) != value(first))
    };
    let places: Vec<usize> = (0..first.variant.edits.len()).filter(varies).collect();
    let key = |place: usize| first.variant.edits[place].key();
    let keys: Vec<&str> = places.iter().map(|place| key(*place)).collect();
    let column = |place: &usize| {
        let cell = |run: &Done| {
            let value = run.variant.edits[*place].shown();
            // The end of a path is what tells it from others.
            let beyond = value.chars().count().saturating_sub(LONGEST);
            match beyond {
                0 => value,
                _ => format!("..{}", value.chars().skip(beyond + 2).collect::<String>()),
            }
        };
        let cells = runs.iter().map(cell).collect();
        let (name, unit) = display_name(short(key(*place), &keys));
        match unit.as_str() {
            "" => Column::new(&name, cells),
            unit => Column::new(&format!("{name} [{unit}]"), cells),
        }
    };
    places.iter().map(column).collect()
}

/// A column for each number that a run determines.
fn metrics(runs: &[Done]) -> Vec<Column> {
    let bench = runs.iter().any(|run| run.document["kind"] == "bench");
    let labels = labels(bench);
    let heading = |name: &str| {
        let label = labels.iter().find(|label| label.key == name)?;
        // A heading of two lines, as the others.
        let name = label.name.replace("coefficient of variation", "variation");
        let unit = if label.unit.is_empty() {
            "1"
        } else {
            label.unit
        };
        Some((format!("{name} [{unit}]"), unit))
    };
    let of = |name: &str| {
        let value = |run: &Done| run.document["summary"][name].as_f64();
        let values: Vec<Option<f64>> = runs.iter().map(value).collect();
        values.iter().any(Option::is_some).then_some(())?;
        let (heading, unit) = heading(name)?;
        Some(Column::new(&heading, column(&values, unit)))
    };
    most_important(bench).into_iter().filter_map(of).collect()
}

fn word(run: &Done) -> &'static str {
    let bounded = run.document["expectations"].as_array();
    match run.code() {
        ExitCode::Stopped => "STOPPED",
        ExitCode::OutsideBounds => "OUTSIDE",
        _ if bounded.is_none_or(Vec::is_empty) => "none",
        _ => "kept",
    }
}

/// Reason of a stop, or results outside their bounds, as one run says it.
pub(super) fn outside(document: &Value) -> Vec<String> {
    if let Some(stop) = document["stopped"].as_str() {
        return vec![format!("stopped: {stop}")];
    }
    let verdicts = document["expectations"].as_array().into_iter().flatten();
    verdicts
        .filter(|verdict| verdict["kept"] == false)
        .map(|verdict| {
            let number = |key: &str| verdict[key].as_f64();
            let metric = verdict["metric"].as_str().unwrap_or_default();
            let pass = verdict["pass"].as_u64();
            let pass = pass.map_or(String::new(), |pass| format!("pass {pass}: "));
            let metric = format!("{pass}{metric}");
            super::job::sentence(&metric, number("value"), [number("min"), number("max")])
        })
        .collect()
}
