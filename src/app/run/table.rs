//! The runs of `--set` side by side: what varies against the numbers that matter most.

use std::path::PathBuf;

use super::settings::{Variant, short};
use crate::document::{Block, Cell, Column, Document, Number, Section, Table, Tone};
use crate::metrics::most_important;
use crate::quantity::display_name::display_name;
use crate::quantity::{column, counted};
use crate::run::RunResult;

/// Numbers beside what varies, at most: more do not fit a terminal.
const MOST: usize = 6;

/// A run that has ended.
pub(super) struct Done {
    /// Its folder.
    pub folder: PathBuf,
    /// What varies.
    pub variant: Variant,
    /// Its summary.json.
    pub result: RunResult,
}

/// The document of all runs.
pub(super) fn document(runs: &[Done]) -> Document<'static> {
    let outside = runs
        .iter()
        .filter(|run| state(&run.result).1 == Some(false))
        .count();
    let (verdict, tone) = match outside {
        0 => (format!("{} done.", counted(runs.len(), "run")), Tone::Plain),
        _ => (
            format!(
                "{outside} of {} stopped early or outside their bounds.",
                counted(runs.len(), "run")
            ),
            Tone::Bad,
        ),
    };
    let mut columns = varied(runs);
    columns.extend(metrics(runs).into_iter().take(MOST));
    let states = runs.iter().map(|run| match state(&run.result) {
        (words, Some(good)) => Cell::Verdict(words.to_owned(), good),
        (words, None) => Cell::from(words),
    });
    columns.push((Column::of_words("bounds"), states.collect()));
    let row = |place: usize| {
        columns
            .iter()
            .map(|(_, cells)| cells[place].clone())
            .collect()
    };
    let rows = (0..runs.len()).map(row).collect();
    let heads = columns.iter().map(|(head, _)| head.clone()).collect();
    Document {
        title: "Runs side by side".to_owned(),
        verdict,
        tone,
        sections: vec![Section::new(
            "Numbers",
            vec![Block::Table(Table::new("", heads, rows))],
        )],
        ..Document::default()
    }
}

/// What of the variants differs, a column a key.
fn varied(runs: &[Done]) -> Vec<(Column, Vec<Cell>)> {
    let Some(first) = runs.first() else {
        return Vec::new();
    };
    let varies = |place: &usize| {
        let value = |run: &Done| run.variant.edits[*place].shown();
        runs.iter().any(|run| value(run) != value(first))
    };
    let places: Vec<usize> = (0..first.variant.edits.len()).filter(varies).collect();
    let keys: Vec<&str> = places
        .iter()
        .map(|place| first.variant.edits[*place].key())
        .collect();
    let column = |place: &usize| {
        let cells = runs
            .iter()
            .map(|run| Cell::from(run.variant.edits[*place].shown()));
        let (name, unit) = display_name(short(first.variant.edits[*place].key(), &keys));
        (Column::of_numbers(headed(&name, &unit)), cells.collect())
    };
    places.iter().map(column).collect()
}

fn metrics(runs: &[Done]) -> Vec<(Column, Vec<Cell>)> {
    let Some(first) = runs.first() else {
        return Vec::new();
    };
    let labels = first.result.metrics();
    let of = |name: &'static str| {
        let (label, _) = labels.iter().find(|(label, _)| label.key == name)?;
        let values: Vec<Option<f64>> = runs.iter().map(|run| run.result.metric(name)).collect();
        values.iter().any(Option::is_some).then_some(())?;
        let cells = column(&values, label.unit).into_iter();
        let cells = cells.map(|text| Number::bare(name, None, label.unit).written(text).into());
        let head = Column::of_numbers(headed(&label.name, label.unit));
        Some((head, cells.collect()))
    };
    let names = most_important(first.result.is_bench());
    names.into_iter().filter_map(of).collect()
}

fn headed(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}

/// What became of its bounds, and whether that is good.
fn state(result: &RunResult) -> (&'static str, Option<bool>) {
    match (&result.stopped, result.is_within_bounds()) {
        (Some(_), _) => ("STOPPED", Some(false)),
        (None, false) => ("OUTSIDE", Some(false)),
        (None, true) if result.expectations.is_empty() => ("none", None),
        (None, true) => ("kept", Some(true)),
    }
}
