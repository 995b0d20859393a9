//! What the account of a cell says besides: which joint, and where on the path.

use std::fmt::Write as _;

use crate::diagnosis::details::PredictionError;
use crate::diagnosis::diagnose::Diagnosis;
use crate::diagnosis::joint_friction::JointFriction;
use crate::diagnosis::mismatch::{Interval, without_effects};
use crate::diagnosis::recorded::COLUMNS;
use crate::diagnosis::servo::ServoLink;
use crate::effects::vocabulary;
use crate::plant::{Channel, simulate};
use crate::replay::LoadedCell;

/// Joints, servos and places.
pub(super) fn cell_account(
    cell: &LoadedCell,
    servo: Option<&ServoLink>,
    frictions: &[JointFriction],
    of_arm: &[PredictionError],
    diagnosis: &Diagnosis,
) -> String {
    let mut text = String::from("\nThe arm\n");
    // Writing into a text cannot fail.
    for effect in &diagnosis.best().effects {
        if let (name, Some(joint)) = vocabulary(effect.name) {
            let _ = writeln!(
                text,
                "  {name} is about joint {joint} from the base, `{}` of {}.",
                cell.joints[joint - 1],
                cell.scenario.arm.urdf.display()
            );
        }
    }
    match servo {
        Some(servo) if cell.scenario.own && !servo.differs() => {
            let left: Vec<String> = servo.left.iter().map(|l| format!("{l:.1}")).collect();
            let _ = writeln!(
                text,
                "  From their commands to their encoders the joints answer without a lag beyond that of their servos; what loads push them aside by is {} times\n  the encoders' noise of joints 1 to {}.",
                left.join(", "),
                servo.left.len(),
            );
        }
        None => text.push_str("  No encoder was recorded: nothing is said of the servos.\n"),
        Some(servo) => {
            let left: Vec<String> = servo.left.iter().map(|l| format!("{l:.3}")).collect();
            let _ = writeln!(
                text,
                "  From their commands to their encoders the joints answer at {:.3} Hz ({:.3} to {:.3}), {}; what is left of joints 1 to {} is {} times\n  the encoders' noise.",
                servo.bandwidth,
                servo.bandwidth - 1.96 * servo.deviation,
                servo.bandwidth + 1.96 * servo.deviation,
                if servo.differs() {
                    format!("not {} Hz as believed", cell.scenario.servo_bandwidth)
                } else {
                    "as believed".to_owned()
                },
                servo.left.len(),
                left.join(", ")
            );
        }
    }
    for friction in frictions {
        let _ = writeln!(
            text,
            "  By its drive's torque joint {} rubs with {:.2} N m ({:.2} to {:.2}), believed {:.2}{}.",
            friction.joint + 1,
            friction.friction,
            friction.friction - 1.96 * friction.deviation,
            friction.friction + 1.96 * friction.deviation,
            friction.believed,
            if friction.differs() {
                ": another friction"
            } else {
                ""
            }
        );
    }
    for error in of_arm {
        let _ = writeln!(
            text,
            "  Error of {} in {}, which was not looked at: {:.3e} as believed, {:.3e} improved.",
            error.channel, error.recording, error.before, error.after
        );
    }
    let places = places(diagnosis);
    if !places.is_empty() {
        text.push_str("\nWhere on the path\n");
        text.push_str(&places);
    }
    text
}

/// Where the effects act, along the edge, and where they act most.
fn places(diagnosis: &Diagnosis) -> String {
    let mut text = String::new();
    let bare = without_effects(&diagnosis.believed, diagnosis.best());
    for (recording, measured) in diagnosis.evidence.recordings.iter().enumerate() {
        let Some(course) = &measured.inputs.cell else {
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
                    let [from, to] = [first.min(last), last].map(|i| 1e3 * course.edge[i].station);
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
            let _ = writeln!(
                text,
                "  {}, {}: along the edge at {}; most, {:+.3} {unit}, at {:.1} mm ({:.3} s).",
                measured.name,
                COLUMNS[index],
                spans.join(", "),
                factor * moved(largest),
                1e3 * course.edge[largest].station,
                measured.inputs.time[largest]
            );
        }
    }
    text
}
