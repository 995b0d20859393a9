//! Force and moment from outside on the flange, known of a recording: a tool's contact, a mass that slides.
//!
//! ```text
//! tau = inverse dynamics - J^T (f, n)            w = w_tool + (f, n - h e_z x f)
//! ```
//!
//! f force, n moment about the flange's origin, both in its axes; w what the tool does to a wrench sensor at the height h. Source: Featherstone, Rigid Body
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

impl Add for OutsideWrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            moment: self.moment + other.moment,
        }
    }
}
