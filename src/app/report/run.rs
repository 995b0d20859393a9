//! The page of a run: of a cell or of a bench.

use std::borrow::Cow;

use serde_json::Value;

use super::provenance_of;
use super::signals::{along_the_path, joints, signals};
use crate::diagnosis::words::figures;
use crate::metrics::{BENCH_METRICS, METRICS, Metric};
use crate::page::{Block, Cell, Fact, Page, Section, Table, Tone};
use crate::recording::Recording;

/// A run as its folder has it.
pub(in super::super) struct RunResult<'a> {
    /// summary.json.
    pub document: Value,
    /// samples.parquet.
    pub recording: Cow<'a, Recording>,
}

/// A metric for people.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) struct Label {
    /// Key in summary.json.
    pub key: &'static str,
    /// Its name.
    pub name: String,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

fn labelled<S>(metrics: &[Metric<S>]) -> Vec<Label> {
    let label = |metric: &Metric<S>| Label {
        key: metric.name,
        name: metric.full_label(),
        unit: if metric.unit == "1" { "" } else { metric.unit },
        meaning: metric.meaning,
    };
    metrics.iter().map(label).collect()
}

/// The metrics of benches, or of cells.
pub(super) fn labels(of_bench: bool) -> Vec<Label> {
    if of_bench {
        labelled(BENCH_METRICS)
    } else {
        labelled(METRICS)
    }
}

impl RunResult<'_> {
    /// Its title.
    pub(in super::super) fn title(&self) -> &str {
        self.document["title"].as_str().unwrap_or("a run")
    }

    /// Its metrics in their order, with their values.
    pub(in super::super) fn metrics(&self) -> Vec<(Label, Option<f64>)> {
        let summary = &self.document["summary"];
        let own = labels(self.document["kind"] == "bench").into_iter();
        own.filter_map(|label| {
            let value = summary.get(label.key)?.as_f64();
            Some((label, value))
        })
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
        footer: "Made by idc, which simulates the device and its cell. recording.rrd, where it stands beside this page, shows the run in space: `idc view recording.rrd`.".to_owned(),
    }
}

fn verdict(run: &RunResult<'_>) -> (String, Tone) {
    if let Some(reason) = run.document["stopped"].as_str() {
        return (format!("Stopped early: {reason}"), Tone::Bad);
    }
    let expectations = run.document["expectations"].as_array();
    let all: Vec<&Value> = expectations.into_iter().flatten().collect();
    let broken: Vec<String> = (all.iter())
        .filter(|e| e["kept"] == false)
        .filter_map(|e| told(run, e))
        .collect();
    if !broken.is_empty() {
        return (
            format!("Outside its bounds: {}.", broken.join("; ")),
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

/// A bound that was not kept, in words.
fn told(run: &RunResult<'_>, bound: &Value) -> Option<String> {
    let key = bound["metric"].as_str()?;
    let metrics = run.metrics();
    let (label, value) = metrics.iter().find(|(label, _)| label.key == key)?;
    let unit = match label.unit {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let is = value.map_or("not determined".to_owned(), |v| {
        format!("{}{unit}", figures(v, 4))
    });
    Some(format!(
        "{} is {is}, expected {}{unit}",
        label.name,
        ends(bound)
    ))
}

/// The ends of a bound, in words.
fn ends(bound: &Value) -> String {
    let ends = [("at least", &bound["min"]), ("at most", &bound["max"])].into_iter();
    let ends = ends.filter_map(|(word, end)| Some(format!("{word} {}", end.as_f64()?)));
    let ends: Vec<String> = ends.collect();
    ends.join(", ")
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
    let metrics = run.metrics();
    let fact = |key: &&str| {
        let (label, value) = metrics.iter().find(|(label, _)| label.key == *key)?;
        Some(Fact {
            name: label.name.clone(),
            value: format!("{} {}", figures((*value)?, 3), label.unit),
            remark: label.meaning.to_owned(),
        })
    };
    FACTS.iter().filter_map(fact).take(5).collect()
}

fn metrics<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let expectations = run.document["expectations"].as_array();
    let bounds = |key: &str| {
        let own = |e: &&Value| e["metric"] == key;
        let bound = expectations.into_iter().flatten().find(own)?;
        Some((ends(bound), bound["kept"] == true))
    };
    let row = |(label, value): (Label, Option<f64>)| {
        vec![
            Cell::from(label.name),
            Cell::from(value.map_or("–".to_owned(), |v| figures(v, 5))),
            Cell::from(label.unit),
            match bounds(label.key) {
                Some((text, kept)) => Cell::Judged(text, kept),
                None => Cell::from(""),
            },
            Cell::from(label.meaning),
            Cell::from(label.key),
        ]
    };
    let rows: Vec<Vec<Cell>> = run.metrics().into_iter().map(row).collect();
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
    let mut section = provenance_of(&run.document);
    let of = |key: &str| run.document[key].as_str().unwrap_or("–").to_owned();
    let mut told = format!("Scenario {}", of("scenario"));
    if let Some(samples) = run.document["samples"].as_u64() {
        told += &format!(", {samples} samples");
    }
    section.blocks.insert(0, Block::Paragraph(told + "."));
    section
}
