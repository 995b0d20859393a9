//! A path of joints over time that tells a recorded arm's numbers apart: as a file with a picture, and what it is expected to show.

use std::path::{Path, PathBuf};

use serde_json::json;

use super::super::error::AppError;
use super::super::files::{OverwritePolicy, prepare_files};
use super::arm::recorded;
use super::report::{Report, shown};
use crate::arm::JointKind;
use crate::case::ARM;
use crate::diagnosis::arm::identifiability::Expected;
use crate::diagnosis::arm::input::ArmInput;
use crate::diagnosis::arm::quantity_words::named;
use crate::document::{Cell, Column, Figure, Panel, Role, Series, Stroke, Table};
use crate::excitation::{
    Clearance, Design, HIGHEST, POSITION_MARGIN, SPEED_SHARE, TORQUE_SHARE, design,
};
use crate::figure::svg;
use crate::quantity::significant;
use crate::recorded_arm::motion::Motion;
use crate::recording::atomic::write_all;
use crate::recording::csv::columns_text;
use crate::scenario::arm_file::{ArmFile, is_arm_file, load_arm_file};

/// Where a path goes, and how long it takes.
pub(super) struct Wanted<'a> {
    /// File for it.
    pub file: &'a Path,
    /// Its duration [s].
    pub duration: f64,
    /// Whether old files are replaced.
    pub policy: OverwritePolicy,
}

/// Designs a path for the arm of a file or folder, writes it, and says so.
pub(super) fn add(report: &mut Report, path: &Path, wanted: &Wanted) -> Result<(), AppError> {
    let own = match path.is_dir() {
        true => path.join(ARM),
        false => path.to_owned(),
    };
    if !is_arm_file(&own) {
        return Err(AppError::NoArm {
            file: path.display().to_string(),
        });
    }
    let picture = wanted.file.with_extension("svg");
    let _claims = prepare_files(&[wanted.file, &picture], "--design", wanted.policy)?;
    let file = load_arm_file(&own)?;
    let input = recorded(&file, own.parent().unwrap_or(Path::new("")));
    let clearance = Clearance::of(&file)?;
    let found = design(&file, &input, &clearance, wanted.duration)?;
    let motion = found.path.motion(0, file.rate);
    let [table, drawn] = [table_of(&file, &motion)?, picture_of(&file, &motion)?];
    write_all(&[(wanted.file, table), (&picture, drawn)])?;
    say(report, &file, &found, &clearance, wanted);
    let files: [(&str, &PathBuf); 2] =
        [("path", &wanted.file.to_owned()), ("its picture", &picture)];
    for (what, file) in files {
        report.file(what, file);
    }
    report.table(used(&file, &found, &motion));
    report.table(half_widths(&input, &found));
    report.number("design", numbers(&input, &file, &found, &motion));
    Ok(())
}

/// Unit of a joint's position, in a column's name and in words.
fn unit(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "rad",
        JointKind::Prismatic => "m",
    }
}

fn table_of(file: &ArmFile, motion: &Motion) -> Result<String, AppError> {
    let joints = file.nominal.chain.joints.iter();
    // Nanometres and their like are rounding.
    let rounded = |values: &[f64]| -> Vec<f64> {
        let nano = values.iter().map(|v| (v * 1e9).round() / 1e9 + 0.0);
        nano.collect()
    };
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    for (ending, values) in [
        ("", &motion.position),
        ("_per_s", &motion.speed),
        ("_per_s2", &motion.acceleration),
    ] {
        let named = joints.clone().zip(values);
        columns.extend(named.map(|(joint, values)| {
            let name = format!("{}_{}{ending}", joint.name, unit(joint.kind));
            (name, rounded(values))
        }));
    }
    let columns: Vec<(&str, &[f64])> = { columns.iter() }
        .map(|(n, v)| (n.as_str(), v.as_slice()))
        .collect();
    Ok(columns_text(&motion.time, &columns)?)
}

fn picture_of(file: &ArmFile, motion: &Motion) -> Result<String, AppError> {
    let joints = file.nominal.chain.joints.iter().zip(&motion.position);
    let panels = joints.map(|(joint, position)| Panel {
        title: joint.name.clone(),
        vertical_label: format!("position [{}]", unit(joint.kind)),
        series: vec![Series::new(
            "",
            motion.time.as_slice(),
            position.as_slice(),
            Role::Command,
            Stroke::Plain,
        )],
        ..Panel::default()
    });
    Ok(svg(&Figure {
        title: "Path of the joints".to_owned(),
        panels: panels.collect(),
    })?)
}

