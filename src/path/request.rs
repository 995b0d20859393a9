//! A job as it is asked for, and the stretches that it is planned in.

use crate::listed::listed;
use glam::DVec3;
use glamx::DPose3;

use super::error::{Obstacle, PlanError};
use super::profile::{MotionLimits, Profile};
use super::spline::Spline;
use super::toolpath::ToolPath;
use crate::arm::chain::{KinematicChain, MAX_JOINTS};
use crate::collision::{CollisionModel, Positions};

/// Distance between the knots of the joint angles' spline [m].
pub(super) const KNOT_SPACING: f64 = 1e-3;

listed! {
    /// Part of the job.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Phase,
    /// Its name.
    name: &'static str {
        /// Towards the edge.
        Approach = "approach",
        /// Onto the edge, then at rest until the force has settled.
        Engage = "engage",
        /// Along the edge.
        Follow = "follow",
        /// Away from it.
        Retract = "retract",
    }
}

/// Request of a plan.
#[derive(Clone)]
pub struct PlanRequest<'a> {
    /// The arm, base to flange.
    pub arm: &'a KinematicChain,
    /// The arm with the slide as its last joint.
    pub arm_with_slide: &'a KinematicChain,
    /// Its base in the world.
    pub world_from_base: DPose3,
    /// Gravity in the world [m/s2].
    pub gravity: DVec3,
    /// The tool's path.
    pub tool_path: ToolPath,
    /// Centre of the ball from the flange at the working stroke [m].
    pub tool_distance: f64,
    /// Radius of the ball [m].
    pub tool_radius: f64,
    /// Nominal penetration of the contact [m].
    pub penetration: f64,
    /// Stroke at which the device works [m].
    pub working_stroke: f64,
    /// Way that the slide is pushed back when the tool is set on the edge [m].
    pub push_back: f64,
    /// Largest desired force along the contact normal [N].
    pub force: f64,
    /// Coulomb friction coefficient between tool and part [1].
    pub friction: f64,
    /// Passes, at least one.
    pub passes: &'a [Pass],
    /// Feed past corners [m/s].
    pub corner_feed: f64,
    /// Largest acceleration across the path [m/s2]; infinite for a feed that does not fall where the edge bends.
    pub lateral_acceleration: f64,
    /// Acceleration and jerk along the path.
    pub limits: MotionLimits,
    /// Distance before the edge at which the motion starts [m].
    pub approach_distance: f64,
    /// Speed of approach and retraction [m/s].
    pub approach_speed: f64,
    /// Speed at which the tool is set on [m/s].
    pub engage_speed: f64,
    /// Time at rest on the edge [s].
    pub settle_time: f64,
    /// Bodies that must not meet; none are checked when absent.
    pub collision: Option<&'a CollisionModel>,
    /// Angle of the flange's x axis about the tool's axis from the direction of travel at the start of the edge [rad]; chosen when absent.
    pub roll: Option<f64>,
    /// Posture near which to look first [rad].
    pub seed_posture: Option<&'a [f64]>,
    /// Whether the reason of a pose that is not reached is left at how far it is: for those who try many jobs.
    pub briefly: bool,
    /// Seed of the search.
    pub seed: u64,
}

impl PlanRequest<'_> {
    /// Joint positions of arm and slide, with the tool backed off from the edge by a distance [m]: it stands at its outer end until it touches.
    pub(super) fn with_stroke(&self, angles: &[f64], back: f64) -> Positions {
        let mut positions = [0.0; MAX_JOINTS];
        positions[..angles.len()].copy_from_slice(angles);
        positions[angles.len()] = self.working_stroke + back.clamp(0.0, self.push_back);
        positions
    }

    /// Distance from the edge at which the motion starts [m].
    pub(super) fn far(&self) -> f64 {
        self.push_back + self.approach_distance
    }

    /// Force of the part on the tool while it follows the edge: contact force and friction against the motion [N].
    pub(super) fn force_on_tool(&self, normal: DVec3, tangent: DVec3) -> DVec3 {
        self.force * (normal - self.friction * tangent)
    }
}

/// A stretch of the job over which one spline runs.
#[derive(Debug, Clone)]
pub(super) struct Leg {
    pub(super) phase: Phase,
    /// Pass that it belongs to, from 0.
    pub(super) pass: usize,
    pub(super) start_time: f64,
    /// Motion, then rest until the next leg starts.
    pub(super) duration: f64,
    pub(super) profile: Profile,
    pub(super) spline: Spline,
    pub(super) way: Way,
}

/// Map of a leg's place to space.
#[derive(Debug, Clone, Copy)]
pub(super) enum Way {
    /// Along the tool's axis at a fixed place of the path: backed off by `from` at place 0 and moving by `sign`.
    Axial { place: f64, from: f64, sign: f64 },
    /// Along the edge.
    Edge,
    /// Back along the edge to its start, backed off from it [m].
    Back { from: f64 },
}

impl Way {
    /// Place on a path of a length [m] after a way of this leg [m].
    pub(super) fn place(self, along: f64, length: f64) -> f64 {
        match self {
            Self::Edge => along,
            Self::Axial { place, .. } => place,
            Self::Back { .. } => length - along,
        }
    }

    /// Distance by which the tool is backed off there [m].
    pub(super) fn backed_off(self, along: f64) -> f64 {
        match self {
            Self::Edge => 0.0,
            Self::Axial { from, sign, .. } => from + sign * along,
            Self::Back { from } => from,
        }
    }
}

/// A pass along the edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// Desired force along the contact normal [N].
    pub force: f64,
    /// Feed along the edge [m/s].
    pub feed: f64,
}

/// The error of a waypoint, counted from 0 here and from 1 in the message.
pub(super) fn waypoint_error(
    tool_path: &ToolPath,
    phase: Phase,
    index: usize,
    count: usize,
    place: f64,
    obstacle: Obstacle,
) -> PlanError {
    let station = tool_path.at(place);
    PlanError::Waypoint {
        phase: phase.name(),
        waypoint: index + 1,
        waypoints: count,
        edge_length: station.edge_length,
        point: station.point,
        obstacle,
    }
}
