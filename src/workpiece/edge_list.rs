//! The list of a part's edges, to choose one from by its id.

use glam::DVec3;

use super::curve::{Convexity, CurveKind, EdgeCurve};
use super::error::WorkpieceError;

/// The sharp edges of a part, in an order that depends on the mesh alone.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeList {
    /// Smooth chains, ordered by the faces they lie between, then by position.
    pub edges: Vec<EdgeCurve>,
    /// Closed outlines, ordered by the face they bound, then by position. An outline that bounds a
    /// face on either side is listed once, for the face that comes first.
    pub loops: Vec<EdgeCurve>,
}

impl EdgeList {
    /// The edge or loop of this id.
    ///
    /// # Errors
    /// There is none; the message names those there are.
    pub fn find(&self, id: &str) -> Result<&EdgeCurve, WorkpieceError> {
        let all = || self.edges.iter().chain(&self.loops);
        all().find(|curve| curve.id == id).ok_or_else(|| {
            let span = |curves: &[EdgeCurve]| match curves {
                [] => None,
                [only] => Some(only.id.clone()),
                [first, .., last] => Some(format!("{} to {}", first.id, last.id)),
            };
            let known: Vec<String> = [span(&self.edges), span(&self.loops)]
                .into_iter()
                .flatten()
                .collect();
            WorkpieceError::UnknownEdge {
                id: id.to_owned(),
                known: if known.is_empty() {
                    "none".to_owned()
                } else {
                    known.join(", ")
                },
            }
        })
    }

    /// A table of all edges and loops, one line each under a heading line.
    pub fn table(&self) -> String {
        let mut text = format!(
            "{:<9} {:<24} {:>10}  {:<26} {:<26} {:>10} {:<7} {:<6} {:>7}\n",
            "id",
            "kind",
            "length_mm",
            "start_mm",
            "end_mm",
            "angle_deg",
            "side",
            "closed",
            "corners"
        );
        for curve in self.edges.iter().chain(&self.loops) {
            text += &table_line(curve);
        }
        text
    }
}

fn table_line(curve: &EdgeCurve) -> String {
    let kind = match curve.kind {
        CurveKind::Straight => "straight".to_owned(),
        CurveKind::Arc { radius, angle } => {
            format!("arc r {:.3} x {:.1} deg", radius * 1e3, angle.to_degrees())
        }
        CurveKind::Polyline => format!("polyline of {}", curve.normals.len()),
    };
    // Adding 0 turns -0 into 0.
    let place = |point: DVec3| {
        let [x, y, z] = point
            .to_array()
            .map(|metres| (metres * 1e6).round() / 1e3 + 0.0);
        format!("({x:.3} {y:.3} {z:.3})")
    };
    let [low, high] = curve.face_angle_range().map(f64::to_degrees);
    let angle = if high - low < 0.1 {
        format!("{low:.1}")
    } else {
        format!("{low:.1}-{high:.1}")
    };
    let side = match curve.convexity {
        Convexity::Convex => "convex",
        Convexity::Concave => "concave",
        Convexity::Mixed => "mixed",
    };
    format!(
        "{:<9} {:<22} {:>10.3} {:<26} {:<26} {:>10} {:<7} {:<6} {:>7}\n",
        curve.id,
        kind,
        curve.length * 1e3,
        place(curve.points[0]),
        place(
            curve
                .at(if curve.closed { 0.0 } else { curve.length })
                .point
        ),
        angle,
        side,
        if curve.closed { "yes" } else { "no" },
        curve.corners.len()
    )
}
