//! Joint angles along a list of flange poses, and the postures to start with.
//!
//! Each pose is reached from the one before by plain Newton steps of least norm, always the same number, so that joint angles are as smooth as the poses.

use glam::{DQuat, DVec3};
use glamx::DPose3;
use nalgebra::{DMatrix, Vector6};

use super::error::Obstacle;
use super::request::PlanRequest;
use crate::arm::chain::{KinematicChain, MAX_JOINTS};
use crate::arm::dynamics::gravity_torques;
use crate::arm::inverse_kinematics::{IkOptions, TipOrientation, distinct_solutions, solve};
use crate::arm::kinematics::{
    Jacobian, is_singular_value_at_least, jacobian_at, link_poses, smallest_singular_value,
    tip_pose,
};

/// Least singular value of the scaled Jacobian that is accepted [1].
pub(super) const SINGULAR_LIMIT: f64 = 0.015;
/// That which is comfortable [1].
const COMFORTABLE: f64 = 0.15;
/// Newton steps to each pose; neighbouring poses need two or three, the coarse ones by which a posture is chosen up to six.
const STEPS: usize = 6;
/// Shortest part of the way between two neighbouring poses that is tried [1].
const SHORTEST: f64 = 1e-6;
/// Distance and angle up to which a pose counts as reached [m, rad].
const TOLERANCE: f64 = 1e-8;
/// Random starts for the first pose of each spin.
const STARTS: usize = 24;
/// Spins of the flange about the tool's axis that are tried.
const SPINS: usize = 12;
/// Height below the arm's base that no joint should go under [m].
const FLOOR: f64 = -0.05;

/// An arm that stands somewhere.
#[derive(Debug, Clone, Copy)]
pub struct MountedArm<'a> {
    /// The arm, base to flange.
    pub chain: &'a KinematicChain,
    /// The arm with the device's slide as its last joint.
    pub loaded: &'a KinematicChain,
    /// Stroke at which the slide stands [m].
    pub stroke: f64,
    /// Its base in the world.
    pub world_from_base: DPose3,
    /// Gravity in the world [m/s2].
    pub gravity: DVec3,
    /// Whether reasons are left at what is known without a search.
    pub briefly: bool,
}

impl<'a> MountedArm<'a> {
    /// The arm of a request.
    pub fn of(request: &PlanRequest<'a>) -> Self {
        Self {
            chain: request.arm,
            loaded: request.arm_with_slide,
            stroke: request.working_stroke,
            world_from_base: request.world_from_base,
            gravity: request.gravity,
            briefly: request.briefly,
        }
    }
}

