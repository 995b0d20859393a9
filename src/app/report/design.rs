//! The page of a design study.

use serde_json::Value;

use super::provenance_of;
use super::run::labels;
use crate::diagnosis::words::{capital, figures};
use crate::page::{Block, Cell, Fact, Page, Section, Table, Tone};

/// The page.
pub(super) fn page<'a>(document: &Value, front: Option<&str>) -> Page<'a> {
    let verdict = verdict(document);
    let mut sections = Vec::new();
    if let Some(svg) = front {
        sections.push(Section::new(
            "Trade-off",
            vec![Block::Picture(bare(svg).to_owned())],
        ));
    }
    sections.push(Section::new("All numbers", all(document)));
    sections.push(provenance_of(document));
    Page {
        title: document["title"].as_str().unwrap_or("A study").to_owned(),
        verdict,
        tone: Tone::Found,
        facts: vec![Fact {
            name: "designs evaluated".to_owned(),
            value: document["evaluations"].to_string(),
            remark: format!("seed {}", document["seed"]),
        }],
        sections,
        footer: "Made by idc. override.toml beside this page holds the chosen design; a scenario takes it.".to_owned(),
        ..Page::default()
    }
}

/// What the study did for what it minimised.
fn verdict(document: &Value) -> String {
    let minimised = document["objectives"]["minimised"].as_str();
    let minimised = minimised.unwrap_or_default();
    let mut known = labels(true).into_iter().chain(labels(false));
    let (name, unit) = known
        .find(|label| label.key == minimised)
        .map_or((minimised.replace('_', " "), ""), |label| {
            (label.name, label.unit)
        });
    // design.json is in the units of its keys.
    let of = |candidate: &str| document[candidate]["objective"].as_f64();
    let [Some(start), Some(chosen)] = ["start", "chosen"].map(of) else {
        return "Studied.".to_owned();
    };
    let [from, to] = [start, chosen].map(|value| format!("{} {unit}", figures(value, 3)));
    let name = capital(&name);
    if document["start"]["feasible"] == false {
        return format!(
            "{name}: {} in a design that keeps all limits, which the start, at {}, does not.",
            to.trim(),
            from.trim()
        );
    }
    match chosen < start {
        true => format!("{name} falls from {} to {}.", from.trim(), to.trim()),
        false => format!("{name} stays at {}: no better design was found.", to.trim()),
    }
}

/// An SVG document without what stands before its first element.
fn bare(svg: &str) -> &str {
    &svg[svg.find("<svg").unwrap_or(0)..]
}

/// Each entry of the document as a table of its own.
fn all<'a>(document: &Value) -> Vec<Block<'a>> {
    let entries = document.as_object().into_iter().flatten();
    entries
        .filter(|(key, value)| (value.is_object() || value.is_array()) && *key != "provenance")
        .flat_map(|(key, value)| table(&key.replace('_', " "), value))
        .collect()
}

fn table<'a>(caption: &str, value: &Value) -> Option<Block<'a>> {
    let rows: Vec<(String, &Value)> = leaves("", value);
    let rows = rows.into_iter().map(|(key, value)| {
        let number = value.as_f64().map(|v| figures(v, 5));
        let text = value.as_str().map(str::to_owned);
        let shown = number.or(text).unwrap_or_else(|| value.to_string());
        vec![Cell::from(key), Cell::from(shown)]
    });
    let rows: Vec<Vec<Cell>> = rows.collect();
    let table = Table::new(&capital(caption), &["key", "#value"], rows);
    (!table.rows.is_empty()).then_some(Block::Table(table))
}

/// What is no table or list, with the way to it.
fn leaves<'v>(way: &str, value: &'v Value) -> Vec<(String, &'v Value)> {
    let on = |key: &str| match way.is_empty() {
        true => key.to_owned(),
        false => format!("{way}.{key}"),
    };
    match value {
        Value::Object(entries) => entries
            .iter()
            .flat_map(|(key, value)| leaves(&on(key), value))
            .collect(),
        Value::Array(values) => (values.iter().enumerate())
            .flat_map(|(i, value)| leaves(&on(&(i + 1).to_string()), value))
            .collect(),
        _ => vec![(way.to_owned(), value)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_verdict_tells_what_the_study_did_in_its_unit() {
        let study = |start: f64, chosen: f64, feasible: bool| {
            verdict(&json!({
                "objectives": {"minimised": "coefficient_of_variation_percent"},
                "start": {"objective": start, "feasible": feasible},
                "chosen": {"objective": chosen, "feasible": true},
            }))
        };
        assert_eq!(
            study(4.761, 3.662, true),
            "Coefficient of variation falls from 4.76 % to 3.66 %."
        );
        assert_eq!(
            study(3.0, 3.0, true),
            "Coefficient of variation stays at 3.00 %: no better design was found."
        );
        assert_eq!(
            study(3.0, 4.0, false),
            "Coefficient of variation: 4.00 % in a design that keeps all limits, which the start, at 3.00 %, does not."
        );
    }
}
