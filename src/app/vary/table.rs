//! runs.parquet: a row for each run, in the order of the plan, whoever did them.

use std::collections::BTreeMap;
use std::path::Path;

use super::super::error::AppError;
use super::super::run::Numbers;
use super::work::Shared;
use crate::metrics::metric_names;
use crate::recording::RecordingError;
use crate::recording::long_column::LongColumn;
use crate::recording::long_table::{read_columns, write_groups};
use crate::tasks::{Plan, Store};

/// The table.
pub(in super::super) const RUNS: &str = "runs.parquet";
/// What it says.
pub(in super::super) const SWEEP: &str = "vary.json";
/// Columns before the keys, and whether they hold names.
const OWN: [(&str, bool); 4] = [
    ("run", false),
    ("id", true),
    ("code", false),
    ("reason", true),
];

/// Columns of a table of runs, and whether they hold names: its own, a key each, a number each.
pub(super) fn layout<'a>(
    own: &[(&'a str, bool)],
    keys: impl Iterator<Item = (&'a str, bool)>,
    is_bench: bool,
) -> Vec<(&'a str, bool)> {
    let numbers = metric_names(is_bench).into_iter().map(|name| (name, false));
    own.iter().copied().chain(keys).chain(numbers).collect()
}

/// Columns without a row.
pub(super) fn empty(layout: &[(&str, bool)]) -> Vec<LongColumn> {
    let column = |(_, names): &(&str, bool)| match names {
        true => LongColumn::Names(Vec::new()),
        false => LongColumn::Numbers(Vec::new()),
    };
    layout.iter().map(column).collect()
}

/// Adds a run: what stands before its numbers as text, and these.
pub(super) fn add(
    columns: &mut [LongColumn],
    texts: impl Iterator<Item = String>,
    metrics: &[Option<f64>],
) {
    let mut places = columns.iter_mut();
    for (text, column) in texts.zip(&mut places) {
        match column {
            LongColumn::Names(names) => names.push(text),
            LongColumn::Numbers(numbers) => numbers.push(text.parse().unwrap_or(f64::NAN)),
        }
    }
    for (at, column) in places.enumerate() {
        let value = metrics.get(at).copied().flatten();
        if let LongColumn::Numbers(numbers) = column {
            numbers.push(value.unwrap_or(f64::NAN));
        }
    }
}
/// Runs of a group: what is held at a time.
const GROUP: usize = 4096;

/// Columns of a table by their names.
pub(in super::super) fn columns(
    table: &Path,
    wanted: &[&str],
) -> Result<BTreeMap<String, LongColumn>, RecordingError> {
    let read = read_columns(table, |name| wanted.contains(&name))?;
    Ok(read.into_iter().collect())
}

/// Writes the table of a plan of which all runs stand.
pub(super) fn write_table(plan: &Path, is_bench: bool, table: &Path) -> Result<(), AppError> {
    let texts = texts(plan)?;
    let opened = Plan::open(plan)?;
    let shared: Shared = serde_json::from_value(opened.head.work.clone())?;
    let store = Store::of(plan);
    let keys = shared.keys.iter().map(String::as_str);
    let columns = layout(&OWN, keys.zip(texts.iter().copied()), is_bench);
    let mut tasks = opened;
    let mut run = 0;
    write_groups(table, &columns, || {
        let mut group = empty(&columns);
        let mut rows = 0;
        while rows < GROUP
            && let Some(task) = tasks.next()
        {
            let task = task?;
            run += 1;
            rows += 1;
            let values: Vec<String> = serde_json::from_value(task.work)?;
            let result: Numbers = store.read(&task.id)?;
            let own = [
                run.to_string(),
                task.id,
                result.code.to_string(),
                result.reason,
            ];
            add(&mut group, own.into_iter().chain(values), &result.metrics);
        }
        Ok((rows > 0).then_some(group))
    })
}

/// Which of the keys have values that are no numbers.
fn texts(plan: &Path) -> Result<Vec<bool>, AppError> {
    let mut found: Vec<bool> = Vec::new();
    for task in Plan::open(plan)? {
        let values: Vec<String> = serde_json::from_value(task?.work)?;
        found.resize(values.len(), false);
        for (text, value) in found.iter_mut().zip(&values) {
            *text |= value.parse::<f64>().is_err();
        }
    }
    Ok(found)
}