fn say(
    report: &mut Report,
    file: &ArmFile,
    found: &Design,
    clearance: &Clearance,
    wanted: &Wanted,
) {
    report.fact(
        "designed path",
        format!(
            "{} s at {} Hz, a Fourier series of each joint up to {HIGHEST} Hz, at rest at both ends, which are one posture",
            shown(wanted.duration),
            shown(file.rate)
        ),
    );
    if let Some(ratio) = found.median_ratio {
        report.fact(
            "designed path",
            format!(
                "half-widths of the base parameters are {} of those by the recordings (median)",
                significant(ratio, 2)
            ),
        );
    }
    report.fact(
        "margins",
        format!(
            "{} % of each joint's range at either end, at most half a turn from where it was recorded or from its middle; {} % of its speed, {} % of its effort; {} mm between bodies",
            shown(100.0 * POSITION_MARGIN),
            shown(100.0 * (1.0 - SPEED_SHARE)),
            shown((100.0 * (1.0 - TORQUE_SHARE)).round()),
            shown(1e3 * clearance.margin)
        ),
    );
    for note in &clearance.notes {
        report.note(note.as_str());
    }
    report.note(
        "run it slowly first: what is in the arm's way and not in its file is not known here",
    );
}

/// Largest of a list without its signs.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| most.max(v.abs()))
}

/// Least and largest.
fn span(values: &[f64]) -> [f64; 2] {
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    { values.iter() }.fold(ends, |[low, high], v| [low.min(*v), high.max(*v)])
}

/// How much of its limits each joint uses.
fn used(file: &ArmFile, found: &Design, motion: &Motion) -> Table {
    let joints = file.nominal.chain.joints.iter().enumerate();
    let rows = joints.map(|(place, joint)| {
        let [low, high] = span(&motion.position[place]);
        let percent = |share: f64| format!("{:.0} %", 100.0 * share);
        vec![
            Cell::from(joint.name.as_str()),
            Cell::from(format!("{low:.2} to {high:.2} {}", unit(joint.kind))),
            Cell::from(percent(largest(&motion.speed[place]) / joint.velocity)),
            Cell::from(match joint.effort.is_finite() {
                true => percent(TORQUE_SHARE * found.torque_shares[place]),
                false => "no limit".to_owned(),
            }),
        ]
    });
    Table::new(
        "What the path uses of the URDF's limits:",
        Column::list("joint | position | of its speed | of its effort"),
        rows.collect(),
    )
}

/// A number with what is known of it, by the recordings and by the path.
fn both(found: &Design) -> impl Iterator<Item = (Option<&Expected>, &Expected)> {
    let after = found.after.iter().enumerate();
    after.map(|(i, one)| (found.before.as_ref().map(|before| &before[i]), one))
}

fn half_widths(input: &ArmInput, found: &Design) -> Table {
    let rows = both(found).map(|(before, after)| {
        let named = named(input, after.quantity);
        let [tolerance, path] = after.shown(&input.nominal);
        let recordings = match before {
            Some(before) => significant(before.shown(&input.nominal)[1], 2),
            None => "-".to_owned(),
        };
        vec![
            Cell::from(named.owner),
            Cell::from(named.part),
            Cell::from(named.unit),
            Cell::from(significant(tolerance, 2)),
            Cell::from(recordings),
            Cell::from(significant(path, 2)),
        ]
    });
    Table::new(
        "Half of the 95 % interval of each number, if nothing but noise is left:",
        Column::list("of | number | unit | known | recordings | path"),
        rows.collect(),
    )
}

fn numbers(input: &ArmInput, file: &ArmFile, found: &Design, motion: &Motion) -> serde_json::Value {
    let joints = file.nominal.chain.joints.iter().enumerate();
    let joints: Vec<_> = joints
        .map(|(place, joint)| {
            json!({
                "joint": joint.name,
                "positions": span(&motion.position[place]),
                "largest_speed": largest(&motion.speed[place]),
                "speed_limit": joint.velocity,
                "share_of_effort": TORQUE_SHARE * found.torque_shares[place],
            })
        })
        .collect();
    let numbers: Vec<_> = both(found)
        .map(|(before, after)| {
            let named = named(input, after.quantity);
            let [tolerance, path] = after.shown(&input.nominal);
            json!({
                "of": named.owner,
                "number": named.part,
                "unit": named.unit,
                "tolerance": tolerance,
                "by_recordings": before.map(|before| before.shown(&input.nominal)[1]),
                "by_path": path,
            })
        })
        .collect();
    json!({
        "duration_s": found.path.period,
        "rate_hz": file.rate,
        "highest_hz": HIGHEST,
        "median_ratio": found.median_ratio,
        "joints": joints,
        "half_widths": numbers,
    })
}
