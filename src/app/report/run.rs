//! The page of a run: of a cell or of a bench.

use std::borrow::Cow;

use serde_json::Value;

use super::provenance;
use super::signals::{along_the_path, joints, signals};
use crate::diagnosis::words::figures;
use crate::metrics::{BENCH_METRICS, METRICS};
use crate::page::{Block, Cell, Fact, Page, Section, Table, Tone};
use crate::recording::Recording;

/// A run as its folder has it.
pub(in super::super) struct RunResult<'a> {
    /// summary.json.
    pub document: Value,
    /// samples.parquet.
    pub recording: Cow<'a, Recording>,
}

/// Name for people, unit and meaning of a metric, by its key in summary.json.
pub(in super::super) fn labels(key: &str) -> Option<(&'static str, &'static str, &'static str)> {
    let cell = METRICS.iter().map(|m| (m.name, m.label, m.unit, m.meaning));
    let bench = BENCH_METRICS
        .iter()
        .map(|m| (m.name, m.label, m.unit, m.meaning));
    let mut own = cell.chain(bench).filter(|(name, ..)| *name == key);
    own.next()
        .map(|(_, label, unit, meaning)| (label, unit, meaning))
}

impl RunResult<'_> {
    /// Its title.
    pub(in super::super) fn title(&self) -> &str {
        self.document["title"].as_str().unwrap_or("a run")
    }

    /// Its metrics in the order of summary.json: key and value.
    pub(in super::super) fn metrics(&self) -> Vec<(&str, Option<f64>)> {
        let summary = self.document["summary"].as_object();
        let known = summary.into_iter().flatten();
        let known = known.filter(|(key, _)| labels(key).is_some());
        known
            .map(|(key, value)| (key.as_str(), value.as_f64()))
            .collect()
    }

    fn metric(&self, key: &str) -> Option<f64> {
        self.document["summary"][key].as_f64()
    }
}

/// The page.
pub(super) fn page<'a>(run: &'a RunResult<'_>) -> Page<'a> {
    let (verdict, tone) = verdict(run);
    let notes = run.document["notes"].as_array().into_iter().flatten();
    let notes = notes.filter_map(Value::as_str);
    let sections = [
        signals(run),
        along_the_path(run),
        joints(run),
        metrics(run),
        Some(from(run)),
    ];
    Page {
        title: run.title().to_owned(),
        verdict,
        tone,
        lead: notes.map(|note| format!("Note: {note}.")).collect(),
        facts: facts(run),
        sections: sections.into_iter().flatten().collect(),
        footer: "Made by idc, which simulates the device and its cell. recording.rrd beside this page shows the run in space: `idc view recording.rrd`.".to_owned(),
    }
}

fn verdict(run: &RunResult<'_>) -> (String, Tone) {
    if let Some(reason) = run.document["stopped"].as_str() {
        return (format!("Stopped early: {reason}"), Tone::Bad);
    }
    let expectations = run.document["expectations"].as_array();
    let all: Vec<&Value> = expectations.into_iter().flatten().collect();
    let broken: Vec<&str> = (all.iter())
        .filter(|e| e["kept"] == false)
        .filter_map(|e| e["metric"].as_str())
        .collect();
    if !broken.is_empty() {
        let names = broken.iter().map(|key| labels(key).map_or(*key, |l| l.0));
        let names: Vec<&str> = names.collect();
        return (
            format!("Outside its bounds: {}.", names.join(", ")),
            Tone::Bad,
        );
    }
    let force = match (
        run.metric("force_mean_n"),
        run.metric("force_standard_deviation_n"),
    ) {
        (Some(mean), Some(deviation)) => format!(
            "{} N in contact, with a standard deviation of {} N",
            figures(mean, 4),
            figures(deviation, 2)
        ),
        (Some(mean), None) => format!("{} N in contact", figures(mean, 4)),
        _ => "Done".to_owned(),
    };
    match all.len() {
        0 => (format!("{force}."), Tone::Plain),
        1 => (format!("{force}; its bound is kept."), Tone::Good),
        count => (format!("{force}; all {count} bounds are kept."), Tone::Good),
    }
}

/// Metrics that stand at the top, where a run has them.
const FACTS: [&str; 8] = [
    "coefficient_of_variation_percent",
    "within_5_percent_share_percent",
    "engagement_peak_n",
    "force_rms_error_percent",
    "regulator_delay_s",
    "force_settling_time_s",
    "stroke_used_mm",
    "stroke_margin_mm",
];

fn facts(run: &RunResult<'_>) -> Vec<Fact> {
    let fact = |key: &&str| {
        let (label, unit, meaning) = labels(key)?;
        Some(Fact {
            name: label.to_owned(),
            value: format!("{} {unit}", figures(run.metric(key)?, 3)),
            remark: meaning.to_owned(),
        })
    };
    FACTS.iter().filter_map(fact).take(5).collect()
}

fn metrics<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let expectations = run.document["expectations"].as_array();
    let bounds = |key: &str| {
        let own = |e: &&Value| e["metric"] == key;
        let bound = expectations.into_iter().flatten().find(own)?;
        let ends = [("at least", &bound["min"]), ("at most", &bound["max"])];
        let ends = ends.into_iter();
        let ends = ends.filter_map(|(word, end)| Some(format!("{word} {}", end.as_f64()?)));
        let ends: Vec<String> = ends.collect();
        Some((ends.join(", "), bound["kept"] == true))
    };
    let row = |(key, value): (&str, Option<f64>)| {
        let (label, unit, meaning) = labels(key)?;
        let unit = if unit == "1" { "" } else { unit };
        Some(vec![
            Cell::from(label),
            Cell::from(value.map_or("–".to_owned(), |v| figures(v, 5))),
            Cell::from(unit),
            match bounds(key) {
                Some((text, kept)) => Cell::Judged(text, kept),
                None => Cell::from(""),
            },
            Cell::from(meaning),
            Cell::from(key),
        ])
    };
    let rows: Vec<Vec<Cell>> = run.metrics().into_iter().filter_map(row).collect();
    let columns = [
        "number",
        "#value",
        "unit",
        "bounds",
        "what it is",
        "key in summary.json",
    ];
    let table = Table::new("", &columns, rows);
    Some(Section::new("Numbers", vec![Block::Table(table)]))
}

fn from<'a>(run: &RunResult<'_>) -> Section<'a> {
    let known = serde_json::from_value(run.document["provenance"].clone());
    let mut section = provenance(&known.unwrap_or_default());
    let of = |key: &str| run.document[key].as_str().unwrap_or("–").to_owned();
    let mut told = format!("Scenario {}", of("scenario"));
    if let Some(samples) = run.document["samples"].as_u64() {
        told += &format!(", {samples} samples");
    }
    section.blocks.insert(0, Block::Paragraph(told + "."));
    section
}
