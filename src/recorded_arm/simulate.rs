//! Readings of a recorded arm along a measured motion.

use super::bristles::{bristles, varying};
use super::delay::delayed;
use super::drive::{JointMoment, own_torque, sliding};
use super::motion::Motion;
use super::outside::OutsideWrench;
use super::parameters::{ArmParameters, Drive};
use crate::arm::chain::{KinematicChain, MAX_JOINTS};
use crate::arm::dynamics::{
    LinkMotion, LinkState, add_change_of_body, add_outside_wrench, link_states, torques_of,
};
use crate::arm::kinematics::{link_poses, point_force_torques};
use glam::{DQuat, DVec3};
use glamx::DPose3;
use std::sync::Arc;

/// A measured channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Channel {
    /// Current [A] or torque [N m] of a joint's drive.
    Drive(usize),
    /// Angle of a joint on the link's side of its gear [rad].
    Link(usize),
    /// Channel of the wrench sensor [N or N m].
    Wrench(usize),
}

/// Rigid bodies along a motion: all that does not depend on drives or sensors.
#[derive(Debug, Clone)]
pub struct RigidCourse {
    /// Torque that each gear carries, by joint and sample [N m].
    pub carried: Vec<Vec<f64>>,
    /// Motion of the flange by sample; none without a wrench sensor.
    pub flange: Arc<Vec<LinkMotion>>,
    /// Links by sample and joint.
    links: Arc<Vec<LinkState>>,
    /// The chain with its loads.
    chain: KinematicChain,
}

impl RigidCourse {
    /// Of an arm along a motion.
    #[must_use]
    pub fn of(arm: &ArmParameters, motion: &Motion) -> Self {
        let joints = arm.joints();
        let chain = arm.loaded_chain();
        let gravity = arm.true_gravity();
        let mut carried = vec![Vec::with_capacity(motion.len()); joints];
        let mut flange = Vec::new();
        let mut links = Vec::with_capacity(motion.len() * joints);
        let mut along = [LinkState::AT_REST; MAX_JOINTS];
        let [mut q, mut qd, mut qdd, mut out] = [[0.0; MAX_JOINTS]; 4];
        for i in 0..motion.len() {
            for j in 0..joints {
                q[j] = motion.position[j][i] - arm.drives[j].encoder_offset;
                qd[j] = motion.speed[j][i];
                qdd[j] = motion.acceleration[j][i];
            }
            let out = &mut out[..joints];
            let outside = motion.outside.as_ref();
            let outside = outside.map(|all| on_last(&chain, &all.at(i, &arm.outside_error)));
            let mut at = |q: &[f64], out: &mut [f64]| {
                let motion = [&q[..joints], &qd[..joints], &qdd[..joints]];
                link_states(&chain, DQuat::IDENTITY, gravity, motion, &mut along);
                torques_of(&chain, &along[..joints], out);
                if let Some(outside) = outside {
                    add_outside_wrench(&chain, &along[..joints], outside, out);
                }
            };
            at(&q, out);
            if arm.is_soft() {
                for j in 0..joints {
                    q[j] -= arm.drives[j].compliance * out[j];
                }
                at(&q, out);
            }
            for (carried, out) in carried.iter_mut().zip(out) {
                carried.push(*out);
            }
            links.extend_from_slice(&along[..joints]);
            if arm.wrench.is_some() {
                flange.push(along[joints - 1].motion().of_fixed(&chain.tip_from_last));
            }
        }
        Self {
            carried,
            flange: Arc::new(flange),
            links: Arc::new(links),
            chain,
        }
    }

    /// With the bodies of an arm whose links move as those of this course.
    #[must_use]
    pub fn with_bodies_of(&self, arm: &ArmParameters) -> Self {
        let joints = arm.joints();
        let chain = arm.loaded_chain();
        let mut carried = self.carried.clone();
        for place in 0..joints {
            let bodies = [&self.chain.joints[place].body, &chain.joints[place].body];
            if bodies[0] == bodies[1] {
                continue;
            }
            for (i, links) in self.links.chunks_exact(joints).enumerate() {
                let mut out = [0.0; MAX_JOINTS];
                add_change_of_body(&chain, links, place, bodies, &mut out);
                for (carried, change) in carried[..=place].iter_mut().zip(out) {
                    carried[i] += change;
                }
            }
        }
        Self {
            carried,
            flange: Arc::clone(&self.flange),
            links: Arc::clone(&self.links),
            chain,
        }
    }
}

/// A force and a moment on the flange, about the origin of the last link's frame and in its axes.
fn on_last(chain: &KinematicChain, outside: &OutsideWrench) -> (DVec3, DVec3) {
    let OutsideWrench { force, moment } = outside.seen_from(&chain.tip_from_last);
    (force, moment)
}

