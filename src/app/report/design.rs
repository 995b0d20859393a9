//! The page of a design study.

use serde_json::Value;

use crate::diagnosis::words::{capital, figures, spoken};
use crate::page::{Block, Cell, Fact, Page, Section, Table, Tone};

/// The page.
pub(super) fn page<'a>(document: &Value, front: Option<&str>) -> Page<'a> {
    let objectives = &document["objectives"];
    let minimised = objectives["minimised"].as_str().unwrap_or_default();
    let (words, unit, factor) = spoken(minimised);
    let of = |candidate: &Value| candidate["minimised"].as_f64().map(|v| factor * v);
    let ends = [of(&document["start"]), of(&document["chosen"])];
    let verdict = match ends {
        [Some(start), Some(chosen)] => format!(
            "{} falls from {} to {} {unit}.",
            capital(&words),
            figures(start, 3),
            figures(chosen, 3)
        ),
        _ => "Studied.".to_owned(),
    };
    let mut sections = Vec::new();
    if let Some(svg) = front {
        sections.push(Section::new(
            "Trade-off",
            vec![Block::Picture(bare(svg).to_owned())],
        ));
    }
    sections.push(Section::new("All numbers", all(document)));
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

/// An SVG document without what stands before its first element.
fn bare(svg: &str) -> &str {
    &svg[svg.find("<svg").unwrap_or(0)..]
}

/// Each entry of the document as a table of its own.
fn all<'a>(document: &Value) -> Vec<Block<'a>> {
    let entries = document.as_object().into_iter().flatten();
    entries
        .filter(|(_, value)| value.is_object() || value.is_array())
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
