//! scenarios/README.md is the reference of all keys, so it is held against what the program does.

use std::collections::BTreeMap;

use toml::{Table, Value};

use super::super::sections::{model_sections, scenario_sections};
use super::super::units::Unit;
use super::{MINIMAL, read, scenarios};

/// A line of the README's tables of keys.
struct Row {
    unit: String,
    default: String,
    range: String,
}

fn rows() -> BTreeMap<String, Row> {
    let text = std::fs::read_to_string(scenarios().join("README.md")).unwrap();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let key = cells.get(1)?.strip_prefix('`')?.strip_suffix('`')?;
        let cell = |index: usize| cells[index].to_owned();
        assert_eq!(cells.len(), 7, "{line}");
        let (unit, default, range) = (cell(2), cell(3), cell(4));
        Some((
            key.to_owned(),
            Row {
                unit,
                default,
                range,
            },
        ))
    };
    let found: Vec<_> = text.lines().filter_map(row).collect();
    let count = found.len();
    let rows: BTreeMap<_, _> = found.into_iter().collect();
    assert_eq!(rows.len(), count, "a key stands twice");
    rows
}

/// The minimal scenario with what a key needs beside it, and the key itself if it is needed there.
fn base(key: &str) -> Table {
    let beside = match key {
        "workpiece.burr.height_mm" | "workpiece.burr.position_mm" | "workpiece.burr.width_mm" => {
            "[workpiece.burr]\nkind = 'bump'\nposition_mm = 1\nheight_mm = 1\nwidth_mm = 1"
        }
        "workpiece.burr.path" => "[workpiece.burr]\nkind = 'table'\npath = 'README.md'",
        _ if key.starts_with("workpiece.burr.") => {
            "[workpiece.burr]\nkind = 'random'\nmean_height_mm = 1\ncorrelation_length_mm = 1"
        }
        "arm.limit_overrides.effort_n_m" => {
            "[[arm.limit_overrides]]\njoint = 'a'\nvelocity_deg_per_s = 90"
        }
        _ if key.starts_with("arm.limit_overrides.") => {
            "[[arm.limit_overrides]]\njoint = 'a'\neffort_n_m = 9"
        }
        _ => "",
    };
    format!("{MINIMAL}{beside}\n").parse().unwrap()
}

/// The table that holds a key, and its name there.
fn slot<'a>(mut table: &'a mut Table, key: &'a str) -> (&'a mut Table, &'a str) {
    let mut parts: Vec<&str> = key.split('.').collect();
    let name = parts.pop().unwrap();
    for part in parts {
        let value = table.entry(part).or_insert(Value::Table(Table::new()));
        table = match value {
            Value::Array(elements) => elements[0].as_table_mut().unwrap(),
            value => value.as_table_mut().unwrap(),
        };
    }
    (table, name)
}

/// What comes of a key with a value: the scenario, or the message.
fn outcome(key: &str, value: Option<Value>) -> Result<String, String> {
    let mut table = base(key);
    let (holder, name) = slot(&mut table, key);
    match value {
        Some(value) => drop(holder.insert(name.to_owned(), value)),
        None => drop(holder.remove(name)),
    }
    let text = toml::to_string(&table).unwrap();
    match read(&text) {
        Ok(scenario) => Ok(format!("{scenario:?}")),
        Err(error) => Err(error.to_string()),
    }
}

#[test]
fn every_key_has_its_row_and_every_row_its_key() {
    let mut sections = scenario_sections();
    // The tables' own names are keys of the tables around them.
    let tables: Vec<&str> = sections.iter().map(|(table, _)| *table).collect();
    sections.retain(|(_, keys)| !keys.is_empty());
    assert_eq!(
        sections.len(),
        tables.len(),
        "a table without keys was not read off its type"
    );
    let mut keys: Vec<String> = sections
        .iter()
        .flat_map(|(table, keys)| {
            keys.iter()
                .map(|key| super::super::document::join(table, key))
        })
        .filter(|key| !tables.contains(&key.as_str()) && !key.starts_with("expect"))
        .collect();
    keys.sort();
    let documented: Vec<String> = rows().into_keys().collect();
    assert_eq!(documented, keys);
    // A model file has the keys of [device.override].
    let find = |sections: &[(&str, &'static [&'static str])], table: &str| {
        sections.iter().find(|(name, _)| *name == table).unwrap().1
    };
    let of_model = find(&model_sections(), "device");
    assert_eq!(of_model, find(&scenario_sections(), "device.override"));
}

#[test]
fn every_unit_is_that_of_the_key() {
    for (key, row) in rows() {
        let unit = Unit::of_key(&key);
        if !unit.is_one() {
            assert_eq!(row.unit.split(',').next().unwrap(), unit.symbol, "{key}");
        }
    }
}

#[test]
fn every_default_is_what_leaving_the_key_out_does() {
    let (mut defaults, mut required) = (0, 0);
    for (key, row) in rows() {
        if row.default.starts_with("one of") {
            continue;
        }
        let without = outcome(&key, None);
        if row.default == "required" {
            let message = without.expect_err(&key);
            assert!(message.contains("is missing"), "{key}: {message}");
            required += 1;
            continue;
        }
        let without = without.unwrap_or_else(|error| panic!("{key}: {error}"));
        if let Ok(mut table) = format!("v = {}", row.default).parse::<Table>() {
            assert_eq!(outcome(&key, table.remove("v")), Ok(without), "{key}");
            defaults += 1;
        } else {
            let worded = row.default == "none"
                || row.default.contains("half")
                || row.default.contains("third");
            assert!(worded, "{key}: {}", row.default);
        }
    }
    assert!(
        defaults > 50 && required > 15,
        "{defaults} defaults, {required} required"
    );
}

#[test]
fn every_range_is_kept_and_named_as_in_the_readme() {
    let mut ranges = 0;
    for (key, row) in rows() {
        let (low, high): (f64, f64) = match (
            row.range.split_once(" to "),
            row.range.strip_prefix("at least "),
        ) {
            (Some((low, high)), _) => (low.parse().unwrap(), high.parse().unwrap()),
            (_, Some(low)) => (low.parse().unwrap(), f64::INFINITY),
            _ => continue,
        };
        let whole = row.unit == "whole number";
        let outcome = |number: f64| {
            let value = if whole {
                Value::Integer(number as i64)
            } else {
                Value::Float(number)
            };
            let zero = Value::Float(0.0);
            let list = row.unit.contains("list");
            outcome(
                &key,
                Some(if list {
                    Value::Array(vec![value, zero.clone(), zero])
                } else {
                    value
                }),
            )
        };
        let words = format!("expected {}", row.range);
        let refused = |number: f64| outcome(number).is_err_and(|message| message.contains(&words));
        let step = if whole {
            1.0
        } else {
            1e-9 * low.abs().max(1.0)
        };
        assert!(
            refused(low - step),
            "{key} below {low}: {:?}",
            outcome(low - step)
        );
        // Another key may object to an end of the range; the range may not.
        assert!(!refused(low) && !refused(high), "{key} at an end");
        if high.is_finite() {
            let step = if whole {
                1.0
            } else {
                1e-9 * high.abs().max(1.0)
            };
            assert!(
                refused(high + step),
                "{key} above {high}: {:?}",
                outcome(high + step)
            );
        }
        ranges += 1;
    }
    assert!(ranges > 55, "{ranges} ranges");
}
