//! The page of an experiment: which explanations are open, what each predicts, and the odds that are expected afterwards.

use super::super::error::AppError;
use super::files::{BENCH, CELL, INPUTS, valve};
use super::proposal::Proposal;
use crate::diagnosis::answer::words::{CHANNEL_UNITS, CHANNEL_WORDS};
use crate::document::{
    Block, Cell, Column, Document, Figure, Horizontal, Panel, Role, Section, Series, Stroke, Table,
    Tone,
};
use crate::figure::svg;
use crate::quantity::percent;

/// Explanations that are drawn.
const DRAWN: usize = 4;
/// Their colours.
pub(super) const ROLES: [Role; DRAWN] = [Role::Filtered, Role::Force, Role::Stroke, Role::Estimate];
/// Expected probability from which the experiment settles which explanation is right [1].
pub(super) const SETTLES: f64 = 0.95;

/// All of it.
pub(super) fn of_proposal(proposal: &Proposal, case: &str) -> Document<'static> {
    let chosen = &proposal.chosen;
    let (verdict, is_settled) = verdict(proposal);
    let is_open = proposal.open.len() > 1;
    let then = |place: usize| match is_open {
        true => percent(chosen.expected.odds[place][place]),
        false => String::new(),
    };
    let rows = proposal.open.iter().enumerate().map(|(place, own)| {
        vec![
            Cell::from(own.name.clone()),
            Cell::from(percent(own.probability)),
            Cell::from(then(place)),
        ]
    });
    let none = vec![
        Cell::from("none of these"),
        Cell::from(percent(proposal.none_of_these)),
        Cell::from(""),
    ];
    let columns =
        Column::list("explanation | #probability now | #expected afterwards if it is right");
    let table = Table::new("", columns, rows.chain([none]).collect());
    let left_open = proposal.left_open().into_iter().map(Block::Paragraph);
    let visited = proposal.coverage.clone().map(Block::Paragraph);
    let of_open = [Block::Table(table)]
        .into_iter()
        .chain(visited)
        .chain(left_open)
        .collect();
    let steps = chosen.programme.instructions(&proposal.limits).into_iter();
    let panels = panels(proposal).into_iter().map(Block::Panel).collect();
    Document {
        title: format!("Next experiment of {case}"),
        verdict,
        tone: if is_settled { Tone::Good } else { Tone::Open },
        lead: vec![format!(
            "By draws of the numbers of every open explanation the part is pressed with no more than {:.0} N; {:.0} N are allowed. The tool extends by no more than {:.1} mm{}.{}",
            chosen.extremes.force,
            proposal.limits.force,
            chosen.extremes.stroke * 1e3,
            allowed_stroke(proposal.limits.stroke),
            drives(chosen.extremes.torque_share),
        )],
        sections: vec![
            Section::new("Open explanations", of_open),
            Section::new("What to do", steps.map(Block::Paragraph).collect()),
            Section::new("What each explanation predicts", panels).appendix(),
        ],
        footer: footer(proposal),
        ..Document::default()
    }
}

/// What is said of the limit of the stroke [m] where there is one.
fn allowed_stroke(stroke: f64) -> String {
    match stroke.is_finite() {
        true => format!("; {:.1} mm are allowed", stroke * 1e3),
        false => String::new(),
    }
}

/// What is said of the drives of an arm whose torque is limited, by the largest share of it [1].
fn drives(share: f64) -> String {
    match share > 0.0 {
        true => format!(
            " No drive of the arm gives more than {:.0} % of the torque that it may.",
            100.0 * share
        ),
        false => String::new(),
    }
}

/// What the recording is expected to come to, and whether that settles it.
fn verdict(proposal: &Proposal) -> (String, bool) {
    let duration = proposal.chosen.programme.duration();
    let likeliest = percent(proposal.open[0].probability);
    match proposal.expected_probability() {
        Some(expected) if expected >= SETTLES => (
            format!(
                "This recording of {duration:.1} s is expected to settle which explanation is right, if it is one of these: its probability comes to {}.",
                percent(expected)
            ),
            true,
        ),
        Some(expected) => (
            format!(
                "No allowed recording is expected to settle which explanation is right; this one of {duration:.1} s brings its probability to {}, if it is one of these.",
                percent(expected)
            ),
            false,
        ),
        None if proposal.open[0].probability >= SETTLES => (
            format!(
                "One explanation is open, at {likeliest}; this recording of {duration:.1} s is expected to tell most of its numbers."
            ),
            true,
        ),
        None => (
            format!(
                "One explanation is open, at {likeliest}, and none of these at {}: this recording of {duration:.1} s holds it to most of its numbers.",
                percent(proposal.none_of_these)
            ),
            false,
        ),
    }
}

