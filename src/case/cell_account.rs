//! Additions to the account of a cell: which joint, and where on the path.

use super::cell::CellCase;
use crate::diagnosis::answer::account::SectionKind;
use crate::diagnosis::answer::details::Details;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::answer::words::{of_column, with_interval};
use crate::diagnosis::difference::mismatch::{Interval, without_effects};
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::plant::{Channel, simulate};
use crate::quantity::{significant, with_unit};
use crate::replay::LoadedCell;
use crate::stats::NORMAL_95;

/// Adds joints, servos and places, and the errors of what is predicted of the arm.
pub(super) fn add_cell(
    details: &mut Details,
    diagnosis: &Diagnosis,
    cell: &LoadedCell,
    read: &CellCase,
) {
    details.prediction.extend(read.of_arm.iter().cloned());
    let account = &mut details.account;
    account.add(SectionKind::Arm, arm(cell, read, diagnosis));
    account.add(SectionKind::PathPlaces, places(diagnosis));
    if diagnosis.shape.is_some() {
        let place = "A cell's improved.toml has no place for a model discrepancy: it stands in prediction.csv alone.";
        account.add(SectionKind::NotWritten, vec![place.to_owned()]);
    }
}

fn arm(cell: &LoadedCell, read: &CellCase, diagnosis: &Diagnosis) -> Vec<String> {
    let mut arm = Vec::new();
    for effect in &diagnosis.best().effects {
        if let (name, Some(joint)) = effect.vocabulary() {
            arm.push(format!(
                "{name} is about joint {joint} from the base, `{}` of {}.",
                cell.joints[joint - 1],
                cell.scenario.arm.urdf.display()
            ));
        }
    }
    match &read.servo {
        Some(servo) if cell.scenario.observed.motors_by_encoders && !servo.differs() => {
            let left: Vec<String> = servo.left.iter().map(|l| format!("{l:.1}")).collect();
            arm.push(format!(
                "From their commands to their encoders the joints answer without a lag beyond that of their servos; what loads push them aside by is {} times the encoders' noise of joints 1 to {}.",
                left.join(", "),
                servo.left.len(),
            ));
        }
        None => arm.push("No encoder was recorded: nothing is said of the servos.".to_owned()),
        Some(servo) => {
            let left: Vec<String> = servo.left.iter().map(|l| significant(*l, 3)).collect();
            arm.push(format!(
                "From their commands to their encoders the joints answer at {}, {}; what is left of joints 1 to {} is {} times the encoders' noise.",
                with_interval(
                    servo.bandwidth,
                    [-NORMAL_95, NORMAL_95].map(|z| servo.bandwidth + z * servo.deviation),
                    "Hz"
                ),
                if servo.differs() {
                    format!("not the nominal {} Hz", cell.scenario.nominal.cell.servo_bandwidth)
                } else {
                    "as nominal".to_owned()
                },
                servo.left.len(),
                left.join(", ")
            ));
        }
    }
    for friction in &read.frictions {
        arm.push(format!(
            "By its drive's torque joint {} rubs with {}, nominal {}{}.",
            friction.joint + 1,
            with_interval(
                friction.friction,
                [-NORMAL_95, NORMAL_95].map(|z| friction.friction + z * friction.deviation),
                "N m"
            ),
            with_unit(friction.nominal, "N m"),
            if friction.differs() {
                ": another friction"
            } else {
                ""
            }
        ));
    }
    for error in &read.of_arm {
        let (words, unit, factor) = of_column(&error.channel);
        let size = |value: f64| format!("{} {unit}", significant(factor * value, 3));
        arm.push(format!(
            "RMS error of the {words} in {}, which was kept back: {} nominal, {} improved.",
            error.recording,
            size(error.before),
            size(error.after)
        ));
    }
    arm
}

/// Where the effects act, along the edge, and where they act most.
fn places(diagnosis: &Diagnosis) -> Vec<String> {
    let mut places = Vec::new();
    let bare = without_effects(&diagnosis.nominal, diagnosis.best());
    for (recording, measured) in diagnosis.evidence.recordings.iter().enumerate() {
        let Some(trajectory) = &measured.inputs.cell else {
            continue;
        };
        let plant = &diagnosis.best().fit.prediction.plant;
        let with = simulate(plant, &measured.inputs).readings;
        let without = simulate(&bare, &measured.inputs).readings;
        for channel in [Channel::Stroke, Channel::Force, Channel::RegulatorPressure] {
            let index = channel as usize;
            let own = |i: &&Interval| i.recording == recording && i.channel == channel;
            let intervals: Vec<&Interval> = diagnosis.mismatch.iter().filter(own).collect();
            if intervals.is_empty() {
                continue;
            }
            let moved = |i: usize| with[index][i] - without[index][i];
            let largest = (0..measured.inputs.time.len())
                .max_by(|a, b| moved(*a).abs().total_cmp(&moved(*b).abs()))
                .unwrap_or(0);
            let spans: Vec<String> = intervals
                .iter()
                .map(|interval| {
                    let time = &measured.inputs.time;
                    let first = time.partition_point(|t| *t < interval.start);
                    let last = time.partition_point(|t| *t <= interval.end).max(1) - 1;
                    let [from, to] =
                        [first.min(last), last].map(|i| 1e3 * trajectory.edge[i].station);
                    format!(
                        "{from:.1} to {to:.1} mm ({:.2} to {:.2} s)",
                        interval.start, interval.end
                    )
                })
                .collect();
            let (unit, factor) = match channel {
                Channel::Stroke => ("mm", 1e3),
                Channel::Force => ("N", 1.0),
                _ => ("Pa", 1.0),
            };
            places.push(format!(
                "{}, {}: along the edge at {}; most, {:+.3} {unit}, at {:.1} mm ({:.3} s).",
                measured.name,
                COLUMNS[index],
                spans.join(", "),
                factor * moved(largest),
                1e3 * trajectory.edge[largest].station,
                measured.inputs.time[largest]
            ));
        }
    }
    places
}
