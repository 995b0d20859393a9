//! Where the tool touches the edge, and how its axis stands there.
//!
//! The tool follows the edge with its axis along the bisector of the two faces, leaned from it about the edge, or along a direction of the world. At a corner the touching point stays
//! and the tool turns about it. Places along the path are measured by a length that counts the edge's own length and, at a corner, the angle turned times
//! `CORNER_RADIUS`.

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::error::PlanError;
use crate::workpiece::EdgeCurve;

/// Path length per angle turned at a corner [m/rad].
const CORNER_RADIUS: f64 = 0.03;
/// Distance beside a corner at which the edge's directions are read [m].
const BESIDE: f64 = 1e-6;

/// A place on the path, in the world frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolStation {
    /// Length of edge behind it [m].
    pub edge_length: f64,
    /// Point of the edge [m].
    pub point: DVec3,
    /// Direction of travel along the edge.
    pub tangent: DVec3,
    /// Outward bisector of the two faces: the nominal contact normal.
    pub normal: DVec3,
    /// Axis of the tool, from the flange towards the part.
    pub axis: DVec3,
}

/// How the tool's axis stands along an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToolAxis {
    /// Leaned about the edge from the bisector towards the left face [rad].
    Lean(f64),
    /// Along a direction of the world, a unit vector from the flange towards the part.
    Direction(DVec3),
}

/// Largest angle between the tool's axis and the edge's bisector [rad]: beyond it the device sees less than half of the contact force.
const MOST_LEAN: f64 = std::f64::consts::FRAC_PI_3;
/// Distance between the places at which that is checked [m].
const LEAN_SPACING: f64 = 1e-3;

/// Kind of a stretch of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stretch {
    /// Along the edge.
    Edge {
        /// Length of edge at its start [m].
        from: f64,
        /// And at its end [m].
        to: f64,
    },
    /// Turning about a corner.
    Corner {
        /// Before the turn.
        before: ToolStation,
        /// After it.
        after: ToolStation,
    },
}

/// A stretch with its length along the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolpathSection {
    /// Path length at its start [m].
    pub start: f64,
    /// Its path length [m].
    pub length: f64,
    /// Kind of the stretch.
    pub stretch: Stretch,
}

/// The path of the tool along an edge.
#[derive(Debug, Clone)]
pub struct ToolPath {
    curve: EdgeCurve,
    world_from_part: DPose3,
    tool_axis: ToolAxis,
    sections: Vec<ToolpathSection>,
}

impl ToolPath {
    /// Along all of `curve` (part frame).
    ///
    /// # Errors
    /// A corner that turns inwards, where a ball cannot reach the edge; a direction of the tool too far from the bisector.
    pub fn along(
        curve: EdgeCurve,
        world_from_part: DPose3,
        tool_axis: ToolAxis,
    ) -> Result<Self, PlanError> {
        let mut path = Self {
            curve,
            world_from_part,
            tool_axis,
            sections: Vec::new(),
        };
        let length = path.curve.length;
        let mut from = 0.0;
        let corners = path.curve.corner_stations();
        for &corner in corners
            .iter()
            .filter(|&&c| c > BESIDE && c < length - BESIDE)
        {
            path.push(corner - from, Stretch::Edge { from, to: corner });
            path.push_corner(corner)?;
            from = corner;
        }
        path.push(length - from, Stretch::Edge { from, to: length });
        path.check_lean()?;
        Ok(path)
    }

    /// Cosine between the tool's axis and the contact normal at a station of this path: the share of the contact force that the device sees [1].
    pub fn share(&self, station: &ToolStation) -> f64 {
        match self.tool_axis {
            ToolAxis::Lean(lean) => lean.cos(),
            ToolAxis::Direction(_) => -station.axis.dot(station.normal),
        }
    }

    /// A direction of the world may stand anyhow to an edge.
    fn check_lean(&self) -> Result<(), PlanError> {
        let ToolAxis::Direction(_) = self.tool_axis else {
            return Ok(());
        };
        let count = (self.length() / LEAN_SPACING).ceil().max(1.0) as usize;
        for index in 0..=count {
            let station = self.at(self.length() * index as f64 / count as f64);
            if self.share(&station) < MOST_LEAN.cos() - 1e-9 {
                return Err(PlanError::Lean {
                    edge_length: station.edge_length,
                    point: station.point,
                    lean: station.axis.angle_between(-station.normal),
                    most: MOST_LEAN,
                    axis: station.axis,
                    bisector: -station.normal,
                });
            }
        }
        Ok(())
    }

    fn push(&mut self, length: f64, stretch: Stretch) {
        let start = self.length();
        self.sections.push(ToolpathSection {
            start,
            length,
            stretch,
        });
    }

    fn push_corner(&mut self, corner: f64) -> Result<(), PlanError> {
        let before = self.on_edge(corner - BESIDE);
        let mut after = self.on_edge(corner + BESIDE);
        if after.tangent.dot(before.normal) > 0.02 {
            return Err(PlanError::InwardCorner {
                edge_length: corner,
                point: before.point,
                turn: before.tangent.angle_between(after.tangent),
            });
        }
        after.point = self
            .world_from_part
            .transform_point(self.curve.at(corner).point);
        let turned = before
            .axis
            .angle_between(after.axis)
            .max(before.normal.angle_between(after.normal));
        let before = ToolStation {
            point: after.point,
            edge_length: corner,
            ..before
        };
        after.edge_length = corner;
        self.push(CORNER_RADIUS * turned, Stretch::Corner { before, after });
        Ok(())
    }

