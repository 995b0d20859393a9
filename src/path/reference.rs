//! Where a plan has arm and tool at a time.

use glam::DVec3;

use super::request::Phase;
use crate::arm::chain::MAX_JOINTS;

/// Where the arm and the tool should be at a time.
#[derive(Debug, Clone, Copy)]
pub struct Reference {
    /// Part of the job.
    pub phase: Phase,
    /// Pass, from 0.
    pub pass: usize,
    /// Joint angles [rad].
    pub position: [f64; MAX_JOINTS],
    /// Joint speeds [rad/s].
    pub velocity: [f64; MAX_JOINTS],
    /// Joint accelerations [rad/s2].
    pub acceleration: [f64; MAX_JOINTS],
    /// Length of edge behind the tool [m].
    pub edge_length: f64,
    /// Speed along the path [m/s]; zero off the edge.
    pub feed: f64,
    /// Nominal contact normal.
    pub normal: DVec3,
    /// Axis of the tool, towards the part.
    pub axis: DVec3,
    /// Direction of travel.
    pub tangent: DVec3,
    /// Where the ball's centre should be, at the working stroke [m].
    pub centre: DVec3,
    /// Cosine between the tool's axis and the contact normal: the share of the contact force that the device sees [1].
    pub share: f64,
}

impl Reference {
    /// Position, velocity and acceleration in the middle between this and a reference that comes `dt` [s] later, of the cubic through both; all else as there.
    #[must_use]
    pub fn middle(&self, later: &Self, dt: f64) -> Self {
        let mut middle = *later;
        for i in 0..MAX_JOINTS {
            let (from, to) = (self.position[i], later.position[i]);
            let (leaving, arriving) = (self.velocity[i], later.velocity[i]);
            middle.position[i] = 0.5 * (from + to) + 0.125 * dt * (leaving - arriving);
            middle.velocity[i] = 1.5 * (to - from) / dt - 0.25 * (leaving + arriving);
            middle.acceleration[i] = (arriving - leaving) / dt;
        }
        middle
    }
}
