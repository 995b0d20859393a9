//! Inverse dynamics, gravity torques and mass matrix of a chain.
//!
//! Inverse dynamics is the recursive Newton-Euler algorithm and the mass matrix the composite-rigid-body
//! algorithm (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapters 5 and 6), written with
//! three-vectors. Joint damping and friction are not part of either: they belong to the joints' drives.

use crate::arm::chain::{BodyInertia, Joint, JointKind, KinematicChain, MAX_JOINTS};
use crate::arm::kinematics::link_poses;
use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;
use nalgebra::DMatrix;

/// A link at an instant: where it is in the link before, and how it moves.
#[derive(Debug, Clone, Copy)]
pub struct LinkState {
    parent_from_link: DMat3,
    joint_in_parent: DVec3,
    motion: LinkMotion,
}

/// Motion of a link's frame, in its own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkMotion {
    /// Acceleration of its origin less gravity [m/s2].
    pub acceleration: DVec3,
    /// Angular velocity [rad/s].
    pub spin: DVec3,
    /// Angular acceleration [rad/s2].
    pub spin_rate: DVec3,
}

impl LinkMotion {
    /// Of a base at rest. A base that accelerates upwards is the same as gravity downwards.
    fn of_base(world_from_base: DQuat, gravity: DVec3) -> Self {
        Self {
            acceleration: -(world_from_base.inverse() * gravity),
            spin: DVec3::ZERO,
            spin_rate: DVec3::ZERO,
        }
    }

    /// Goes on to the link behind a joint, whose rotation and origin in the link before are returned.
    fn advance(&mut self, joint: &Joint, q: f64, qd: f64, qdd: f64) -> (DMat3, DVec3) {
        let pose = joint.parent_from_link(q);
        *self = self.of_fixed(&pose);
        let rate = joint.axis * qd;
        match joint.kind {
            JointKind::Revolute => {
                self.spin_rate += joint.axis * qdd + self.spin.cross(rate);
                self.spin += rate;
            }
            JointKind::Prismatic => {
                self.acceleration += joint.axis * qdd + 2.0 * self.spin.cross(rate);
            }
        }
        (DMat3::from_quat(pose.rotation), pose.translation)
    }

    /// Of a frame that is fixed to the link, in that frame's axes.
    #[must_use]
    pub fn of_fixed(&self, link_from_frame: &DPose3) -> Self {
        let arm = link_from_frame.translation;
        let frame_from_link = DMat3::from_quat(link_from_frame.rotation).transpose();
        let at_frame =
            self.acceleration + self.spin_rate.cross(arm) + self.spin.cross(self.spin.cross(arm));
        Self {
            acceleration: frame_from_link * at_frame,
            spin: frame_from_link * self.spin,
            spin_rate: frame_from_link * self.spin_rate,
        }
    }

    /// Force [N] and moment about the frame's origin [N m] that move a body so.
    pub fn wrench_of(&self, body: &BodyInertia) -> (DVec3, DVec3) {
        let (spin, spin_rate, centre) = (self.spin, self.spin_rate, body.centre_of_mass);
        let force = body.mass
            * (self.acceleration + spin_rate.cross(centre) + spin.cross(spin.cross(centre)));
        let moment =
            body.inertia * spin_rate + spin.cross(body.inertia * spin) + centre.cross(force);
        (force, moment)
    }
}

impl LinkState {
    /// Of a base at rest without gravity.
    pub const AT_REST: Self = Self {
        parent_from_link: DMat3::IDENTITY,
        joint_in_parent: DVec3::ZERO,
        motion: LinkMotion {
            acceleration: DVec3::ZERO,
            spin: DVec3::ZERO,
            spin_rate: DVec3::ZERO,
        },
    };

    /// How it moves.
    #[must_use]
    pub fn motion(&self) -> &LinkMotion {
        &self.motion
    }

    /// A force and a moment about the link's origin, in the axes and about the origin of the link before.
    fn in_parent(&self, (force, moment): (DVec3, DVec3)) -> (DVec3, DVec3) {
        let force = self.parent_from_link * force;
        let moment = self.parent_from_link * moment + self.joint_in_parent.cross(force);
        (force, moment)
    }
}