    /// Length of the whole path [m].
    pub fn length(&self) -> f64 {
        self.sections
            .last()
            .map_or(0.0, |section| section.start + section.length)
    }

    /// Its sections in order.
    pub fn sections(&self) -> &[ToolpathSection] {
        &self.sections
    }

    /// The place at a path length [m], held at the ends.
    pub fn at(&self, place: f64) -> ToolStation {
        let index = self
            .sections
            .partition_point(|section| section.start <= place)
            .saturating_sub(1);
        let section = &self.sections[index];
        let share = ((place - section.start) / section.length).clamp(0.0, 1.0);
        match section.stretch {
            Stretch::Edge { from, to } => {
                // At a corner or at the seam of a loop the directions are those of this stretch.
                let inside = (from + share * (to - from)).clamp(from + BESIDE, to - BESIDE);
                self.on_edge(inside)
            }
            Stretch::Corner { before, after } => {
                let turn = |from: DVec3, to: DVec3| {
                    DQuat::IDENTITY.slerp(DQuat::from_rotation_arc(from, to), share) * from
                };
                ToolStation {
                    axis: turn(before.axis, after.axis),
                    normal: turn(before.normal, after.normal),
                    tangent: turn(before.tangent, after.tangent),
                    ..before
                }
            }
        }
    }

    fn on_edge(&self, edge_length: f64) -> ToolStation {
        let edge = self.curve.at(edge_length);
        let rotation = self.world_from_part.rotation;
        let normal = rotation * edge.bisector;
        let axis = match self.tool_axis {
            ToolAxis::Lean(lean) => {
                let side = edge.normal_a - edge.bisector * edge.normal_a.dot(edge.bisector);
                let outward = edge.bisector * lean.cos() + side.normalize_or_zero() * lean.sin();
                -(rotation * outward)
            }
            ToolAxis::Direction(axis) => axis,
        };
        ToolStation {
            edge_length,
            point: self.world_from_part.transform_point(edge.point),
            tangent: rotation * edge.tangent,
            normal,
            axis,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_1_SQRT_2;

    use super::*;
    use crate::workpiece::test_parts::cube;
    use crate::workpiece::{EdgeSearch, list_edges};

    fn round_the_top(lean: f64) -> ToolPath {
        let list = list_edges(&cube(), &EdgeSearch::default());
        let top = list
            .loops
            .iter()
            .find(|l| l.points.iter().all(|p| p.z > 0.099))
            .unwrap();
        ToolPath::along(top.clone(), DPose3::IDENTITY, ToolAxis::Lean(lean)).unwrap()
    }

    #[test]
    fn the_axis_leans_by_what_was_asked_and_the_normal_is_the_bisector() {
        for lean in [0.0, 0.2, -0.3] {
            let station = round_the_top(lean).at(0.05);
            assert!((station.normal.z - FRAC_1_SQRT_2).abs() < 1e-12);
            assert!((station.axis.dot(-station.normal) - f64::cos(lean)).abs() < 1e-12);
            assert!(station.axis.dot(station.tangent).abs() < 1e-12);
            // Positive lean stands the tool up, away from the side face.
            assert!((station.axis.z + (std::f64::consts::FRAC_PI_4 - lean).cos()).abs() < 1e-12);
        }
    }

    #[test]
    fn corners_are_turned_on_the_spot_and_everything_is_continuous() {
        let path = round_the_top(0.0);
        let corners = path
            .sections()
            .iter()
            .filter(|s| matches!(s.stretch, Stretch::Corner { .. }))
            .count();
        assert_eq!(corners, 3, "the loop starts and ends at the fourth");
        // Two bisectors of a cube's corner stand 60 degrees apart.
        let expected = 0.4 + 3.0 * CORNER_RADIUS * std::f64::consts::FRAC_PI_3;
        assert!((path.length() - expected).abs() < 1e-4, "{}", path.length());
        let steps = 20_000;
        let mut before = path.at(0.0);
        for i in 1..=steps {
            let now = path.at(path.length() * f64::from(i) / f64::from(steps));
            let bound = 1.5 * path.length() / f64::from(steps);
            assert!((now.point - before.point).length() < bound + 2e-6);
            assert!(now.axis.angle_between(before.axis) < bound / CORNER_RADIUS + 1e-5);
            before = now;
        }
    }

    #[test]
    fn a_corner_that_turns_inwards_is_refused() {
        let mut curve = round_the_top(0.0).curve;
        // Walls whose outside is their inside make every corner an inside corner.
        for (_, wall) in &mut curve.normals {
            *wall = -*wall;
        }
        let refused = ToolPath::along(curve, DPose3::IDENTITY, ToolAxis::Lean(0.0)).unwrap_err();
        assert!(
            matches!(refused, PlanError::InwardCorner { .. }),
            "{refused}"
        );
    }
}