/// Torques by which pushes load the joints, by joint and sample [N m]; none where there is no push.
fn pushed(arm: &ArmParameters, motion: &Motion) -> Option<Vec<Vec<f64>>> {
    let own = || {
        let pushes = arm.pushes.iter();
        pushes.filter(|p| p.recording == motion.recording)
    };
    own().next()?;
    let joints = arm.joints();
    let mut all = vec![vec![0.0; motion.len()]; joints];
    let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
    for (i, time) in motion.time.iter().enumerate() {
        for push in own() {
            let share = push.share(*time);
            if share == 0.0 {
                continue;
            }
            let mut q = [0.0; MAX_JOINTS];
            for (q, position) in q.iter_mut().zip(&motion.position) {
                *q = position[i];
            }
            link_poses(
                &arm.chain,
                DPose3::IDENTITY,
                &q[..joints],
                &mut poses[..joints],
            );
            let flange = poses[joints - 1] * arm.chain.tip_from_last;
            let mut out = [0.0; MAX_JOINTS];
            let force = push.force * share;
            point_force_torques(
                &arm.chain,
                &poses[..joints],
                flange.translation,
                force,
                &mut out[..joints],
            );
            for (all, out) in all.iter_mut().zip(out) {
                all[i] += out;
            }
        }
    }
    Some(all)
}

/// Share of the sliding friction of each joint along a motion [1], for the lengths of the drives.
#[must_use]
pub fn all_bristles(arm: &ArmParameters, motion: &Motion) -> Vec<Vec<f64>> {
    let joints = motion.position.iter().zip(&arm.drives);
    joints
        .map(|(position, drive)| bristles(position, drive.bristle_length))
        .collect()
}

/// Moments of a joint along a motion.
pub fn moments<'a>(
    drive: &Drive,
    motion: &'a Motion,
    bristles: &'a [Vec<f64>],
    carried: &'a [Vec<f64>],
    joint: usize,
) -> impl Iterator<Item = JointMoment> + 'a {
    let (coulomb, length) = (drive.coulomb, drive.bristle_length);
    let varies = drive.static_excess != 0.0 || drive.load_friction != 0.0;
    let dry = varies.then(|| {
        let pairs = motion.speed[joint].iter().zip(&carried[joint]);
        let sliding: Vec<f64> = pairs.map(|(v, t)| sliding(drive, *v, *t)).collect();
        varying(&motion.position[joint], &sliding, length, coulomb)
    });
    (0..motion.len()).map(move |i| JointMoment {
        time: motion.time[i] - motion.time[0],
        position: motion.position[joint][i],
        speed: motion.speed[joint][i],
        acceleration: motion.acceleration[joint][i],
        bristles: bristles[joint][i],
        dry: dry.as_ref().map_or(coulomb * bristles[joint][i], |d| d[i]),
        carried: carried[joint][i],
    })
}

/// Readings of channels along a motion, by channel and sample. `bristles` and `rigid` are those of the arm.
#[must_use]
pub fn readings(
    arm: &ArmParameters,
    motion: &Motion,
    channels: &[Channel],
    bristles: &[Vec<f64>],
    rigid: &RigidCourse,
) -> Vec<Vec<f64>> {
    let pushed = pushed(arm, motion);
    let mut wrench: Option<Vec<[f64; 6]>> = None;
    let mut of = |channel: &Channel| match *channel {
        Channel::Drive(joint) => {
            let drive = &arm.drives[joint];
            let laws: Vec<_> = arm.laws.iter().filter(|l| l.joint == joint).collect();
            let torque = |(i, moment): (usize, JointMoment)| {
                let mut torque = moment.carried + own_torque(drive, &moment);
                torque += laws.iter().map(|law| law.torque(&moment)).sum::<f64>();
                if let Some(pushed) = &pushed {
                    torque -= pushed[joint][i];
                }
                torque * drive.inverse_gain
            };
            let all: Vec<f64> = moments(drive, motion, bristles, &rigid.carried, joint)
                .enumerate()
                .map(torque)
                .collect();
            delayed(&motion.time, &all, arm.delay)
        }
        Channel::Link(joint) => {
            let compliance = arm.drives[joint].compliance;
            let both = motion.position[joint].iter().zip(&rigid.carried[joint]);
            both.map(|(q, carried)| q - compliance * carried).collect()
        }
        Channel::Wrench(k) => {
            let all = wrench.get_or_insert_with(|| wrench_readings(arm, motion, rigid));
            all.iter().map(|r| r[k]).collect()
        }
    };
    channels.iter().map(&mut of).collect()
}

fn wrench_readings(arm: &ArmParameters, motion: &Motion, rigid: &RigidCourse) -> Vec<[f64; 6]> {
    let Some(sensor) = &arm.wrench else {
        return vec![[0.0; 6]; motion.len()];
    };
    let flange = rigid.flange.iter().zip(&motion.time).enumerate();
    flange
        .map(|(i, (flange, time))| {
            let outside = motion.outside.as_ref();
            let outside = outside.map(|all| all.at(i, &arm.outside_error));
            sensor.reading(
                &sensor.truth(flange, outside.as_ref()),
                time - motion.time[0],
            )
        })
        .collect()
}
