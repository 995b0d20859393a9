//! What the part does to the tool at each sample of a recording: force of a contact and friction along the edge, at the point where the ball touches.
//!
//! ```text
//! f = F_n n - mu F_n sat(v/v_0) t
//! ```
//!
//! F_n contact force, n normal of the part, t tangent of the edge, v speed of the ball along it, mu friction of the tool.

use super::load::LoadedCell;
use crate::plant::ArmTrajectory;
use glam::DVec3;

/// A force on the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolContact {
    /// Point of the contact from the ball's centre, in the world's axes [m].
    pub from_centre: DVec3,
    /// Force on the tool, in the world's axes [N].
    pub force: DVec3,
    /// What of it is friction along the edge [N].
    pub drag: DVec3,
}

/// Contact at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Touching {
    /// Centre of the ball in the world [m].
    pub centre: DVec3,
    /// Normal of the part there [1].
    pub normal: DVec3,
    /// Share of the friction's full force along the edge, against its tangent [1].
    pub sliding: f64,
}

/// Speed along the edge at which friction is felt in full [m/s].
const SLIDING: f64 = 1e-3;

/// Where the ball of a trajectory touches at a sample that is neither the first nor the last, at a stroke [m].
pub(super) fn touching_at(trajectory: &ArmTrajectory, i: usize, stroke: f64) -> Touching {
    let span = trajectory.time[i + 1] - trajectory.time[i - 1];
    let edge = &trajectory.edge[i];
    let centre = |i: usize| trajectory.ball[i] + trajectory.slide[i] * stroke;
    let normal = match &trajectory.sharp {
        Some(sharp) => sharp.touch(centre(i), edge.station).normal,
        None => edge.bisector,
    };
    let speed = (centre(i + 1) - centre(i - 1)).dot(edge.tangent) / span;
    Touching {
        centre: centre(i),
        normal,
        sliding: (speed / SLIDING).clamp(-1.0, 1.0),
    }
}

impl LoadedCell {
    /// What the part does to the tool: strokes [m] and contact forces [N] by sample. Friction is that of a plant.
    pub fn tool_contacts(
        &self,
        trajectory: &ArmTrajectory,
        stroke: &[f64],
        force: &[f64],
        friction: f64,
    ) -> Vec<ToolContact> {
        let count = trajectory.len();
        let at = |i: usize| {
            // At the ends as beside them.
            let i = i.clamp(1, count.saturating_sub(2).max(1));
            let touching = touching_at(trajectory, i, stroke[i]);
            let drag = -trajectory.edge[i].tangent * (friction * touching.sliding * force[i]);
            ToolContact {
                from_centre: -touching.normal * self.scenario.nominal.mounting.tool_radius,
                force: touching.normal * force[i] + drag,
                drag,
            }
        };
        (0..count).map(at).collect()
    }
}
