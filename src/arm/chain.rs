//! A serial chain of one-axis joints, each carrying one rigid body.
//!
//! Link `i` moves with joint `i`; its frame is the frame of joint `i` after the joint's motion.
//! Whatever is rigidly fixed to a link (fixed joints, frozen grippers) is already part of it.

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;

/// Most joints a chain may hold: seven of an arm, its external axes, and the device at its end.
pub const MAX_JOINTS: usize = 10;

/// Motion of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about its axis; an endless (URDF `continuous`) joint has infinite position limits.
    Revolute,
    /// Slides along its axis.
    Prismatic,
}

/// Mass properties of a rigid body, in the axes of the link it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyInertia {
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass in the link frame [m].
    pub centre_of_mass: DVec3,
    /// Inertia about the centre of mass, in the link's axes [kg m2].
    pub inertia: DMat3,
}

/// One moving joint and the link behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name in the robot's file.
    pub name: String,
    /// Revolute or prismatic.
    pub kind: JointKind,
    /// Frame of the joint at zero, in the frame of the link before it (the base for the first).
    pub parent_from_joint: DPose3,
    /// Unit axis in the joint frame [-].
    pub axis: DVec3,
    /// Lower position limit [rad or m]; negative infinity for an endless joint.
    pub lower: f64,
    /// Upper position limit [rad or m]; infinity for an endless joint.
    pub upper: f64,
    /// Largest torque or force of the drive [N m or N].
    pub effort: f64,
    /// Largest speed [rad/s or m/s].
    pub velocity: f64,
    /// Viscous damping [N m s/rad or N s/m].
    pub damping: f64,
    /// Coulomb friction [N m or N].
    pub friction: f64,
    /// Mass properties of the link behind the joint.
    pub body: BodyInertia,
}

/// A serial chain from a base to a tip.
#[derive(Debug, Clone, PartialEq)]
pub struct KinematicChain {
    /// The moving joints, base first.
    pub joints: Vec<Joint>,
    /// Tip frame in the last link's frame.
    pub tip_from_last: DPose3,
}

impl BodyInertia {
    /// A body without mass.
    pub const ZERO: Self = Self {
        mass: 0.0,
        centre_of_mass: DVec3::ZERO,
        inertia: DMat3::ZERO,
    };

    /// The same body described in another frame, `frame_from_body` being the body's old frame in it.
    #[must_use]
    pub fn seen_from(&self, frame_from_body: &DPose3) -> Self {
        let rotation = DMat3::from_quat(frame_from_body.rotation);
        Self {
            mass: self.mass,
            centre_of_mass: frame_from_body.transform_point(self.centre_of_mass),
            inertia: rotation * self.inertia * rotation.transpose(),
        }
    }

    /// This body and `other` welded together; both in the same frame.
    #[must_use]
    pub fn welded_to(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return Self {
                mass,
                centre_of_mass: DVec3::ZERO,
                inertia: self.inertia + other.inertia,
            };
        }
        let centre_of_mass =
            (self.mass * self.centre_of_mass + other.mass * other.centre_of_mass) / mass;
        let about = |body: &Self| {
            body.inertia + point_mass_inertia(body.mass, body.centre_of_mass - centre_of_mass)
        };
        Self {
            mass,
            centre_of_mass,
            inertia: about(self) + about(other),
        }
    }
}

/// Inertia of a point mass [kg] at `offset` [m] about the origin (the parallel-axis term) [kg m2].
pub fn point_mass_inertia(mass: f64, offset: DVec3) -> DMat3 {
    let outer = DMat3::from_cols(offset * offset.x, offset * offset.y, offset * offset.z);
    (DMat3::from_diagonal(DVec3::splat(offset.length_squared())) - outer) * mass
}

impl Joint {
    /// Link frame in the parent link's frame at joint position `position` [rad or m].
    #[inline]
    pub fn parent_from_link(&self, position: f64) -> DPose3 {
        let fixed = &self.parent_from_joint;
        match self.kind {
            JointKind::Revolute => DPose3 {
                rotation: fixed.rotation * DQuat::from_axis_angle(self.axis, position),
                translation: fixed.translation,
            },
            JointKind::Prismatic => DPose3 {
                rotation: fixed.rotation,
                translation: fixed.translation + fixed.rotation * (self.axis * position),
            },
        }
    }

    /// Middle of the position limits, if both are finite [rad or m].
    pub fn middle(&self) -> Option<f64> {
        let middle = 0.5 * (self.lower + self.upper);
        middle.is_finite().then_some(middle)
    }
}

impl KinematicChain {
    /// Number of moving joints.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether the chain has no moving joint.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// Sum of the fixed offsets and finite strokes along the chain: no point of the tip is farther from
    /// the first joint than this [m].
    pub fn reach(&self) -> f64 {
        let offsets = self.joints.iter().skip(1).map(|joint| {
            let stroke = match joint.kind {
                JointKind::Revolute => 0.0,
                JointKind::Prismatic => joint.lower.abs().max(joint.upper.abs()),
            };
            joint.parent_from_joint.translation.length() + stroke
        });
        offsets.sum::<f64>() + self.tip_from_last.translation.length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_of_a_rod_weld_to_the_whole() {
        // A thin rod of mass m and length l along x has m l^2 / 12 about its middle.
        let half = |middle: f64| BodyInertia {
            mass: 1.5,
            centre_of_mass: DVec3::new(middle, 0.0, 0.0),
            inertia: DMat3::from_diagonal(DVec3::new(0.0, 1.5 / 12.0, 1.5 / 12.0)),
        };
        let whole = half(0.5).welded_to(&half(1.5));
        assert_eq!(whole.mass, 3.0);
        assert!((whole.centre_of_mass - DVec3::X).length() < 1e-15);
        let expected = DMat3::from_diagonal(DVec3::new(0.0, 1.0, 1.0));
        assert!((whole.inertia - expected).abs_diff_eq(DMat3::ZERO, 1e-14));
    }

    #[test]
    fn a_body_seen_from_a_turned_frame_keeps_its_principal_moments() {
        let body = BodyInertia {
            mass: 2.0,
            centre_of_mass: DVec3::new(0.1, 0.2, 0.3),
            inertia: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)),
        };
        let quarter_about_z = DPose3::from_parts(
            DVec3::new(0.0, 0.0, 1.0),
            DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
        );
        let seen = body.seen_from(&quarter_about_z);
        assert!((seen.centre_of_mass - DVec3::new(-0.2, 0.1, 1.3)).length() < 1e-15);
        let expected = DMat3::from_diagonal(DVec3::new(2.0, 1.0, 3.0));
        assert!(seen.inertia.abs_diff_eq(expected, 1e-14));
    }
}
