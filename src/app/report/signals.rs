//! The charts of a run: its signals against time, its force along the edge, the drives of its arm.

use serde_json::Value;

use super::super::bench_figures::{FORCE, Line, PRESSURE, STROKE};
use super::run_result::RunResult;
use crate::document::{
    Block, Cell, Horizontal, Marker, Panel, Role, Section, Series, Stroke, Table,
};
use crate::quantity::column;
use crate::recording::PhaseSpan;
use crate::recording::schema::{self, JointSignal, joint_quantity};

/// A chart of a run: title, label of its vertical axis, what a value in SI is multiplied by, and lines.
pub(in super::super) struct Group {
    pub title: &'static str,
    pub label: &'static str,
    pub factor: f64,
    pub lines: &'static [Line],
}

const SEALS: [Line; 1] = [(schema::SEAL_FORCE, "seals", Role::Band, Stroke::Plain)];
const PATH: [Line; 3] = [
    (
        schema::PATH_LAG,
        "behind its plan",
        Role::Regulator,
        Stroke::Plain,
    ),
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
        group("Path error", "error [µm]", 1e6, &PATH),
        group("Seals", "force [N]", 1.0, &SEALS),
    ]
}

/// Roles that many of a kind are drawn in, in order: joints from the base on, runs as they are named.
pub(in super::super) const ROLES: [Role; 7] = [
    Role::Regulator,
    Role::Force,
    Role::Stroke,
    Role::Estimate,
    Role::Band,
    Role::Measured,
    Role::Command,
];

fn time_of(run: &RunResult<'_>) -> Vec<f64> {
    run.recording.time().to_vec()
}

/// Starts of the phases, as lines.
fn markers(run: &RunResult<'_>) -> Vec<Marker> {
    let marker = |phase: &PhaseSpan| Marker {
        label: phase.name.clone(),
        at: phase.start,
    };
    run.recording.phases().iter().map(marker).collect()
}

fn chart<'a>(run: &RunResult<'_>, title: &str, label: &str, series: Vec<Series<'a>>) -> Panel<'a> {
    Panel {
        title: title.to_owned(),
        vertical_label: label.to_owned(),
        horizontal: Horizontal::Time,
        series,
        markers: markers(run),
        group: "run".to_owned(),
        ..Panel::default()
    }
}

pub(super) fn signals<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
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
            blocks.push(Block::Panel(chart(run, group.title, group.label, series)));
        }
    }
    (blocks.len() > 1).then(|| Section::new("Signals", blocks))
}

/// Force over the place on the edge: what a deburrer asks for.
pub(super) fn along_the_path<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
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
    let mut blocks = vec![Block::Panel(panel)];
    let tenths = run.document["summary"]["force_by_tenth"].as_array();
    let tenths: Vec<&Value> = tenths.into_iter().flatten().collect();
    let of = |key: &str, unit| {
        let values: Vec<Option<f64>> = tenths.iter().map(|tenth| tenth[key].as_f64()).collect();
        column(&values, unit)
    };
    let columns = [
        of("from_mm", "mm"),
        of("to_mm", "mm"),
        of("force_mean_n", "N"),
        of("force_standard_deviation_n", "N"),
    ];
    let row = |index: usize| {
        let cell = |column: &Vec<String>| Cell::from(column[index].clone());
        columns.iter().map(cell).collect()
    };
    let rows: Vec<Vec<Cell>> = (0..tenths.len()).map(row).collect();
    if !rows.is_empty() {
        blocks.push(Block::Table(Table::new(
            "Contact force by tenths of the edge",
            &["#from, mm", "#to, mm", "#mean, N", "#standard deviation, N"],
            rows,
        )));
    }
    Some(Section::new("Along the edge", blocks))
}

pub(super) fn joints<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
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
    let series: Vec<Series<'_>> = ROLES.into_iter().enumerate().filter_map(line).collect();
    (!series.is_empty()).then(|| {
        let chart = chart(run, "Torque of the drives", "torque [N m]", series);
        Section::new("The arm", vec![Block::Panel(chart)])
    })
}
