//! Findings of the improved arm in the recording that is to be predicted, where it holds encoders and torques: servos and friction show there, and hardly in
//! what the device feels.

use crate::diagnosis::answer::details::PredictionError;
use crate::diagnosis::difference::localise::root_mean_square;
use crate::diagnosis::joints::friction::{DriveLoad, JointFriction};
use crate::diagnosis::joints::servo::ServoLink;
use crate::plant::follow;
use crate::recording::csv::CellRecording;
use crate::replay::LoadedCell;

/// Errors before and after of the joints whose servos or friction were found to differ from their nominal values.
pub(super) fn arm_prediction(
    cell: &LoadedCell,
    name: &str,
    recording: &CellRecording,
    servo: Option<&ServoLink>,
    frictions: &[JointFriction],
    drives: &[DriveLoad],
) -> Vec<PredictionError> {
    let mut errors = Vec::new();
    let error = |channel: String, before: f64, after: f64, noise: Option<f64>| PredictionError {
        recording: name.to_owned(),
        channel,
        nominal: before,
        before,
        after,
        noise,
        before_sigmas: noise.map(|noise| before / noise),
        after_sigmas: noise.map(|noise| after / noise),
    };
    if let Some(servo) = servo.filter(|servo| servo.differs()) {
        let of = |bandwidth: f64| {
            let joints = recording.commands.iter().zip(&recording.encoders);
            let departures = joints.flat_map(|(command, encoder)| {
                let angle = follow(&recording.time, command, bandwidth).angle;
                let encoder = encoder.as_deref().unwrap_or_default();
                let pairs = encoder.iter().zip(angle);
                pairs.map(|(e, a)| e - a).collect::<Vec<f64>>()
            });
            root_mean_square(departures)
        };
        let sizes = [cell.scenario.nominal.cell.servo_bandwidth, servo.bandwidth].map(of);
        if let [Some(before), Some(after)] = sizes {
            let noise = cell.scenario.joint_noise;
            errors.push(error("joints_rad".to_owned(), before, after, Some(noise)));
        }
    }
    for friction in frictions.iter().filter(|friction| friction.differs()) {
        let Some(drive) = drives.get(friction.joint) else {
            continue;
        };
        let of = |rubs: f64| root_mean_square(drive.departures(rubs));
        let channel = format!("joint_{}_torque_n_m", friction.joint + 1);
        let sizes = [friction.nominal, friction.friction].map(of);
        if let [Some(before), Some(after)] = sizes {
            errors.push(error(channel, before, after, None));
        }
    }
    errors
}
