//! Forward kinematics, geometric Jacobian and how near a pose is to a singularity.
//!
//! Jacobian columns: `axis x (point - joint)` over `axis` for a revolute joint, `axis` over zero for a
//! prismatic one, all in world axes (Siciliano et al., Robotics, 2009, sec. 3.1).

use crate::arm::chain::{JointKind, KinematicChain, MAX_JOINTS};
use glam::DVec3;
use glamx::DPose3;
use nalgebra::SMatrix;

/// Geometric Jacobian: rows linear x y z [m/rad or m/m], then angular x y z [rad/rad or rad/m];
/// one column a joint, columns past the chain's last joint are zero.
pub type Jacobian = SMatrix<f64, 6, MAX_JOINTS>;

/// Writes `world_from_link` of every link, base first.
///
/// `q` and `out` must have the chain's length.
pub fn link_poses(chain: &KinematicChain, world_from_base: DPose3, q: &[f64], out: &mut [DPose3]) {
    debug_assert!(q.len() == chain.len() && out.len() == chain.len());
    let mut world_from_link = world_from_base;
    for ((joint, position), pose) in chain.joints.iter().zip(q).zip(out) {
        world_from_link *= joint.parent_from_link(*position);
        *pose = world_from_link;
    }
}

/// `world_from_tip` at joint positions `q`.
pub fn tip_pose(chain: &KinematicChain, world_from_base: DPose3, q: &[f64]) -> DPose3 {
    debug_assert_eq!(q.len(), chain.len());
    let last = chain
        .joints
        .iter()
        .zip(q)
        .fold(world_from_base, |pose, (joint, position)| {
            pose * joint.parent_from_link(*position)
        });
    last * chain.tip_from_last
}

/// Jacobian of `point_in_world`, taken as rigidly on the last link, from poses of [`link_poses`].
#[inline]
pub fn jacobian_at(
    chain: &KinematicChain,
    world_from_link: &[DPose3],
    point_in_world: DVec3,
) -> Jacobian {
    let mut jacobian = Jacobian::zeros();
    for (index, (joint, pose)) in chain.joints.iter().zip(world_from_link).enumerate() {
        // The joint turns the link about its own axis, so the axis is the same in the moved frame.
        let axis = pose.rotation * joint.axis;
        let (linear, angular) = match joint.kind {
            JointKind::Revolute => (axis.cross(point_in_world - pose.translation), axis),
            JointKind::Prismatic => (axis, DVec3::ZERO),
        };
        let column = [
            linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
        ];
        jacobian.column_mut(index).copy_from_slice(&column);
    }
    jacobian
}

/// Torques [N m] and forces [N] by which a force [N] at a point of the last link drives the joints: J^T f, from poses of [`link_poses`].
#[inline]
pub fn point_force_torques(
    chain: &KinematicChain,
    world_from_link: &[DPose3],
    point_in_world: DVec3,
    force_in_world: DVec3,
    out: &mut [f64],
) {
    for ((joint, pose), torque) in chain.joints.iter().zip(world_from_link).zip(out) {
        let axis = pose.rotation * joint.axis;
        *torque = match joint.kind {
            JointKind::Revolute => {
                axis.dot((point_in_world - pose.translation).cross(force_in_world))
            }
            JointKind::Prismatic => axis.dot(force_in_world),
        };
    }
}

/// Jacobian of a point given in the last link's frame [m], at joint positions `q`.
pub fn geometric_jacobian(
    chain: &KinematicChain,
    world_from_base: DPose3,
    q: &[f64],
    point_in_last_link: DVec3,
) -> Jacobian {
    let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
    let poses = &mut poses[..chain.len()];
    link_poses(chain, world_from_base, q, poses);
    let last = poses.last().copied().unwrap_or(world_from_base);
    jacobian_at(chain, poses, last.transform_point(point_in_last_link))
}

/// Smallest singular value of the Jacobian with its linear rows divided by `characteristic_length` [m].
///
/// Dimensionless for revolute chains; zero where the chain cannot move the tip in some direction (or, with
/// fewer than six joints, where two joints do the same). Scaling: Angeles, Fundamentals of Robotic
/// Mechanical Systems, 2014, sec. 5.8.
pub fn smallest_singular_value(
    jacobian: &Jacobian,
    joints: usize,
    characteristic_length: f64,
) -> f64 {
    let values = singular_values(jacobian, characteristic_length);
    match joints.min(6) {
        0 => 0.0,
        rank => values[rank - 1],
    }
}

/// Whether [`smallest_singular_value`] is at least so large: by a factorisation, without the values.
///
/// ```text
/// s_min >= s  <=>  J J^T - s^2 I is positive definite  (J^T J with fewer than six joints)
/// ```
pub fn is_singular_value_at_least(
    jacobian: &Jacobian,
    joints: usize,
    characteristic_length: f64,
    least: f64,
) -> bool {
    if least <= 0.0 {
        return true;
    }
    let scaled = length_scaled(jacobian, characteristic_length);
    let mut square = if joints < 6 {
        let columns = scaled.fixed_columns::<6>(0);
        let mut square = columns.tr_mul(&columns);
        for past in joints..6 {
            square[(past, past)] = f64::MAX.sqrt();
        }
        square
    } else {
        scaled * scaled.transpose()
    };
    // To the safe side of rounding.
    let level = least * least * (1.0 + 1e-9);
    for row in 0..6 {
        square[(row, row)] -= level;
    }
    square.cholesky().is_some()
}

fn length_scaled(jacobian: &Jacobian, characteristic_length: f64) -> Jacobian {
    let mut scaled = *jacobian;
    scaled
        .fixed_rows_mut::<3>(0)
        .scale_mut(1.0 / characteristic_length);
    scaled
}

