//! What a path must keep to: positions, speeds and torques of each joint, with a margin.

use crate::diagnosis::arm::identifiability::travel;
use crate::diagnosis::arm::input::ArmInput;
use crate::recorded_arm::ArmParameters;
use crate::recorded_arm::fourier_path::{FourierPath, JointPath};
use crate::recorded_arm::simulate::{Channel, RigidCourse, all_bristles, readings};
use crate::stats::median;
use std::f64::consts::PI;

/// Share of a joint's range that is kept free at either end [1].
pub const POSITION_MARGIN: f64 = 0.05;
/// Share of the largest speed that is used [1].
pub const SPEED_SHARE: f64 = 0.9;
/// Share of the largest torque that is used [1]: the description's numbers are not the arm's.
pub const TORQUE_SHARE: f64 = 0.8;
/// Samples over a period of the highest harmonic.
const PER_PERIOD: f64 = 16.0;

/// Limits of one joint, margins taken off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLimits {
    /// Least and largest position [rad or m].
    pub position: [f64; 2],
    /// Largest speed [rad/s or m/s].
    pub speed: f64,
    /// Largest torque [N m or N].
    pub torque: f64,
}

/// Limits of each joint: the URDF's less the margins, at most half a turn from where the recordings were, or from the middle of its range.
#[must_use]
pub fn limits_of(input: &ArmInput) -> Vec<JointLimits> {
    let joints = input.nominal.chain.joints.iter().enumerate();
    joints
        .map(|(place, joint)| {
            let [low, high] = travel(joint);
            let free = POSITION_MARGIN * (high - low);
            let [low, high] = [low + free, high - free];
            let been = input.recordings.iter();
            let been = been.flat_map(|r| r.motion.position[place].iter().copied());
            let about = median(been).unwrap_or(0.5 * (low + high)).clamp(low, high);
            JointLimits {
                position: [low.max(about - PI), high.min(about + PI)],
                speed: SPEED_SHARE * joint.velocity,
                torque: TORQUE_SHARE * joint.effort,
            }
        })
        .collect()
}

/// Least and largest departure from the centre, and largest speed, of one joint over a period.
fn extremes(path: &JointPath, period: f64) -> [f64; 3] {
    let highest = path.harmonics.iter().map(|h| h.number).max().unwrap_or(1);
    let count = (PER_PERIOD * highest as f64).max(64.0) as usize;
    let mut out = [0.0f64; 3];
    for i in 0..count {
        let [q, v, _] = path.at(period, period * i as f64 / count as f64);
        let away = q - path.centre;
        out = [out[0].min(away), out[1].max(away), out[2].max(v.abs())];
    }
    out
}

/// Brings one joint's path within position and speed: scaled down where it must, its centre moved.
pub fn bring_within(path: &mut JointPath, period: f64, limits: &JointLimits) {
    // What lies between samples.
    const BETWEEN: f64 = 0.98;
    let [low, high, speed] = extremes(path, period);
    let range = limits.position[1] - limits.position[0];
    let factor = (BETWEEN * limits.speed / speed.max(1e-12))
        .min(BETWEEN * range / (high - low).max(1e-12))
        .min(1.0);
    path.scale(factor);
    let ends = [
        limits.position[0] - factor * low,
        limits.position[1] - factor * high,
    ];
    path.centre = path.centre.clamp(ends[0], ends[1].max(ends[0]));
}

/// Largest share of each joint's torque limit that the description needs along a path [1].
#[must_use]
pub fn torque_shares(
    arm: &ArmParameters,
    path: &FourierPath,
    rate: f64,
    limits: &[JointLimits],
) -> Vec<f64> {
    let mut arm = arm.clone();
    arm.delay = 0.0;
    // Torques, whatever is logged.
    arm.drives
        .iter_mut()
        .for_each(|drive| drive.inverse_gain = 1.0);
    let motion = path.motion(usize::MAX, rate);
    let channels: Vec<Channel> = (0..arm.joints()).map(Channel::Drive).collect();
    let rigid = RigidCourse::of(&arm, &motion);
    let torques = readings(
        &arm,
        &motion,
        &channels,
        &all_bristles(&arm, &motion),
        &rigid,
    );
    let both = torques.iter().zip(limits);
    both.map(|(torque, limits)| {
        torque.iter().fold(0.0, |most: f64, t| most.max(t.abs())) / limits.torque
    })
    .collect()
}
