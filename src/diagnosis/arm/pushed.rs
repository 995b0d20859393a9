//! Pushes from outside: stretches in which a force at the flange explains what the drives leave.
//!
//! ```text
//! gain of a window = b^T A^-1 b,    A = sum J_v J_v^T/s^2,    b = -sum J_v r/s^2
//! ```
//!
//! r residual torque of a joint, s its noise, J_v its column of the Jacobian of the flange's origin; chi squared with three degrees of freedom where nothing
//! pushes.

use glam::DVec3;
use glamx::DPose3;
use nalgebra::{Matrix3, Vector3};

use super::effect::{ArmEffect, Candidate};
use super::evidence::Evidence;
use super::fit::{Fit, Parameter};
use crate::arm::JointKind;
use crate::arm::chain::MAX_JOINTS;
use crate::arm::kinematics::link_poses;
use crate::recorded_arm::motion::Motion;
use crate::recorded_arm::push::Push;
use crate::recorded_arm::simulate::Channel;
use crate::recorded_arm::{ArmParameters, Quantity};

/// Length of a window [s].
const WINDOW: f64 = 0.1;
/// Gain of a window from which something pushes [1].
const SIGNIFICANT: f64 = 25.0;
/// Time over which a push may go unseen [s].
const BRIDGED: f64 = 0.35;
/// Shares of the duration over which a push grows.
const EDGES: [f64; 3] = [0.1, 0.25, 0.5];
/// Duration below which a stretch is a peak of something else [s].
const SHORTEST: f64 = 0.25;
/// Pushes that are tried at most.
const MOST: usize = 4;

/// A window's normal equations.
#[derive(Clone, Copy)]
struct Window {
    a: Matrix3<f64>,
    b: Vector3<f64>,
}

impl Window {
    const EMPTY: Self = Self {
        a: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        b: Vector3::new(0.0, 0.0, 0.0),
    };

    fn force(&self) -> Option<Vector3<f64>> {
        let damped = self.a + Matrix3::identity() * 1e-6 * (self.a.trace() + 1e-12);
        damped.cholesky().map(|c| c.solve(&self.b))
    }

    fn gain(&self) -> f64 {
        self.force().map_or(0.0, |force| force.dot(&self.b))
    }

    fn add(&mut self, other: &Self) {
        self.a += other.a;
        self.b += other.b;
    }
}