/// Writes the links of a chain at an instant; arguments as in [`inverse_dynamics`].
pub fn link_states(
    chain: &KinematicChain,
    world_from_base: DQuat,
    gravity: DVec3,
    [q, qd, qdd]: [&[f64]; 3],
    out: &mut [LinkState],
) {
    let mut motion = LinkMotion::of_base(world_from_base, gravity);
    for (index, joint) in chain.joints.iter().enumerate() {
        let (parent_from_link, joint_in_parent) =
            motion.advance(joint, q[index], qd[index], qdd[index]);
        out[index] = LinkState {
            parent_from_link,
            joint_in_parent,
            motion,
        };
    }
}

/// What a joint takes of a force and a moment about its origin [N m or N].
fn taken_by(joint: &Joint, (force, moment): (DVec3, DVec3)) -> f64 {
    match joint.kind {
        JointKind::Revolute => joint.axis.dot(moment),
        JointKind::Prismatic => joint.axis.dot(force),
    }
}

/// Adds to joint torques what another body in the place of one of a chain changes.
pub fn add_change_of_body(
    chain: &KinematicChain,
    links: &[LinkState],
    place: usize,
    [before, after]: [&BodyInertia; 2],
    out: &mut [f64],
) {
    let motion = &links[place].motion;
    let ((force, moment), (less, less_moment)) =
        (motion.wrench_of(after), motion.wrench_of(before));
    let mut wrench = (force - less, moment - less_moment);
    for index in (0..=place).rev() {
        out[index] += taken_by(&chain.joints[index], wrench);
        wrench = links[index].in_parent(wrench);
    }
}

/// Takes from joint torques what a force [N] and a moment [N m] from outside do, about the origin of the last link's frame and in its axes.
pub fn add_outside_wrench(
    chain: &KinematicChain,
    links: &[LinkState],
    (force, moment): (DVec3, DVec3),
    out: &mut [f64],
) {
    let mut wrench = (-force, -moment);
    for (index, (joint, link)) in chain.joints.iter().zip(links).enumerate().rev() {
        out[index] += taken_by(joint, wrench);
        wrench = link.in_parent(wrench);
    }
}

/// Joint torques [N m] and forces [N] that give accelerations `qdd` at positions `q` and speeds `qd`.
///
/// `world_from_base` turns base axes into world axes, `gravity` is in world axes [m/s2]. The slices must
/// have the chain's length, which is at most [`MAX_JOINTS`]. Allocates nothing.
pub fn inverse_dynamics(
    chain: &KinematicChain,
    world_from_base: DQuat,
    gravity: DVec3,
    q: &[f64],
    qd: &[f64],
    qdd: &[f64],
    out: &mut [f64],
) {
    let count = chain.len();
    assert!(
        count <= MAX_JOINTS,
        "a chain holds at most {MAX_JOINTS} joints"
    );
    let motion = [&q[..count], &qd[..count], &qdd[..count]];
    let mut links = [LinkState::AT_REST; MAX_JOINTS];
    link_states(chain, world_from_base, gravity, motion, &mut links);
    torques_of(chain, &links[..count], &mut out[..count]);
}

/// Joint torques [N m] and forces [N] that move the bodies of a chain as its links move.
pub fn torques_of(chain: &KinematicChain, links: &[LinkState], out: &mut [f64]) {
    let mut wrench = (DVec3::ZERO, DVec3::ZERO);
    for (index, (joint, link)) in chain.joints.iter().zip(links).enumerate().rev() {
        let (force, moment) = link.motion.wrench_of(&joint.body);
        wrench = (wrench.0 + force, wrench.1 + moment);
        out[index] = taken_by(joint, wrench);
        wrench = link.in_parent(wrench);
    }
}

/// Joint torques [N m] and forces [N] that hold the chain still against gravity [m/s2, world axes].
pub fn gravity_torques(
    chain: &KinematicChain,
    world_from_base: DQuat,
    gravity: DVec3,
    q: &[f64],
    out: &mut [f64],
) {
    let still = [0.0; MAX_JOINTS];
    let still = &still[..chain.len()];
    inverse_dynamics(chain, world_from_base, gravity, q, still, still, out);
}

