//! The planned joints over time, and as a table.

use std::fmt::Write as _;

use crate::arm::chain::JointKind;
use crate::cell::Cell;
use crate::path::Reference;

/// Interval of the trajectory [s].
const INTERVAL: f64 = 0.01;

/// The plan over time.
pub struct Sampled {
    /// Names of the joints, base first.
    pub joints: Vec<String>,
    kinds: Vec<JointKind>,
    /// Set force of each pass [N].
    forces: Vec<f64>,
    /// Times [s] with what is planned there.
    pub samples: Vec<(f64, Reference)>,
}

/// The plan of a cell, sampled evenly, its end included.
#[must_use]
pub fn sampled(cell: &Cell) -> Sampled {
    let duration = cell.plan.duration();
    let count = (duration / INTERVAL).floor() as usize;
    let mut times: Vec<f64> = (0..=count).map(|index| index as f64 * INTERVAL).collect();
    if times.last().is_some_and(|last| duration - last > 1e-6) {
        times.push(duration);
    }
    let joints = &cell.setup.arm.chain.joints;
    Sampled {
        joints: joints.iter().map(|joint| joint.name.clone()).collect(),
        kinds: joints.iter().map(|joint| joint.kind).collect(),
        forces: cell.setup.passes.iter().map(|pass| pass.force).collect(),
        samples: times
            .into_iter()
            .map(|time| (time, cell.plan.reference(time)))
            .collect(),
    }
}

/// A table of it: time, phase, pass, set force, then positions, speeds and accelerations of all joints.
#[must_use]
pub fn csv(sampled: &Sampled) -> String {
    let mut text = "time_s,phase,pass,force_n".to_owned();
    for rate in ["", "_per_s", "_per_s2"] {
        for (index, kind) in sampled.kinds.iter().enumerate() {
            let unit = match kind {
                JointKind::Revolute => "rad",
                JointKind::Prismatic => "m",
            };
            // Writing into a text cannot fail.
            let _ = write!(text, ",joint_{}_{unit}{rate}", index + 1);
        }
    }
    text.push('\n');
    let count = sampled.kinds.len();
    for (time, at) in &sampled.samples {
        let force = sampled.forces[at.pass];
        let _ = write!(
            text,
            "{time:.6},{},{},{force}",
            at.phase.name(),
            at.pass + 1
        );
        for values in [&at.position, &at.velocity, &at.acceleration] {
            for value in &values[..count] {
                let _ = write!(text, ",{:.9}", value + 0.0);
            }
        }
        text.push('\n');
    }
    text
}
