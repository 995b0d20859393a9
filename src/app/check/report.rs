//! Report on a file: facts by name, numbers for programs, the files that it needs and what to do next.

use std::path::{Component, Path, PathBuf};

use serde::Serialize;

use super::AppError;
use crate::device::DeviceParameters;
use crate::document::{Block, Cell, Column, Document, Section, Style, Table, printable, text};
use crate::scenario::Expectation;

/// An explanation.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    /// The file, or folder.
    file: PathBuf,
    /// Its kind.
    kind: &'static str,
    /// Its title, where it has one.
    title: Option<String>,
    /// Facts by label, one sentence or less each.
    facts: Vec<(&'static str, String)>,
    /// Facts for programs, units in the names.
    numbers: serde_json::Map<String, serde_json::Value>,
    /// Files that it refers to.
    files: Vec<FileNote>,
    /// How a cell's tool stands across its edge, as SVG.
    pub(super) drawing: Option<String>,
    /// Tables for people; their numbers stand among the others.
    #[serde(skip)]
    tables: Vec<Table>,
    /// Notes on what a user may not expect.
    notes: Vec<String>,
    /// Next step for the user.
    next: String,
}

/// A file that another refers to.
#[derive(Debug, Serialize)]
struct FileNote {
    what: String,
    path: PathBuf,
    there: bool,
}

impl Report {
    pub(super) fn new(file: &Path, kind: &'static str, title: Option<&str>) -> Self {
        Self {
            file: file.to_owned(),
            kind,
            title: title.map(str::to_owned),
            facts: Vec::new(),
            numbers: serde_json::Map::new(),
            files: Vec::new(),
            drawing: None,
            tables: Vec::new(),
            notes: Vec::new(),
            next: String::new(),
        }
    }

    pub(super) fn fact(&mut self, label: &'static str, text: impl Into<String>) {
        self.facts.push((label, text.into()));
    }

    pub(super) fn number(&mut self, name: &str, value: impl Into<serde_json::Value>) {
        self.numbers.insert(name.to_owned(), value.into());
    }

    pub(super) fn file(&mut self, what: impl Into<String>, path: &Path) {
        self.files.push(FileNote {
            what: what.into(),
            path: without_detours(path),
            there: path.exists(),
        });
    }

    pub(super) fn table(&mut self, table: Table) {
        self.tables.push(table);
    }

    pub(super) fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }

    pub(super) fn next(&mut self, command: impl Into<String>) {
        self.next = command.into();
    }

    /// Bounds on its results.
    pub(super) fn bounds(&mut self, bounds: &[Expectation]) {
        let one = |bound: &Expectation| {
            let side = |word: &str, value: Option<f64>| Some(format!("{word} {}", value?));
            let sides = [side("at least", bound.min), side("at most", bound.max)];
            let sides: Vec<String> = sides.into_iter().flatten().collect();
            format!("{} {}", bound.metric, sides.join(" and "))
        };
        for bound in bounds {
            self.fact("expected", one(bound));
        }
    }

    /// Amount simulated and written.
    pub(super) fn extent(&mut self, duration: f64, step: f64, samples: f64, bytes_per_sample: f64) {
        let bytes = samples * bytes_per_sample;
        let text = format!(
            "{duration:.1} s in steps of {} ms: {samples} samples, about {} of files",
            shown(step * 1e3),
            size(bytes)
        );
        self.fact("time", text);
        self.number("duration_s", duration);
        self.number("step_s", step);
        self.number("samples", samples);
        self.number("estimated_bytes", bytes.round());
    }

    /// The device's main numbers.
    pub(super) fn device(&mut self, device: &DeviceParameters) {
        let millimetres = |metres: f64| shown(metres * 1e3);
        let text = format!(
            "{} x bore {} mm, rod {} mm, stroke {} mm; moving mass {} kg",
            device.cylinder_count,
            millimetres(device.bore),
            millimetres(device.rod),
            millimetres(device.full_stroke),
            shown(device.moving_mass),
        );
        self.fact("device", text);
    }

    /// For people; the label of several facts stands beside the first.
    pub(super) fn text(&self) -> String {
        let title = self.title.iter().map(|title| ("title", title.clone()));
        let files = self.files.iter().map(|file| {
            let absent = if file.there { "" } else { ", NOT THERE" };
            (
                "files",
                format!("{} ({}){absent}", file.path.display(), file.what),
            )
        });
        let mut last = "";
        let facts = title.chain(self.facts.iter().cloned()).chain(files);
        let rows = facts.map(|(label, said)| {
            let shown = if label == last { "" } else { label };
            last = label;
            vec![Cell::from(shown), Cell::from(said)]
        });
        let table = Table::new("", vec![Column::default(); 2], rows.collect());
        let notes = self.notes.iter().map(|note| format!("note: {note}"));
        let blocks = std::iter::once(Block::Table(table));
        let blocks = blocks.chain(self.tables.iter().cloned().map(Block::Table));
        let blocks = blocks.chain(notes.map(Block::Paragraph));
        let document = Document {
            title: format!("{}: {}", self.file.display(), self.kind),
            sections: vec![Section::new("", blocks.collect())],
            ..Document::default()
        };
        // A command is to be copied whole.
        text(&document, Style::Plain) + &format!("next: {}\n", printable(&self.next))
    }

    /// For programs.
    pub(super) fn json(&self) -> Result<String, AppError> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

/// A path without the folders that it goes into and out of again.
fn without_detours(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        let up = part == Component::ParentDir;
        match plain.components().next_back() {
            Some(Component::Normal(_)) if up => drop(plain.pop()),
            _ => plain.push(part),
        }
    }
    plain
}

/// A number without what rounding adds to it.
pub(super) fn shown(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// A count of bytes.
pub(super) fn size(bytes: f64) -> String {
    match bytes {
        bytes if bytes < 1e6 => format!("{:.0} kB", (bytes / 1e3).max(1.0)),
        bytes if bytes < 1e9 => format!("{:.1} MB", bytes / 1e6),
        bytes => format!("{:.1} GB", bytes / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_shown_without_detours() {
        for (path, shown) in [
            ("scenarios/../models/device.toml", "models/device.toml"),
            ("../a/./b/../c.stl", "../a/c.stl"),
            ("../../x", "../../x"),
            ("/a/b", "/a/b"),
        ] {
            assert_eq!(without_detours(Path::new(path)), Path::new(shown), "{path}");
        }
    }
}