/// Writes the joint-space mass matrix [kg m2, kg m or kg] at positions `q`.
///
/// `out` must be square and of the chain's length. Neither the base's pose nor gravity enters.
pub fn mass_matrix(chain: &KinematicChain, q: &[f64], out: &mut DMatrix<f64>) {
    let count = chain.len();
    assert_eq!(out.shape(), (count, count), "one row and column a joint");
    let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
    let poses = &mut poses[..count];
    link_poses(chain, DPose3::IDENTITY, q, poses);
    let mut composite = BodyInertia::ZERO;
    for (column, joint) in chain.joints.iter().enumerate().rev() {
        composite = joint.body.seen_from(&poses[column]).welded_to(&composite);
        let axis = poses[column].rotation * joint.axis;
        let centre = composite.centre_of_mass;
        // Force at the composite's centre of mass and moment about it for unit joint acceleration.
        let (force, moment) = match joint.kind {
            JointKind::Revolute => (
                composite.mass * axis.cross(centre - poses[column].translation),
                composite.inertia * axis,
            ),
            JointKind::Prismatic => (composite.mass * axis, DVec3::ZERO),
        };
        for row in 0..=column {
            let row_axis = poses[row].rotation * chain.joints[row].axis;
            let value = match chain.joints[row].kind {
                JointKind::Revolute => {
                    let arm = centre - poses[row].translation;
                    row_axis.dot(moment + arm.cross(force))
                }
                JointKind::Prismatic => row_axis.dot(force),
            };
            out[(row, column)] = value;
            out[(column, row)] = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::test_chains::{
        planar_two_link, random_chain, random_positions, vertical_pendulum,
    };

    const DOWN: DVec3 = DVec3::new(0.0, 0.0, -9.81);

    fn torques(
        chain: &KinematicChain,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
        gravity: DVec3,
    ) -> Vec<f64> {
        let mut out = vec![0.0; chain.len()];
        let turned = DQuat::from_rotation_y(0.3);
        inverse_dynamics(chain, turned, gravity, q, qd, qdd, &mut out);
        out
    }

    fn mass(chain: &KinematicChain, q: &[f64]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(chain.len(), chain.len());
        mass_matrix(chain, q, &mut out);
        out
    }

    #[test]
    fn pendulum_torque_is_its_closed_form() {
        let (chain, mass, length, inertia) = vertical_pendulum();
        // Angle from hanging straight down.
        let (angle, acceleration): (f64, f64) = (0.6, 1.7);
        let mut out = [0.0];
        let q = [angle];
        inverse_dynamics(
            &chain,
            DQuat::IDENTITY,
            DOWN,
            &q,
            &[2.0],
            &[acceleration],
            &mut out,
        );
        let expected =
            (inertia + mass * length * length) * acceleration + mass * 9.81 * length * angle.sin();
        assert!((out[0] - expected).abs() < 1e-13);
    }

    #[test]
    fn planar_two_link_matches_the_textbook() {
        // Two point masses at the link ends (Siciliano et al. 2009, sec. 7.3.2), gravity along -y.
        let (chain, [l1, l2]) = planar_two_link();
        let (m1, m2) = (chain.joints[0].body.mass, chain.joints[1].body.mass);
        let (q, qd, qdd) = ([0.7, -1.3], [0.9, -0.4], [1.1, 2.3]);
        let mut out = [0.0; 2];
        let gravity = DVec3::new(0.0, -9.81, 0.0);
        inverse_dynamics(&chain, DQuat::IDENTITY, gravity, &q, &qd, &qdd, &mut out);
        let (c1, c12) = (q[0].cos(), (q[0] + q[1]).cos());
        let (s2, c2) = q[1].sin_cos();
        let m12 = m2 * (l2 * l2 + l1 * l2 * c2);
        let m11 = m1 * l1 * l1 + m2 * (l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * c2);
        let h = m2 * l1 * l2 * s2;
        let first = m11 * qdd[0] + m12 * qdd[1] - h * (2.0 * qd[0] * qd[1] + qd[1] * qd[1])
            + 9.81 * ((m1 + m2) * l1 * c1 + m2 * l2 * c12);
        let second =
            m12 * qdd[0] + m2 * l2 * l2 * qdd[1] + h * qd[0] * qd[0] + 9.81 * m2 * l2 * c12;
        assert!((out[0] - first).abs() < 1e-12 && (out[1] - second).abs() < 1e-12);
    }

    #[test]
    fn mass_matrix_is_symmetric_positive_definite_and_agrees_with_newton_euler() {
        for seed in 0..20 {
            let chain = random_chain(seed, 2 + seed as usize % 7);
            let q = random_positions(seed, chain.len());
            let qd = random_positions(seed + 100, chain.len());
            let qdd = random_positions(seed + 200, chain.len());
            let matrix = mass(&chain, &q);
            assert_eq!(matrix, matrix.transpose());
            assert!(matrix.clone().cholesky().is_some());
            let still = vec![0.0; chain.len()];
            let with = torques(&chain, &q, &qd, &qdd, DOWN);
            let without = torques(&chain, &q, &qd, &still, DOWN);
            let expected = &matrix * nalgebra::DVector::from_column_slice(&qdd);
            let scale = matrix.norm();
            for index in 0..chain.len() {
                assert!((with[index] - without[index] - expected[index]).abs() < 1e-13 * scale);
            }
        }
    }

    #[test]
    fn gravity_torques_are_the_gradient_of_height() {
        let chain = random_chain(3, 7);
        let q = random_positions(3, 7);
        let turned = DQuat::from_rotation_y(0.3);
        let mut out = vec![0.0; 7];
        gravity_torques(&chain, turned, DOWN, &q, &mut out);
        let potential = |q: &[f64]| potential_energy(&chain, turned, q);
        for index in 0..7 {
            let at = |step: f64| {
                let mut moved = q.clone();
                moved[index] += step;
                potential(&moved)
            };
            let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
            assert!((out[index] - slope).abs() < 1e-6);
        }
    }

    fn potential_energy(chain: &KinematicChain, turned: DQuat, q: &[f64]) -> f64 {
        let mut poses = vec![DPose3::IDENTITY; chain.len()];
        link_poses(chain, DPose3::from_rotation(turned), q, &mut poses);
        let bodies = chain.joints.iter().zip(&poses);
        bodies
            .map(|(joint, pose)| {
                let centre = pose.transform_point(joint.body.centre_of_mass);
                -joint.body.mass * DOWN.dot(centre)
            })
            .sum()
    }

    #[test]
    fn freely_swinging_chain_keeps_its_energy() {
        // Velocity terms do no net work: RK4 keeps kinetic plus potential energy to the method's order.
        let chain = random_chain(11, 3);
        let turned = DQuat::from_rotation_y(0.3);
        let acceleration = |q: &[f64], qd: &[f64]| {
            let bias = torques(&chain, q, qd, &[0.0; 3], DOWN);
            let bias = nalgebra::DVector::from_column_slice(&bias);
            let solved = mass(&chain, q).cholesky().expect("definite").solve(&-bias);
            solved.as_slice().to_vec()
        };
        let energy = |state: &[f64]| {
            let speed = nalgebra::DVector::from_column_slice(&state[3..]);
            let kinetic = 0.5 * (speed.transpose() * mass(&chain, &state[..3]) * &speed)[0];
            (
                kinetic,
                kinetic + potential_energy(&chain, turned, &state[..3]),
            )
        };
        let slope = |state: &[f64]| {
            let mut rate = state[3..].to_vec();
            rate.extend(acceleration(&state[..3], &state[3..]));
            rate
        };
        let ahead = |state: &[f64], rate: &[f64], step: f64| -> Vec<f64> {
            state.iter().zip(rate).map(|(x, r)| x + step * r).collect()
        };
        let mut state = vec![0.4, -0.3, 0.8, 0.0, 0.0, 0.0];
        let start = energy(&state).1;
        let (step, mut most_kinetic) = (2e-4, 0.0f64);
        for _ in 0..2500 {
            let k1 = slope(&state);
            let k2 = slope(&ahead(&state, &k1, 0.5 * step));
            let k3 = slope(&ahead(&state, &k2, 0.5 * step));
            let k4 = slope(&ahead(&state, &k3, step));
            for i in 0..6 {
                state[i] += step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
            most_kinetic = most_kinetic.max(energy(&state).0);
        }
        assert!(most_kinetic > 0.5, "the chain must really swing");
        let drift = (energy(&state).1 - start).abs() / most_kinetic;
        assert!(drift < 1e-8, "energy drift {drift}");
    }
}
