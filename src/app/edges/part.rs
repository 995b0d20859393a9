//! What the pages of a part's edges share: how it is drawn, how it, its unit, its edges and its places are called.

use std::path::Path;

use glam::DVec3;
use glamx::DPose3;

use super::super::picture::PART;
use super::super::space::MILLIMETRES;
use crate::arm::VisualShape;
use crate::scene::{Scene, SceneBody, ScenePoses, SceneShape};
use crate::workpiece::{Convexity, CurveKind, EdgeCurve};

/// Triangles of the part at most: about 2 MB of a page of less than 3 MB.
pub(super) const MOST_TRIANGLES: usize = 80_000;
/// From where a part is looked at.
pub(super) const EYE: DVec3 = DVec3::new(0.6, -1.0, 0.7);

/// Unit of a mesh file.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(super) enum MeshUnit {
    Mm,
    M,
    Inch,
}

impl MeshUnit {
    /// Its length [m].
    pub fn length(self) -> f64 {
        match self {
            Self::Mm => 1e-3,
            Self::M => 1.0,
            Self::Inch => 0.0254,
        }
    }

    /// As `mesh_unit` of a scenario has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::M => "m",
            Self::Inch => "inch",
        }
    }
}

/// A part's name.
pub(super) fn name_of(mesh: &Path) -> String {
    let name = mesh.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// The part alone, in its own frame.
pub(super) fn scene_of(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Scene {
    Scene {
        bodies: vec![SceneBody {
            entity: "workpiece".to_owned(),
            shapes: vec![SceneShape {
                body_from_shape: DPose3::IDENTITY,
                geometry: VisualShape::Mesh {
                    vertices,
                    triangles,
                },
                colour: PART,
            }],
            world_from_body: ScenePoses::Static(DPose3::IDENTITY),
        }],
        ..Scene::default()
    }
}

/// A place [mm] in words.
pub(super) fn place(point: DVec3) -> String {
    (MILLIMETRES * point).to_array().map(short).join(", ")
}

/// To a micrometre, or a thousandth of a degree, without zeros at its end.
pub(super) fn short(value: f64) -> String {
    // Adding 0 turns -0 into 0.
    ((1e3 * value).round() / 1e3 + 0.0).to_string()
}

/// Its form in a word.
pub(super) fn kind(curve: &EdgeCurve) -> &'static str {
    match curve.kind {
        CurveKind::Straight => "straight",
        CurveKind::Arc { .. } => "arc",
        CurveKind::Polyline => "polyline",
    }
}

/// Its side in a word.
pub(super) fn convexity(curve: &EdgeCurve) -> &'static str {
    match curve.convexity {
        Convexity::Convex => "convex",
        Convexity::Concave => "concave",
        Convexity::Mixed => "mixed",
    }
}
