//! The arm's trajectory along the part's edge, from the commands of a recording.

use super::load::LoadedCell;
use crate::arm::chain::{BodyInertia, KinematicChain, MAX_JOINTS};
use crate::arm::dynamics::{inverse_dynamics, mass_matrix};
use crate::arm::kinematics::link_poses;
use crate::cell::station;
use crate::plant::{
    ArmTrajectory, EdgeStation, Followed, INERTIA_EVERY, JointTrajectory, MOST_JOINTS, follow,
    shown,
};
use glam::{DMat3, DVec3};
use glamx::DPose3;
use nalgebra::{DMatrix, DVector};

const _: () = assert!(MAX_JOINTS >= MOST_JOINTS);

/// Commands of one recording.
#[derive(Debug, Clone, Copy)]
struct Commands<'a> {
    /// Sample times [s].
    time: &'a [f64],
    /// Commanded angles of each joint [rad].
    joints: &'a [Vec<f64>],
    /// The edge where the commands have the ball.
    edge: &'a [EdgeStation],
    /// Readings of the joints' encoders [rad], where the trajectory is to be theirs; in place of it the commands' where there is none.
    encoders: Option<&'a [Option<Vec<f64>>]>,
}

impl LoadedCell {
    /// The arm's trajectory in a recording: times [s], commanded places along the edge [m] and angles of the joints [rad], servos of a bandwidth [Hz].
    pub fn trajectory(
        &self,
        time: &[f64],
        path: &[f64],
        joints: &[Vec<f64>],
        bandwidth: f64,
    ) -> ArmTrajectory {
        self.trajectory_of(time, path, joints, None, bandwidth)
    }

    /// The same where the encoders' readings [rad], of a cell whose motors do not keep to a law that is known, say where the joints went.
    pub fn trajectory_of(
        &self,
        time: &[f64],
        path: &[f64],
        joints: &[Vec<f64>],
        encoders: Option<&[Option<Vec<f64>>]>,
        bandwidth: f64,
    ) -> ArmTrajectory {
        let world_from_part = self.scenario.workpiece.world_from_part;
        let station = |place: &f64| station(&self.edge, world_from_part, *place);
        let edge: Vec<EdgeStation> = path.iter().map(station).collect();
        let commands = Commands {
            time,
            joints,
            edge: &edge,
            encoders: encoders.filter(|_| self.scenario.observed.motors_by_encoders),
        };
        self.along(commands, bandwidth)
    }

    /// Stroke at which the moving mass is taken to be [m].
    fn usual_stroke(&self) -> f64 {
        0.5 * self.scenario.nominal.device.full_stroke
    }

    /// A trajectory with what is the same at every sample, and the joints' motion.
    fn begun(
        &self,
        commands: Commands<'_>,
        bandwidth: f64,
        followed: &[Followed],
    ) -> ArmTrajectory {
        let count = commands.time.len();
        ArmTrajectory {
            time: commands.time.to_vec(),
            joints: followed
                .iter()
                .zip(commands.joints)
                .map(|(followed, command)| JointTrajectory {
                    command: command.clone(),
                    angle: followed.angle.clone(),
                    axis: Vec::with_capacity(count),
                    origin: Vec::with_capacity(count),
                    torque: Vec::with_capacity(count),
                    acceleration: followed.acceleration.clone(),
                })
                .collect(),
            bandwidth,
            ball: Vec::with_capacity(count),
            slide: Vec::with_capacity(count),
            edge: commands.edge.to_vec(),
            sharp: self.sharp.clone(),
            observed: self.scenario.observed,
            middle: self.middle,
            ball_radius: self.scenario.nominal.mounting.tool_radius,
            jacobians: Vec::with_capacity(count),
            inertia: Vec::with_capacity(count / INERTIA_EVERY + 1),
            moving_mass: self.scenario.nominal.device.moving_mass,
            mass_behind_ball: self.scenario.nominal.mounting.tool_centre
                - self.scenario.nominal.mounting.moving_centre_of_mass,
            usual_stroke: self.usual_stroke(),
            gravity: self.scenario.gravity,
        }
    }