impl MountedArm<'_> {
    /// Length by which lengths are scaled against angles [m].
    pub fn characteristic_length(&self) -> f64 {
        0.25 * self.chain.reach()
    }

    /// Smallest singular value of the scaled Jacobian at joint angles [1].
    pub fn singularity(&self, q: &[f64]) -> f64 {
        smallest_singular_value(
            &self.task_jacobian(q),
            self.chain.len(),
            self.characteristic_length(),
        )
    }

    /// Whether [`Self::singularity`] is at least so large.
    pub fn is_regular(&self, q: &[f64], least: f64) -> bool {
        let jacobian = self.task_jacobian(q);
        let length = self.characteristic_length();
        is_singular_value_at_least(&jacobian, self.chain.len(), length, least)
    }

    /// Jacobian of the flange; of an arm with five axes or less without the turning about the tool's axis, which it need not master.
    fn task_jacobian(&self, q: &[f64]) -> Jacobian {
        let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
        let poses = &mut poses[..self.chain.len()];
        link_poses(self.chain, self.world_from_base, q, poses);
        let tip = tip_pose(self.chain, self.world_from_base, q);
        let mut jacobian = jacobian_at(self.chain, poses, tip.translation);
        if self.chain.len() < 6 {
            let axis = tip.rotation * DVec3::Z;
            for mut column in jacobian.column_iter_mut() {
                let turning = DVec3::new(column[3], column[4], column[5]);
                let kept = turning - axis * axis.dot(turning);
                (column[3], column[4], column[5]) = kept.into();
            }
        }
        jacobian
    }

    /// Goes through all poses from `start`, which is near the first.
    ///
    /// # Errors
    /// The number of the pose that is not reached, and why.
    pub fn track(&self, poses: &[DPose3], start: &[f64]) -> Result<Vec<Vec<f64>>, (usize, Stop)> {
        let mut angles: Vec<Vec<f64>> = Vec::with_capacity(poses.len());
        for (index, pose) in poses.iter().enumerate() {
            let from = angles.last().map_or(start, Vec::as_slice);
            let next = self.next(pose, from).map_err(|stop| (index, stop))?;
            angles.push(next);
        }
        Ok(angles)
    }

    /// Joint angles at a pose, from those at one near it.
    ///
    /// # Errors
    /// Why it is not reached.
    pub(super) fn next(&self, pose: &DPose3, from: &[f64]) -> Result<Vec<f64>, Stop> {
        let mut q = from.to_vec();
        if !self.reach(pose, &mut q) {
            q = self.walk(pose, from)?;
        }
        match self.over_limit(&q) {
            Some(obstacle) => Err(Stop::Met(obstacle)),
            None => Ok(q),
        }
    }

    /// Newton steps to a pose; whether they led there.
    fn reach(&self, pose: &DPose3, q: &mut [f64]) -> bool {
        let mut error = f64::INFINITY;
        for _ in 0..STEPS {
            error = self.newton(pose, q);
        }
        let distance =
            (tip_pose(self.chain, self.world_from_base, q).translation - pose.translation).length();
        error < TOLERANCE && distance < TOLERANCE
    }

    /// Goes to a pose that Newton steps did not lead to, along the straight way there, in steps as short as it takes.
    fn walk(&self, pose: &DPose3, start: &[f64]) -> Result<Vec<f64>, Stop> {
        let from = tip_pose(self.chain, self.world_from_base, start);
        let (mut q, mut done, mut step) = (start.to_vec(), 0.0, 0.125f64);
        while done < 1.0 {
            let next = (done + step).min(1.0);
            let between = DPose3::from_parts(
                from.translation.lerp(pose.translation, next),
                from.rotation.slerp(pose.rotation, next),
            );
            let mut tried = q.clone();
            if self.reach(&between, &mut tried) {
                (q, done) = (tried, next);
            } else if step > SHORTEST {
                step *= 0.5;
            } else {
                return Err(Stop::NotReached {
                    pose: *pose,
                    from: q,
                });
            }
        }
        Ok(q)
    }

    /// One step; returns the error before it, angles scaled by 1 rad to 1 m.
    fn newton(&self, pose: &DPose3, q: &mut [f64]) -> f64 {
        let count = self.chain.len();
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        let links = &mut links[..count];
        link_poses(self.chain, self.world_from_base, q, links);
        let tip = links.last().copied().unwrap_or(self.world_from_base) * self.chain.tip_from_last;
        let jacobian = jacobian_at(self.chain, links, tip.translation);
        let shift = pose.translation - tip.translation;
        let turn = if count < 6 {
            tilt(tip.rotation * DVec3::Z, pose.rotation * DVec3::Z)
        } else {
            rotation_vector(pose.rotation * tip.rotation.inverse())
        };
        // A five-axis arm cannot choose the spin about the tool's axis, and need not.
        let axes: &[DVec3] = if count < 6 {
            &[pose.rotation * DVec3::X, pose.rotation * DVec3::Y]
        } else {
            &[DVec3::X, DVec3::Y, DVec3::Z]
        };
        let mut task = Jacobian::zeros();
        let mut error = Vector6::zeros();
        for (row, value) in shift.to_array().into_iter().enumerate() {
            error[row] = value;
        }
        for (row, axis) in axes.iter().enumerate() {
            error[3 + row] = axis.dot(turn);
        }
        for column in 0..count {
            for row in 0..3 {
                task[(row, column)] = jacobian[(row, column)];
            }
            let angular = DVec3::new(
                jacobian[(3, column)],
                jacobian[(4, column)],
                jacobian[(5, column)],
            );
            for (row, axis) in axes.iter().enumerate() {
                task[(3 + row, column)] = axis.dot(angular);
            }
        }
        let mut square = task * task.transpose();
        for row in 0..6 {
            // Rows that are not asked for lead nowhere.
            square[(row, row)] += if row < 3 + axes.len() { 1e-12 } else { 1.0 };
        }
        if let Some(factor) = square.cholesky() {
            let step = task.transpose() * factor.solve(&error);
            // A long step would leave the posture; the pose is then not near enough to follow.
            let scale = (0.3 / step.amax().max(1e-300)).min(1.0);
            for (angle, change) in q.iter_mut().zip(step.iter()) {
                *angle += scale * change;
            }
        }
        error.norm()
    }

    fn over_limit(&self, q: &[f64]) -> Option<Obstacle> {
        self.chain.joints.iter().zip(q).find_map(|(joint, &value)| {
            let limit = if value < joint.lower {
                joint.lower
            } else if value > joint.upper {
                joint.upper
            } else {
                return None;
            };
            Some(Obstacle::Position {
                axis: joint.name.clone(),
                value,
                limit,
            })
        })
    }

    fn options(&self, seed: u64) -> IkOptions {
        let orientation = if self.chain.len() < 6 {
            TipOrientation::FreeAboutZ
        } else {
            TipOrientation::Full
        };
        IkOptions {
            orientation,
            seed,
            ..IkOptions::default()
        }
    }

    /// Why a way ended.
    pub fn why(&self, stop: Stop) -> Obstacle {
        match stop {
            Stop::Met(obstacle) => obstacle,
            Stop::NotReached { pose, from } if self.briefly => {
                let tip = tip_pose(self.chain, self.world_from_base, &from);
                Obstacle::OutOfReach {
                    distance: (tip.translation - pose.translation).length(),
                    axis: None,
                }
            }
            Stop::NotReached { pose, from } => self.explain(&pose, &from),
        }
    }

    /// Why a pose is not reached.
    fn explain(&self, pose: &DPose3, start: &[f64]) -> Obstacle {
        match solve(
            self.chain,
            self.world_from_base,
            pose,
            start,
            &self.options(1),
        ) {
            Ok(solution) => {
                let (value, limit) = (self.singularity(start), SINGULAR_LIMIT);
                if value < limit {
                    return Obstacle::Singular {
                        value,
                        limit,
                        axis: self.weakest_axis(start),
                    };
                }
                let jump = |&index: &usize| (solution.q[index] - start[index]).abs();
                let most = (0..self.chain.len())
                    .max_by(|a, b| jump(a).total_cmp(&jump(b)))
                    .unwrap_or(0);
                Obstacle::PostureChange {
                    axis: self.chain.joints[most].name.clone(),
                    value: start[most],
                    needed: solution.q[most],
                }
            }
            Err(failure) => Obstacle::OutOfReach {
                distance: failure.position_error,
                // Where it is not reached without limits either, no axis is to blame.
                axis: failure
                    .axis
                    .filter(|_| failure.reachable_without_limits)
                    .map(|axis| (axis.name, axis.position, axis.limit)),
            },
        }
    }

    /// The axis that moves most along the direction in which the arm is weakest.
    pub fn weakest_axis(&self, q: &[f64]) -> String {
        let (count, jacobian) = (self.chain.len(), self.task_jacobian(q));
        let svd =
            DMatrix::from_fn(6, count, |row, column| jacobian[(row, column)]).svd(false, true);
        let (smallest, _) = svd.singular_values.argmin();
        let row = svd.v_t.map(|v_t| {
            v_t.row(smallest)
                .iter()
                .map(|x| x.abs())
                .collect::<Vec<f64>>()
        });
        let most = row.and_then(|row| (0..count).max_by(|&a, &b| row[a].total_cmp(&row[b])));
        most.map_or_else(String::new, |joint| self.chain.joints[joint].name.clone())
    }

    /// Comfort of joint angles, the least of: distance from singularity, from position limits, from torque limits under gravity, the device's included, and
    /// a force on the tool [N, world], each 1 where it is comfortable; negative below the floor. No more than `most`.
    pub(super) fn comfort(&self, q: &[f64], tool_force: DVec3, most: f64) -> f64 {
        let least = most.min(self.distance_from_limits(q, tool_force));
        // Most are farther from singularity than from some limit.
        match self.is_regular(q, COMFORTABLE * least) {
            true => least,
            false => least.min(self.singularity(q) / COMFORTABLE),
        }
    }

    /// Comfort of joint angles, the distance from singularity apart.
    fn distance_from_limits(&self, q: &[f64], tool_force: DVec3) -> f64 {
        let count = self.chain.len();
        let mut position = [0.0; MAX_JOINTS];
        position[..count].copy_from_slice(q);
        position[count] = self.stroke;
        let position = &position[..=count];
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        let links = &mut links[..=count];
        link_poses(self.loaded, self.world_from_base, position, links);
        let tool = links[count] * self.loaded.tip_from_last;
        let jacobian = jacobian_at(self.loaded, links, tool.translation);
        let mut comfort = f64::INFINITY;
        let mut torques = [0.0; MAX_JOINTS];
        gravity_torques(
            self.loaded,
            self.world_from_base.rotation,
            self.gravity,
            position,
            &mut torques[..=count],
        );
        for (index, joint) in self.chain.joints.iter().enumerate() {
            let margin = (q[index] - joint.lower).min(joint.upper - q[index]);
            let push = DVec3::new(
                jacobian[(0, index)],
                jacobian[(1, index)],
                jacobian[(2, index)],
            )
            .dot(tool_force);
            let spare = 1.0 - ((torques[index] - push).abs() + joint.friction) / joint.effort;
            comfort = comfort.min(margin / 0.5).min(spare / 0.3);
        }
        let up = -self.gravity.normalize_or_zero();
        let lowest = links
            .iter()
            .take(count)
            .skip(1)
            .map(|pose| up.dot(pose.translation - self.world_from_base.translation))
            .fold(f64::INFINITY, f64::min);
        if lowest < FLOOR {
            comfort.min(0.0) - 1.0
        } else {
            comfort
        }
    }

    /// Postures at the first pose: the one that a given posture leads to, or distinct ones.
    pub(super) fn starts(
        &self,
        pose: &DPose3,
        seed_posture: Option<&[f64]>,
        seed: u64,
    ) -> Vec<Vec<f64>> {
        let options = self.options(seed);
        let solutions: Vec<_> = match seed_posture {
            Some(posture) => {
                let options = IkOptions {
                    random_starts: 0,
                    ..options
                };
                let found = solve(self.chain, self.world_from_base, pose, posture, &options);
                found.into_iter().collect()
            }
            None => distinct_solutions(self.chain, self.world_from_base, pose, STARTS, &options),
        };
        solutions.into_iter().map(|solution| solution.q).collect()
    }

    /// Spins of the flange about the tool's axis that are tried [rad], or the one that is given.
    pub fn spins(&self, given: Option<f64>) -> Vec<f64> {
        let count = if self.chain.len() < 6 { 1 } else { SPINS };
        let all = (0..count).map(|i| i as f64 * std::f64::consts::TAU / count as f64);
        given.map_or_else(|| all.collect(), |spin| vec![spin])
    }
}

/// Where a way through poses ended; why is found out only of the one that is reported.
#[derive(Debug, Clone)]
pub enum Stop {
    /// At an obstacle.
    Met(Obstacle),
    /// Before a pose that was not reached.
    NotReached {
        /// The pose.
        pose: DPose3,
        /// Joint angles nearest to it [rad].
        from: Vec<f64>,
    },
}

/// Axis times angle of the shortest turn of one unit vector onto another.
fn tilt(from: DVec3, to: DVec3) -> DVec3 {
    let across = from.cross(to);
    let sine = across.length();
    if sine < 1e-300 {
        across
    } else {
        across * (sine.atan2(from.dot(to)) / sine)
    }
}

/// Axis times angle of a rotation, the shorter way round; exact for small angles, unlike glam's `to_scaled_axis` [rad].
pub(crate) fn rotation_vector(rotation: DQuat) -> DVec3 {
    let rotation = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    let sine = rotation.xyz().length();
    if sine < 1e-300 {
        return 2.0 * rotation.xyz();
    }
    rotation.xyz() * (2.0 * sine.atan2(rotation.w) / sine)
}