/// Candidates of pushes that the residuals of a fit suggest.
#[must_use]
pub fn pushes(evidence: &Evidence, fit: &Fit, scales: &[f64]) -> Vec<Candidate> {
    let mut found: Vec<(f64, Push)> = Vec::new();
    for recording in 0..evidence.input.recordings.len() {
        found.extend(of_recording(evidence, fit, scales, recording));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let shaped = |(_, push): &(f64, Push)| {
        let push = *push;
        EDGES.map(|edge| {
            // What is seen of it is shorter than it is.
            let hidden = 0.4 * edge * (push.end - push.start);
            let push = Push {
                edge,
                start: push.start - hidden,
                end: push.end + hidden,
                ..push
            };
            candidate(push)
        })
    };
    found.iter().take(MOST).flat_map(shaped).collect()
}

/// A push as what may be missing.
#[must_use]
pub fn candidate(push: Push) -> Candidate {
    let free = |quantity, bounds| Parameter::free(quantity, bounds);
    let forces = [0, 1, 2].map(|axis| free(Quantity::PushForce(0, axis), [-1e4, 1e4]));
    let around = |time: f64| [time - 1.0, time + 1.0];
    let times = [
        free(Quantity::PushStart(0), around(push.start)),
        free(Quantity::PushEnd(0), around(push.end)),
        free(Quantity::PushEdge(0), [0.02, 0.5]),
    ];
    Candidate {
        effect: ArmEffect::Push(push.recording),
        presets: Vec::new(),
        free: forces.into_iter().chain(times).collect(),
        screened: forces.iter().map(|p| p.quantity).collect(),
        push: Some(Push {
            force: DVec3::ZERO,
            ..push
        }),
        law: None,
    }
}

/// Stretches of a recording in which something pushes, with their gain.
fn of_recording(
    evidence: &Evidence,
    fit: &Fit,
    scales: &[f64],
    recording: usize,
) -> Vec<(f64, Push)> {
    let windows = windows(evidence, fit, scales, recording);
    let motion = &evidence.input.recordings[recording].motion;
    let first = motion.time.first().copied().unwrap_or(0.0);
    let at = |w: usize| first + WINDOW * w as f64;
    let bridged = (BRIDGED / WINDOW).round() as usize;
    let mut found = Vec::new();
    let mut w = 0;
    while w < windows.len() {
        if windows[w].gain() < SIGNIFICANT {
            w += 1;
            continue;
        }
        let (start, mut last) = (w, w);
        let mut next = w + 1;
        while next < windows.len() && next <= last + bridged {
            if windows[next].gain() >= SIGNIFICANT {
                last = next;
            }
            next += 1;
        }
        let mut whole = Window::EMPTY;
        windows[start..=last].iter().for_each(|w| whole.add(w));
        let force = whole.force().unwrap_or_default();
        let push = Push {
            recording,
            start: at(start),
            end: at(last + 1),
            edge: 0.25,
            force: DVec3::new(force[0], force[1], force[2]),
        };
        let of_it = |known: &&Push| known.recording == recording;
        let meets = |known: &Push| known.start < push.end && push.start < known.end;
        if push.end - push.start >= SHORTEST && !fit.arm.pushes.iter().filter(of_it).any(meets) {
            found.push((whole.gain(), push));
        }
        w = last + 1;
    }
    found
}

/// Torque of each joint for a unit force at the flange's origin, by its components [N m/N].
#[must_use]
pub fn levers(arm: &ArmParameters, motion: &Motion, sample: usize) -> [DVec3; MAX_JOINTS] {
    let chain = &arm.chain;
    let joints = chain.len();
    let q: Vec<f64> = motion.position.iter().map(|q| q[sample]).collect();
    let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
    link_poses(chain, DPose3::IDENTITY, &q, &mut poses[..joints]);
    let flange = (poses[joints - 1] * chain.tip_from_last).translation;
    let mut lever = [DVec3::ZERO; MAX_JOINTS];
    for (j, joint) in chain.joints.iter().enumerate() {
        let axis = poses[j].rotation * joint.axis;
        lever[j] = match joint.kind {
            JointKind::Revolute => axis.cross(flange - poses[j].translation),
            JointKind::Prismatic => axis,
        };
    }
    lever
}

/// Normal equations of all windows of a recording.
fn windows(evidence: &Evidence, fit: &Fit, scales: &[f64], recording: usize) -> Vec<Window> {
    let input = evidence.input;
    let motion = &input.recordings[recording].motion;
    let span = motion.time.last().copied().unwrap_or(0.0) - motion.time[0];
    let mut windows = vec![Window::EMPTY; (span / WINDOW) as usize + 1];
    let levers: Vec<[DVec3; MAX_JOINTS]> = (0..motion.len())
        .map(|sample| levers(&fit.arm, motion, sample))
        .collect();
    for (c, channel) in input.channels.iter().enumerate() {
        let Channel::Drive(joint) = channel else {
            continue;
        };
        // A push relieves or loads the motor by its lever.
        let per_torque = fit.arm.drives[*joint].inverse_gain / (input.noise[c] * scales[c]);
        for (row, residual) in evidence.rows[c].iter().zip(&fit.residuals[c]) {
            if row.recording != recording {
                continue;
            }
            let window = ((motion.time[row.sample] - motion.time[0]) / WINDOW) as usize;
            let lever = levers[row.sample][*joint] * -per_torque;
            let lever = Vector3::new(lever.x, lever.y, lever.z);
            let own = &mut windows[window];
            own.a += lever * lever.transpose();
            own.b += lever * (residual / scales[c]);
        }
    }
    windows
}
