//! From the commands of a recorded cell to what its device feels: the arm's trajectory along the part's edge.

mod drive_torque;
mod load;

pub use drive_torque::Drive;
pub use load::LoadedCell;

use crate::arm::chain::{BodyInertia, KinematicChain, MAX_JOINTS};
use crate::arm::dynamics::{inverse_dynamics, mass_matrix};
use crate::arm::kinematics::link_poses;
use crate::plant::{
    ArmTrajectory, EdgeStation, Followed, INERTIA_EVERY, JointTrajectory, MOST_JOINTS, Observation,
    SharpEdge, follow, shown,
};
use glam::{DMat3, DVec3};
use glamx::DPose3;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

const _: () = assert!(MAX_JOINTS == MOST_JOINTS);

/// Constants between the recordings of a cell.
#[derive(Debug, Clone)]
pub struct ReplayCell {
    /// The arm up to its flange.
    pub chain: KinematicChain,
    /// Pose of its base.
    pub world_from_base: DPose3,
    /// Gravity [m/s2].
    pub gravity: DVec3,
    /// The device's moving mass [kg].
    pub moving_mass: f64,
    /// Its centre from the flange at no stroke [m].
    pub mass_centre: f64,
    /// The ball's centre from the flange at no stroke [m].
    pub ball_centre: f64,
    /// Radius of the ball [m].
    pub ball_radius: f64,
    /// The device's stroke [m].
    pub full_stroke: f64,
    /// Middle of the edge.
    pub middle: EdgeStation,
    /// Standard deviation of the encoders' noise [rad].
    pub encoder_noise: f64,
    /// The edge as the ball meets it; none where it is met along its bisector.
    pub sharp: Option<Arc<SharpEdge>>,
    /// Its observation.
    pub observed: Observation,
}

/// Commands of one recording.
#[derive(Debug, Clone, Copy)]
pub struct Commands<'a> {
    /// Sample times [s].
    pub time: &'a [f64],
    /// Commanded angles of each joint [rad].
    pub joints: &'a [Vec<f64>],
    /// The edge where the commands have the ball.
    pub edge: &'a [EdgeStation],
    /// Readings of the joints' encoders [rad], where the trajectory is to be theirs; in place of it the commands' where there is none.
    pub encoders: Option<&'a [Option<Vec<f64>>]>,
}

impl ReplayCell {
    /// Stroke at which the moving mass is taken to be [m].
    fn usual_stroke(&self) -> f64 {
        0.5 * self.full_stroke
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
            observed: self.observed,
            middle: self.middle,
            ball_radius: self.ball_radius,
            jacobians: Vec::with_capacity(count),
            inertia: Vec::with_capacity(count / INERTIA_EVERY + 1),
            moving_mass: self.moving_mass,
            mass_behind_ball: self.ball_centre - self.mass_centre,
            usual_stroke: self.usual_stroke(),
            gravity: self.gravity,
        }
    }

    /// The arm's trajectory on commands, its servos of a bandwidth [Hz].
    pub fn trajectory(&self, commands: Commands<'_>, bandwidth: f64) -> ArmTrajectory {
        let count = commands.time.len();
        let moved = |(joint, command): (usize, &Vec<f64>)| {
            let led = follow(commands.time, command, bandwidth);
            let encoder = commands.encoders.and_then(|all| all[joint].as_deref());
            match encoder {
                Some(encoder) => shown(commands.time, &led, encoder, self.encoder_noise),
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
            link_poses(&self.chain, self.world_from_base, &q, &mut poses);
            // Where gravity and Coriolis torques are compensated, only what accelerates bends the springs.
            let gravity = if self.observed.gravity_on_joints {
                self.gravity
            } else {
                DVec3::ZERO
            };
            inverse_dynamics(
                &loaded,
                self.world_from_base.rotation,
                gravity,
                &q,
                &still,
                &qdd,
                &mut torques,
            );
            let last = poses.last().copied().unwrap_or(self.world_from_base);
            let flange = last * self.chain.tip_from_last;
            let slide = flange.rotation * DVec3::Z;
            let ball = flange.translation + slide * self.ball_centre;
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
                let own = &levers * levers.transpose() * self.moving_mass;
                trajectory.inertia.push(&masses - own);
            }
            trajectory.ball.push(ball);
            trajectory.slide.push(slide);
            trajectory.jacobians.push(trajectory.jacobian_at(i));
        }
        trajectory
    }

    /// The arm with the device's moving mass fixed at a stroke [m].
    fn loaded(&self, stroke: f64) -> KinematicChain {
        let mut chain = self.chain.clone();
        let device = BodyInertia {
            mass: self.moving_mass,
            centre_of_mass: DVec3::Z * (self.mass_centre + stroke),
            inertia: DMat3::ZERO,
        };
        let tip = chain.tip_from_last;
        if let Some(last) = chain.joints.last_mut() {
            last.body = last.body.welded_to(&device.seen_from(&tip));
        }
        chain
    }
}
