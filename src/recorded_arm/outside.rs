//! Force and moment from outside on the flange, known of a recording: a tool's contact, a mass that slides.
//!
//! ```text
//! tau = inverse dynamics - J^T (f, n + d x f)            w = w_tool + (f, n + (d - h e_z) x f),      f = f_0 + k f_drag
//! ```
//!
//! f force, n moment about the flange's origin, both in its axes; w what the tool does to a wrench sensor at the height h; f_drag the part of f that friction
//! of the tool is, k and d how far that and the point of the contact are off. Source: Featherstone, Rigid Body
//! Dynamics Algorithms, 2008, sec. 5.3 (external forces).

use glam::DVec3;
use glamx::DPose3;
use std::ops::Add;

/// Force and moment on the flange, about its origin and in its axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutsideWrench {
    /// Force [N].
    pub force: DVec3,
    /// Moment [N m].
    pub moment: DVec3,
}

impl OutsideWrench {
    /// Nothing.
    pub const ZERO: Self = Self {
        force: DVec3::ZERO,
        moment: DVec3::ZERO,
    };

    /// Of a force [N] at a point [m] of the flange's frame.
    #[must_use]
    pub fn at(point: DVec3, force: DVec3) -> Self {
        Self {
            force,
            moment: point.cross(force),
        }
    }

    /// In the axes and about the origin of another frame of the flange, in which this one is at a pose.
    #[must_use]
    pub fn seen_from(&self, pose: &DPose3) -> Self {
        let force = pose.rotation * self.force;
        Self {
            force,
            moment: pose.rotation * self.moment + pose.translation.cross(force),
        }
    }

    /// The moment about a point of the flange's frame [m].
    #[must_use]
    pub fn moment_about(&self, point: DVec3) -> DVec3 {
        self.moment - point.cross(self.force)
    }
}

/// What acts from outside over a recording, by sample.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outside {
    /// All of it.
    pub wrench: Vec<OutsideWrench>,
    /// The part of it that is friction of the tool.
    pub drag: Vec<OutsideWrench>,
}

/// How far what acts from outside is off what is known of it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OutsideError {
    /// Point at which it acts, in the flange's axes [m].
    pub point: DVec3,
    /// Friction of the tool, as a share of it [1].
    pub drag: f64,
}

impl Outside {
    /// What acts at a sample.
    #[must_use]
    pub fn at(&self, sample: usize, error: &OutsideError) -> OutsideWrench {
        let drag = &self.drag[sample];
        let more = OutsideWrench {
            force: error.drag * drag.force,
            moment: error.drag * drag.moment,
        };
        let mut all = self.wrench[sample] + more;
        all.moment += error.point.cross(all.force);
        all
    }
}

impl Add for OutsideWrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            moment: self.moment + other.moment,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::dynamics::{LinkState, add_outside_wrench, link_states};
    use crate::arm::kinematics::{link_poses, point_force_torques};
    use crate::arm::test_chains::random_chain;
    use glam::DQuat;

    /// By virtual work in the world: what a force at a point asks of the joints.
    #[test]
    fn a_force_at_a_point_takes_from_the_joints_what_virtual_work_says() {
        let chain = random_chain(7, 6);
        let q = [0.3, -0.8, 0.5, 1.1, -0.4, 0.9];
        let still = [0.0; 6];
        let (point, force) = (DVec3::new(0.03, -0.05, 0.2), DVec3::new(40.0, -70.0, 90.0));
        let mut poses = [DPose3::IDENTITY; 6];
        link_poses(&chain, DPose3::IDENTITY, &q, &mut poses);
        let flange = poses[5] * chain.tip_from_last;
        let mut expected = [0.0; 6];
        let at = flange.transform_point(point);
        point_force_torques(&chain, &poses, at, flange.rotation * force, &mut expected);
        let outside = Outside {
            wrench: vec![OutsideWrench::at(DVec3::ZERO, force)],
            drag: vec![OutsideWrench::ZERO],
        };
        // The point is where an error of it says.
        let error = OutsideError { point, drag: 0.3 };
        let own = outside.at(0, &error).seen_from(&chain.tip_from_last);
        let mut links = [LinkState::AT_REST; 6];
        link_states(
            &chain,
            DQuat::IDENTITY,
            DVec3::ZERO,
            [&q, &still, &still],
            &mut links,
        );
        let mut out = [0.0; 6];
        add_outside_wrench(&chain, &links, (own.force, own.moment), &mut out);
        for (taken, expected) in out.iter().zip(expected) {
            assert!((taken + expected).abs() < 1e-9, "{out:?} {expected:?}");
        }
    }
}
