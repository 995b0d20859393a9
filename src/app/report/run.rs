//! The page of a run: of a cell or of a bench.

use std::borrow::Cow;

use serde_json::Value;

use super::provenance;
use crate::diagnosis::words::figures;
use crate::figure::{Horizontal, Panel, Role, Series, Stroke};
use crate::metrics::{BENCH_METRICS, METRICS};
use crate::page::{Block, Cell, Chart, Fact, Page, Section, Table, Tone};
use crate::recording::schema::{self, JointSignal, joint_quantity};
use crate::recording::{PhaseSpan, Recording};

/// A run as its folder has it.
pub(in super::super) struct RunResult<'a> {
    /// summary.json.
    pub document: Value,
    /// samples.parquet.
    pub recording: Cow<'a, Recording>,
}

/// A line: quantity, label, role and stroke.
type Line = (&'static str, &'static str, Role, Stroke);

/// A chart of a run: title, label of its vertical axis, what a value in SI is multiplied by, and lines.
pub(in super::super) struct Group {
    pub title: &'static str,
    pub label: &'static str,
    pub factor: f64,
    pub lines: &'static [Line],
}

const FORCE: [Line; 5] = [
    (
        schema::MEASURED_FORCE_UNFILTERED,
        "load cell, read",
        Role::Measured,
        Stroke::Raw,
    ),
    (schema::CONTACT_FORCE, "true", Role::Force, Stroke::Truth),
    (
        schema::MEASURED_FORCE,
        "load cell, filtered",
        Role::Filtered,
        Stroke::Plain,
    ),
    (
        schema::ESTIMATED_FORCE,
        "estimated",
        Role::Estimate,
        Stroke::Plain,
    ),
    (
        schema::DESIRED_FORCE,
        "desired",
        Role::Command,
        Stroke::Dashed,
    ),
];
const STROKE: [Line; 3] = [
    (schema::MEASURED_STROKE, "read", Role::Measured, Stroke::Raw),
    (schema::STROKE, "true", Role::Stroke, Stroke::Truth),
    (
        schema::SURFACE_POSITION,
        "surface",
        Role::Command,
        Stroke::Dashed,
    ),
];
const PRESSURE: [Line; 5] = [
    (
        schema::MEASURED_REGULATOR_PRESSURE,
        "regulator, read",
        Role::Measured,
        Stroke::Raw,
    ),
    (
        schema::CHAMBER_2_PRESSURE,
        "chamber 2",
        Role::Chamber2,
        Stroke::Plain,
    ),
    (
        schema::CHAMBER_1_PRESSURE,
        "chamber 1",
        Role::Chamber1,
        Stroke::Plain,
    ),
    (
        schema::REGULATOR_PRESSURE,
        "regulator",
        Role::Regulator,
        Stroke::Truth,
    ),
    (schema::SET_PRESSURE, "set", Role::Command, Stroke::Dashed),
];
const SEALS: [Line; 1] = [(schema::SEAL_FORCE, "seals", Role::Band, Stroke::Plain)];
const PATH: [Line; 2] = [
    (
        schema::PATH_ERROR_AXIAL,
        "along the tool's axis",
        Role::Chamber2,
        Stroke::Plain,
    ),
    (
        schema::PATH_ERROR,
        "beside the path",
        Role::Force,
        Stroke::Plain,
    ),
];

/// The charts of a run, in order.
#[must_use]
pub(in super::super) fn chart_groups() -> [Group; 5] {
    let group = |title, label, factor, lines| Group {
        title,
        label,
        factor,
        lines,
    };
    [
        group("Contact force", "force [N]", 1.0, FORCE.as_slice()),
        group("Stroke", "stroke [mm]", 1e3, &STROKE),
        group("Pressure", "pressure [bar absolute]", 1e-5, &PRESSURE),
        group("Path error", "error [um]", 1e6, &PATH),
        group("Seals", "force [N]", 1.0, &SEALS),
    ]
}

/// Roles that joints are drawn in, base first.
const JOINTS: [Role; 7] = [
    Role::Regulator,
    Role::Force,
    Role::Stroke,
    Role::Estimate,
    Role::Band,
    Role::Measured,
    Role::Command,
];

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

