//! Where a cell's contact stands over one sample, seen along the slide: share of the stroke that goes into it, surface as a cubic of time.
//!
//! ```text
//! d = c (x - s)
//! ```
//!
//! On a sharp edge c and s are those of the tangent plane of the distance at the present stroke; over a sample they err by its curvature alone.

use super::arm_trajectory::{ArmTrajectory, ContactKinematics};
use super::cubic::Cubic;
use super::sharp_edge::SharpEdge;
use glam::DVec3;

/// The contact over one sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Riding {
    /// Share c [1].
    pub share: f64,
    /// Surface s [m].
    pub surface: Cubic,
    /// Normal of the part [1].
    pub normal: DVec3,
    /// Displacement of the ball by links that swing [m].
    pub away: DVec3,
    /// Length of the sample [s].
    pub length: f64,
}

impl Riding {
    /// From sample `i` on over `h` [s], the slide about a stroke [m], its links deflected away by a displacement [m].
    pub fn on(
        trajectory: &ArmTrajectory,
        sharp: &SharpEdge,
        kinematics: &ContactKinematics,
        (i, h): (usize, f64),
        stroke: f64,
        away: DVec3,
    ) -> Self {
        let last = trajectory.len() - 1;
        let next = (i + 1).min(last);
        // Seen from the part where it is.
        let centre =
            |j: usize| kinematics.balls[j] + kinematics.slides[j] * stroke - kinematics.aside[j];
        let middle = 0.5 * (centre(i) + centre(next)) + away;
        let touch = sharp.touch(middle, trajectory.edge[i].station);
        let normal = touch.normal;
        let share = -normal.dot(0.5 * (kinematics.slides[i] + kinematics.slides[next]));
        let from = middle - normal * touch.distance;
        let at =
            |j: usize| stroke + (normal.dot(centre(j) - from) - trajectory.ball_radius) / share;
        let slope = |j: usize| {
            let (before, after) = (j.saturating_sub(1), (j + 1).min(last));
            (at(after) - at(before)) / (trajectory.time[after] - trajectory.time[before])
        };
        let surface = Cubic::hermite(h, [at(i), at(next)], [slope(i), slope(next)]);
        Self {
            share,
            surface,
            normal,
            away,
            length: h,
        }
    }
}