/// Singular values of the length-scaled Jacobian, largest first; see [`smallest_singular_value`].
pub fn singular_values(jacobian: &Jacobian, characteristic_length: f64) -> [f64; 6] {
    let scaled = length_scaled(jacobian, characteristic_length);
    let mut values: [f64; 6] = scaled.singular_values().into();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::test_chains::{planar_two_link, random_chain, random_positions};
    use glam::DQuat;

    #[test]
    fn a_force_drives_the_joints_by_the_transposed_jacobian() {
        let chain = random_chain(5, 7);
        let q = random_positions(3, chain.len());
        let mut poses = vec![DPose3::IDENTITY; chain.len()];
        link_poses(&chain, DPose3::IDENTITY, &q, &mut poses);
        let (point, force) = (DVec3::new(0.3, -0.2, 0.5), DVec3::new(4.0, -7.0, 11.0));
        let jacobian = jacobian_at(&chain, &poses, point);
        let mut torques = vec![0.0; chain.len()];
        point_force_torques(&chain, &poses, point, force, &mut torques);
        for (joint, torque) in torques.iter().enumerate() {
            let column = jacobian.column(joint);
            let expected = DVec3::new(column[0], column[1], column[2]).dot(force);
            assert!(
                (torque - expected).abs() < 1e-12,
                "{torque} against {expected}"
            );
        }
    }

    #[test]
    fn a_factorisation_says_on_which_side_of_a_limit_the_smallest_singular_value_lies() {
        for (seed, count) in [(1, 2), (2, 4), (3, 5), (4, 6), (5, 7), (6, 9)] {
            let chain = random_chain(seed, count);
            for draw in 0..20 {
                let q = random_positions(100 * seed + draw, count);
                let jacobian = geometric_jacobian(&chain, DPose3::IDENTITY, &q, DVec3::X);
                let value = smallest_singular_value(&jacobian, count, 0.3);
                let is =
                    |share: f64| is_singular_value_at_least(&jacobian, count, 0.3, share * value);
                assert!(is(0.999) && is(0.5) && is(-1.0), "{count} joints, {value}");
                assert!(!is(1.0) && !is(1.001), "{count} joints, {value}");
            }
        }
        let (planar, _) = planar_two_link();
        let stretched = geometric_jacobian(&planar, DPose3::IDENTITY, &[0.3, 0.0], DVec3::ZERO);
        assert!(!is_singular_value_at_least(&stretched, 6, 1.0, 1e-6));
    }

    #[test]
    fn planar_arm_matches_its_closed_form() {
        let (chain, lengths) = planar_two_link();
        let q = [0.4, -1.1];
        let tip = tip_pose(&chain, DPose3::IDENTITY, &q);
        // Turning about +z from x.
        let elbow = DVec3::new(q[0].cos(), q[0].sin(), 0.0) * lengths[0];
        let sum: f64 = q[0] + q[1];
        let expected = elbow + DVec3::new(sum.cos(), sum.sin(), 0.0) * lengths[1];
        assert!((tip.translation - expected).length() < 1e-15);
        assert!(
            tip.rotation
                .angle_between(DQuat::from_rotation_z(q[0] + q[1]))
                < 1e-7
        );
    }

    #[test]
    fn jacobian_matches_finite_differences() {
        for seed in 0..20 {
            let chain = random_chain(seed, 3 + seed as usize % 6);
            let q = random_positions(seed, chain.len());
            let base = DPose3::from_parts(
                DVec3::new(0.3, -0.2, 0.9),
                DQuat::from_rotation_x(0.7) * DQuat::from_rotation_z(0.2),
            );
            let point = chain.tip_from_last.translation;
            let jacobian = geometric_jacobian(&chain, base, &q, point);
            for index in 0..chain.len() {
                let step = 1e-6;
                let at = |sign: f64| {
                    let mut moved = q.clone();
                    moved[index] += sign * step;
                    tip_pose(&chain, base, &moved)
                };
                let (minus, plus) = (at(-1.0), at(1.0));
                let linear = (plus.translation - minus.translation) / (2.0 * step);
                let turn = plus.rotation * minus.rotation.inverse();
                let angular = turn.to_scaled_axis() / (2.0 * step);
                let column = jacobian.column(index);
                for row in 0..3 {
                    assert!((column[row] - linear[row]).abs() < 1e-8);
                    assert!((column[row + 3] - angular[row]).abs() < 1e-8);
                }
            }
            for index in chain.len()..MAX_JOINTS {
                assert_eq!(jacobian.column(index).norm(), 0.0);
            }
        }
    }

    #[test]
    fn stretched_planar_arm_is_singular() {
        let (chain, lengths) = planar_two_link();
        let tip = chain.tip_from_last.translation;
        let sigma = |q: [f64; 2]| {
            let jacobian = geometric_jacobian(&chain, DPose3::IDENTITY, &q, tip);
            // Only the plane's linear rows, so that the angular row does not hide the singularity.
            let mut planar = jacobian;
            planar.fixed_rows_mut::<3>(3).fill(0.0);
            (smallest_singular_value(&planar, 2, 1.0), planar)
        };
        assert!(sigma([0.3, 0.0]).0 < 1e-15);
        let (value, planar) = sigma([0.3, 1.2]);
        // Product of the singular values is |det J| = l1 l2 sin(q2).
        let product = singular_values(&planar, 1.0)[0] * value;
        assert!((product - lengths[0] * lengths[1] * 1.2f64.sin()).abs() < 1e-14);
    }
}
