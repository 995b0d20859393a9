//! The charts of a run: its signals against time, its force along the edge, the drives of its arm.

use crate::document::{
    Block, Cell, Column, Horizontal, Marker, Number, Panel, Role, Section, Series, Stroke, Table,
};
use crate::metrics::ForceTenth;
use crate::quantity::column;
use crate::recording::schema::{self, JointSignal, joint_quantity};
use crate::recording::{PhaseSpan, Recording};
use crate::run::{RunResult, RunSummary};

/// Quantity, label, role and stroke of a line, in the order of drawing.
pub type Line = (&'static str, &'static str, Role, Stroke);

/// Lines of a picture of it.
pub const PRESSURE: [Line; 5] = [
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
/// Lines of a picture of it.
pub const FORCE: [Line; 5] = [
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
/// Lines of a picture of it.
pub const STROKE: [Line; 3] = [
    (schema::MEASURED_STROKE, "read", Role::Measured, Stroke::Raw),
    (schema::STROKE, "true", Role::Stroke, Stroke::Truth),
    (
        schema::SURFACE_POSITION,
        "load's surface",
        Role::Command,
        Stroke::Dashed,
    ),
];

/// A chart of a run: title, label of its vertical axis, what a value in SI is multiplied by, and lines.
pub struct Group {
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
pub fn chart_groups() -> [Group; 5] {
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
pub const ROLES: [Role; 7] = [
    Role::Regulator,
    Role::Force,
    Role::Stroke,
    Role::Estimate,
    Role::Band,
    Role::Measured,
    Role::Command,
];

/// Starts of the phases, as lines.
fn markers(recording: &Recording) -> Vec<Marker> {
    let marker = |phase: &PhaseSpan| Marker {
        label: phase.name.clone(),
        at: phase.start,
    };
    recording.phases().iter().map(marker).collect()
}

fn chart<'a>(
    recording: &Recording,
    title: &str,
    label: &str,
    series: Vec<Series<'a>>,
) -> Panel<'a> {
    Panel {
        title: title.to_owned(),
        vertical_label: label.to_owned(),
        horizontal: Horizontal::Time,
        series,
        markers: markers(recording),
        group: "run".to_owned(),
        ..Panel::default()
    }
}

pub fn signals(recording: &Recording) -> Option<Section<'_>> {
    let hint = "Draw over a chart to zoom it, and all of the run; a double click shows all.";
    let mut blocks = vec![Block::Hint(hint.to_owned())];
    for group in chart_groups() {
        let line = |(quantity, label, role, stroke): &Line| {
            let values = &recording.channel(quantity)?.values;
            if values.iter().all(|v| v.is_nan()) {
                return None;
            }
            let values: Vec<f64> = values.iter().map(|v| v * group.factor).collect();
            Some(Series::new(
                *label,
                recording.time(),
                values,
                *role,
                *stroke,
            ))
        };
        let series: Vec<Series<'_>> = group.lines.iter().filter_map(line).collect();
        if !series.is_empty() {
            blocks.push(Block::Panel(chart(
                recording,
                group.title,
                group.label,
                series,
            )));
        }
    }
    (blocks.len() > 1).then(|| Section::new("Signals", blocks))
}

/// Force over the place on the edge: what a deburrer asks for.
pub fn along_the_path<'a>(recording: &'a Recording, result: &RunResult) -> Option<Section<'a>> {
    let places = &recording.channel(schema::PATH_LENGTH)?.values;
    let force = &recording.channel(schema::CONTACT_FORCE)?.values;
    let follow = recording.phases().iter().find(|p| p.name == "follow")?;
    let span = recording.samples_in(follow);
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
    if let RunSummary::Cell(summary) = &result.summary
        && !summary.force_by_tenth.is_empty()
    {
        blocks.push(Block::Table(tenths(&summary.force_by_tenth)));
    }
    Some(Section::new("Along the edge", blocks))
}

/// The contact force in each tenth of the edge.
fn tenths(tenths: &[ForceTenth]) -> Table {
    let of = |value: fn(&ForceTenth) -> Option<f64>| {
        column(&tenths.iter().map(value).collect::<Vec<_>>(), "N")
    };
    let means = of(|tenth| tenth.force_mean_n);
    let spreads = of(|tenth| tenth.force_standard_deviation_n);
    let number = |index: usize, key: &str, text: String| {
        let key = format!("force_by_tenth.{index}.{key}");
        Cell::from(Number::bare(&key, None, "").written(text))
    };
    let rows = tenths.iter().zip(means.into_iter().zip(spreads));
    let rows = rows.enumerate().map(|(index, (tenth, (mean, spread)))| {
        vec![
            number(index, "from_mm", tenth.end_text(tenth.from_mm)),
            number(index, "to_mm", tenth.end_text(tenth.to_mm)),
            number(index, "force_mean_n", mean),
            number(index, "force_standard_deviation_n", spread),
        ]
    });
    let heads = Column::list("#from, mm | #to, mm | #mean, N | #standard deviation, N");
    Table::new("Contact force by tenths of the edge", heads, rows.collect())
}

pub fn joints<'a>(recording: &'a Recording, result: &RunResult) -> Option<Section<'a>> {
    let names = &result.joint_names;
    let line = |(index, role): (usize, Role)| {
        let quantity = joint_quantity(index + 1, JointSignal::Torque);
        let values = &recording.channel(&quantity)?.values;
        let name = names.get(index)?.as_str();
        Some(Series::new(
            name,
            recording.time(),
            values.as_slice(),
            role,
            Stroke::Plain,
        ))
    };
    let series: Vec<Series<'_>> = ROLES.into_iter().enumerate().filter_map(line).collect();
    (!series.is_empty()).then(|| {
        let chart = chart(recording, "Torque of the drives", "torque [N m]", series);
        Section::new("The arm", vec![Block::Panel(chart)])
    })
}
