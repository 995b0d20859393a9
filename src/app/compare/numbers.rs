//! Numbers side by side, and as a table for a terminal.

use std::fmt::Write as _;
use std::path::Path;

use super::super::report::{ROLES, RunResult};
use crate::quantity::{change, optional, significant};

/// Folders at most: as many as there are colours.
pub(super) const MOST: usize = ROLES.len();

/// Numbers side by side: name, unit, key, and one value per folder.
pub(super) struct Row {
    pub name: String,
    pub unit: String,
    pub key: String,
    pub factor: f64,
    pub values: Vec<Option<f64>>,
}

/// Quantities compared.
pub(super) struct Compared {
    pub names: Vec<String>,
    /// A sentence per folder.
    pub verdicts: Vec<String>,
    pub rows: Vec<Row>,
    /// Runs whose signals are drawn, by their places.
    pub drawn: Vec<(usize, RunResult<'static>)>,
}

impl Row {
    pub fn shown(&self, place: usize) -> String {
        optional(self.values[place].map(|v| self.factor * v), &self.unit)
    }

    /// Change against the first; none where either is absent, or the first is nothing.
    pub fn change(&self, place: usize) -> Option<String> {
        let (first, own) = (self.values[0]?, self.values[place]?);
        let share = 100.0 * (own - first) / first.abs();
        match share {
            _ if own == first => Some("=".to_owned()),
            share if !share.is_finite() => None,
            share if share.abs() >= 1000.0 => Some(format!("x{}", significant(own / first, 2))),
            share => Some(change(share)),
        }
    }
}

/// They for a terminal.
pub(super) fn text(compared: &Compared) -> String {
    let mut text = String::new();
    // Writing into a text cannot fail.
    for (name, verdict) in compared.names.iter().zip(&compared.verdicts) {
        let _ = writeln!(text, "{name}: {verdict}");
    }
    text.push('\n');
    let mut table: Vec<Vec<String>> = vec![vec![String::new()]];
    table[0].extend(short(&compared.names));
    for row in &compared.rows {
        let unit = match row.unit.is_empty() {
            true => String::new(),
            false => format!(" [{}]", row.unit),
        };
        let mut cells = vec![format!("{}{unit}", row.name), row.shown(0)];
        cells.extend((1..row.values.len()).map(|place| match row.change(place) {
            Some(change) => format!("{} ({change})", row.shown(place)),
            None => row.shown(place),
        }));
        table.push(cells);
    }
    let count = compared.names.len() + 1;
    let width = |column: usize| {
        let cells = table.iter().map(|cells| cells[column].chars().count());
        cells.max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    for cells in &table {
        let _ = write!(text, "{:<1$}", cells[0], widths[0]);
        for (cell, width) in cells.iter().zip(&widths).skip(1) {
            let _ = write!(text, "  {cell:>width$}");
        }
        text.push('\n');
    }
    text
}

/// The ends of folders' paths by which they are distinguished: their last parts, or as many more as it takes.
pub(super) fn short(names: &[String]) -> Vec<String> {
    let parts = |name: &String| -> Vec<String> {
        let parts = Path::new(name).components();
        let parts = parts.map(|part| part.as_os_str().display().to_string());
        parts.collect()
    };
    let parts: Vec<Vec<String>> = names.iter().map(parts).collect();
    let most = parts.iter().map(Vec::len).max().unwrap_or(1);
    let ends = |count: usize| -> Vec<String> {
        let end = |parts: &Vec<String>| parts[parts.len().saturating_sub(count)..].join("/");
        parts.iter().map(end).collect()
    };
    let differ = |count: &usize| {
        let mut ends = ends(*count);
        ends.sort();
        ends.dedup();
        ends.len() == names.len()
    };
    // The same folder twice is called the same.
    ends((1..=most).find(differ).unwrap_or(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_called_by_the_ends_that_differ() {
        let called = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            short(&names)
        };
        assert_eq!(called(&["runs/step", "runs/push/"]), ["step", "push"]);
        let both = ["runs/mine/found", "runs/yours/found"];
        assert_eq!(called(&both), ["mine/found", "yours/found"]);
        assert_eq!(called(&["a", "a"]), ["a", "a"]);
        assert_eq!(called(&["found", "other/found"]), ["found", "other/found"]);
    }
}