    /// The arm's trajectory on commands, its servos of a bandwidth [Hz].
    fn along(&self, commands: Commands<'_>, bandwidth: f64) -> ArmTrajectory {
        let count = commands.time.len();
        let moved = |(joint, command): (usize, &Vec<f64>)| {
            let led = follow(commands.time, command, bandwidth);
            let encoder = commands.encoders.and_then(|all| all[joint].as_deref());
            match encoder {
                Some(encoder) => shown(commands.time, &led, encoder, self.scenario.joint_noise),
                None => led,
            }
        };
        let followed: Vec<_> = commands.joints.iter().enumerate().map(moved).collect();
        let loaded = self.loaded(self.usual_stroke());
        let joints = self.chain.len();
        let mut trajectory = self.begun(commands, bandwidth, &followed);
        let mut poses = vec![DPose3::IDENTITY; joints];
        let (mut q, mut qdd) = (vec![0.0; joints], vec![0.0; joints]);
        let still = vec![0.0; joints];
        let mut torques = vec![0.0; joints];
        let mut masses = DMatrix::zeros(joints, joints);
        let mut levers = DVector::zeros(joints);
        for i in 0..count {
            for (j, followed) in followed.iter().enumerate() {
                q[j] = followed.angle[i];
                qdd[j] = followed.acceleration[i];
            }
            link_poses(
                &self.chain,
                self.scenario.arm.world_from_base,
                &q,
                &mut poses,
            );
            // Where gravity and Coriolis torques are compensated, only what accelerates bends the springs.
            let gravity = if self.scenario.observed.gravity_on_joints {
                self.scenario.gravity
            } else {
                DVec3::ZERO
            };
            inverse_dynamics(
                &loaded,
                self.scenario.arm.world_from_base.rotation,
                gravity,
                &q,
                &still,
                &qdd,
                &mut torques,
            );
            let last = poses
                .last()
                .copied()
                .unwrap_or(self.scenario.arm.world_from_base);
            let flange = last * self.chain.tip_from_last;
            let slide = flange.rotation * DVec3::Z;
            let ball = flange.translation + slide * self.scenario.nominal.mounting.tool_centre;
            for (j, joint) in trajectory.joints.iter_mut().enumerate() {
                let axis = poses[j].rotation * self.chain.joints[j].axis;
                levers[j] = axis.cross(ball - poses[j].translation).dot(slide);
                joint.axis.push(axis);
                joint.origin.push(poses[j].translation);
                joint.torque.push(torques[j]);
            }
            if i.is_multiple_of(INERTIA_EVERY) {
                mass_matrix(&loaded, &q, &mut masses);
                // The slide lets the moving mass go its own way along its axis.
                let own = &levers * levers.transpose() * self.scenario.nominal.device.moving_mass;
                trajectory.inertia.push(&masses - own);
            }
            trajectory.ball.push(ball);
            trajectory.slide.push(slide);
            trajectory.jacobians.push(trajectory.jacobian_at(i));
        }
        trajectory
    }

    /// The arm with the device's moving mass fixed at a stroke [m].
    pub(super) fn loaded(&self, stroke: f64) -> KinematicChain {
        let mut chain = self.chain.clone();
        let device = BodyInertia {
            mass: self.scenario.nominal.device.moving_mass,
            centre_of_mass: DVec3::Z
                * (self.scenario.nominal.mounting.moving_centre_of_mass + stroke),
            inertia: DMat3::ZERO,
        };
        let tip = chain.tip_from_last;
        if let Some(last) = chain.joints.last_mut() {
            last.body = last.body.welded_to(&device.seen_from(&tip));
        }
        chain
    }
}