fn time_of(run: &RunResult<'_>) -> Vec<f64> {
    run.recording.time().to_vec()
}

/// Starts of the phases, as lines.
fn markers(run: &RunResult<'_>) -> Vec<crate::figure::Marker> {
    let marker = |phase: &PhaseSpan| crate::figure::Marker {
        label: phase.name.clone(),
        at: phase.start,
    };
    run.recording.phases().iter().map(marker).collect()
}

fn chart<'a>(run: &RunResult<'_>, title: &str, label: &str, series: Vec<Series<'a>>) -> Chart<'a> {
    Chart {
        panel: Panel {
            title: title.to_owned(),
            vertical_label: label.to_owned(),
            horizontal: Horizontal::Time,
            series,
            markers: markers(run),
            ..Panel::default()
        },
        group: "run".to_owned(),
        ..Chart::default()
    }
}

fn signals<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let hint = "Draw over a chart to zoom it, and all of the run; a double click shows all.";
    let mut blocks = vec![Block::Hint(hint.to_owned())];
    for group in chart_groups() {
        let line = |(quantity, label, role, stroke): &Line| {
            let values = &run.recording.channel(quantity)?.values;
            if values.iter().all(|v| v.is_nan()) {
                return None;
            }
            let values: Vec<f64> = values.iter().map(|v| v * group.factor).collect();
            Some(Series::new(*label, time_of(run), values, *role, *stroke))
        };
        let series: Vec<Series<'_>> = group.lines.iter().filter_map(line).collect();
        if !series.is_empty() {
            blocks.push(Block::Chart(chart(run, group.title, group.label, series)));
        }
    }
    (blocks.len() > 1).then(|| Section::new("Signals", blocks))
}

/// Force over the place on the edge: what a deburrer asks for.
fn along_the_path<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let places = &run.recording.channel(schema::PATH_LENGTH)?.values;
    let force = &run.recording.channel(schema::CONTACT_FORCE)?.values;
    let follow = run.recording.phases().iter().find(|p| p.name == "follow")?;
    let span = run.recording.samples_in(follow);
    let places: Vec<f64> = places[span.clone()].iter().map(|p| 1e3 * p).collect();
    let panel = Panel {
        title: "Contact force along the edge, while following it".to_owned(),
        vertical_label: "force [N]".to_owned(),
        horizontal: Horizontal::Quantity("length along the edge [mm]".to_owned()),
        series: vec![Series::new(
            "true",
            places,
            &force[span],
            Role::Force,
            Stroke::Plain,
        )],
        ..Panel::default()
    };
    let mut blocks = vec![Block::Chart(Chart {
        panel,
        ..Chart::default()
    })];
    let tenths = run.document["summary"]["force_by_tenth"].as_array();
    let row = |tenth: &Value| {
        let number = |key: &str, digits| {
            Cell::from(
                tenth[key]
                    .as_f64()
                    .map_or("–".to_owned(), |v| figures(v, digits)),
            )
        };
        vec![
            number("from_mm", 4),
            number("to_mm", 4),
            number("force_mean_n", 5),
            number("force_standard_deviation_n", 2),
        ]
    };
    let rows: Vec<Vec<Cell>> = tenths.into_iter().flatten().map(row).collect();
    if !rows.is_empty() {
        blocks.push(Block::Table(Table::new(
            "Contact force by tenths of the edge",
            &["#from, mm", "#to, mm", "#mean, N", "#standard deviation, N"],
            rows,
        )));
    }
    Some(Section::new("Along the edge", blocks))
}

fn joints<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let names = run.document["joint_names"].as_array()?;
    let line = |(index, role): (usize, Role)| {
        let quantity = joint_quantity(index + 1, JointSignal::Torque);
        let values = &run.recording.channel(&quantity)?.values;
        let name = names.get(index).and_then(Value::as_str).unwrap_or("joint");
        Some(Series::new(
            name,
            time_of(run),
            values.as_slice(),
            role,
            Stroke::Plain,
        ))
    };
    let series: Vec<Series<'_>> = JOINTS.into_iter().enumerate().filter_map(line).collect();
    (!series.is_empty()).then(|| {
        let chart = chart(run, "Torque of the drives", "torque [N m]", series);
        Section::new("The arm", vec![Block::Chart(chart)])
    })
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