fn footer(proposal: &Proposal) -> String {
    match proposal.limits.arm.is_some() {
        true => format!(
            "Made by idc next. {INPUTS} holds what arm and regulator are commanded, sample by sample, {CELL} the cell by the likeliest explanation."
        ),
        false => format!(
            "Made by idc next. {INPUTS} holds the inputs sample by sample, {BENCH} a bench that carries them out."
        ),
    }
}

/// expected.svg.
pub(super) fn picture(proposal: &Proposal) -> Result<String, AppError> {
    Ok(svg(&Figure {
        title: "What each explanation predicts".to_owned(),
        panels: panels(proposal),
    })?)
}

/// What is asked for.
fn asked(proposal: &Proposal) -> Vec<Panel<'static>> {
    let inputs = &proposal.inputs;
    let one = |label: &str, name: &str, values: Vec<f64>| {
        let own = Series::new(
            name,
            inputs.time.clone(),
            values,
            Role::Command,
            Stroke::Plain,
        );
        panel(format!("{name}, commanded"), label.to_owned(), vec![own])
    };
    let programme = &proposal.chosen.programme;
    let bar = inputs.set_pressure.iter().map(|p| p * 1e-5).collect();
    let mut all = vec![one("set pressure [bar]", "set pressure", bar)];
    let valve = valve(&inputs.extends);
    if valve.contains(&0.0) {
        all.push(one("valve extends [1]", "valve", valve));
    }
    if let Some(commands) = programme.arm_commands(&proposal.limits) {
        let path = commands.path.iter().map(|x| x * 1e3).collect();
        all.push(one("path along the edge [mm]", "path", path));
    }
    if programme.surface().is_some_and(|s| s.peak_to_peak > 0.0) {
        let surface = inputs.surface.iter().map(|x| x * 1e3).collect();
        all.push(one("surface [mm]", "surface", surface));
    }
    all
}

fn panel(title: String, label: String, series: Vec<Series<'static>>) -> Panel<'static> {
    Panel {
        title,
        vertical_label: label,
        horizontal: Horizontal::Time,
        series,
        group: "time".to_owned(),
        ..Panel::default()
    }
}

fn panels(proposal: &Proposal) -> Vec<Panel<'static>> {
    let inputs = &proposal.inputs;
    let series = |label: &str, values: Vec<f64>, role| {
        Series::new(label, inputs.time.clone(), values, role, Stroke::Plain)
    };
    let mut all = asked(proposal);
    for (channel, noise) in proposal.sensors.noise.iter().enumerate() {
        if !noise.is_finite() {
            continue;
        }
        let (unit, factor) = CHANNEL_UNITS[channel];
        let drawn = proposal.open.iter().zip(&proposal.chosen.expected.readings);
        let own = drawn.zip(ROLES).map(|((own, readings), role)| {
            let values = readings[channel].iter().map(|v| v * factor).collect();
            series(&own.name, values, role)
        });
        all.push(panel(
            format!("{}, predicted", CHANNEL_WORDS[channel]),
            format!("{} [{unit}]", CHANNEL_WORDS[channel]),
            own.collect(),
        ));
        // Where they differ by less than a line is wide.
        let first = &proposal.chosen.expected.readings[0][channel];
        let others = proposal.open.iter().zip(&proposal.chosen.expected.readings);
        let others = others.zip(ROLES).skip(1);
        let others: Vec<Series<'static>> = others
            .map(|((own, readings), role)| {
                let pairs = readings[channel].iter().zip(first);
                let values = pairs.map(|(own, first)| (own - first) / noise).collect();
                series(&own.name, values, role)
            })
            .collect();
        if !others.is_empty() {
            all.push(panel(
                format!(
                    "{}, difference from the likeliest explanation's",
                    CHANNEL_WORDS[channel]
                ),
                "difference [σ of the noise]".to_owned(),
                others,
            ));
        }
    }
    all
}
