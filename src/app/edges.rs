//! `idc edges`: what edges a part has.

use std::path::PathBuf;

use clap::Args;

use super::error::{AppError, ExitCode};
use super::output::say;
use super::progress;
use crate::workpiece::{
    Convexity, CurveKind, EdgeCurve, EdgeList, EdgeSearch, list_edges, load_mesh,
};
use glam::DVec3;

#[derive(Debug, Args)]
pub(super) struct EdgesArguments {
    /// Mesh file: STL, OBJ or COLLADA.
    mesh: PathBuf,
    /// Unit of the mesh file: mm, m or inch.
    #[arg(long, default_value = "mm")]
    unit: MeshUnit,
    /// Dihedral angle above which an edge counts as sharp [deg].
    #[arg(long, default_value_t = 30.0, allow_negative_numbers = true)]
    sharp_angle_deg: f64,
    /// Print them as JSON.
    #[arg(long, help_heading = "Output")]
    json: bool,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum MeshUnit {
    Mm,
    M,
    Inch,
}

pub(super) fn list(arguments: &EdgesArguments) -> Result<ExitCode, AppError> {
    let scale = match arguments.unit {
        MeshUnit::Mm => 1e-3,
        MeshUnit::M => 1.0,
        MeshUnit::Inch => 0.0254,
    };
    let angle = arguments.sharp_angle_deg;
    if !(1.0..=170.0).contains(&angle) {
        return Err(AppError::Option {
            option: "sharp-angle-deg",
            value: angle,
            expected: "1 to 170",
        });
    }
    let spinner = progress::spinner("looking for edges", arguments.json);
    let mesh = load_mesh(&arguments.mesh, scale)?;
    let search = EdgeSearch {
        sharp_angle: angle.to_radians(),
        ..EdgeSearch::default()
    };
    let list = list_edges(&mesh, &search);
    spinner.finish_and_clear();
    say(&if arguments.json {
        json(arguments, &list)
    } else {
        list.table()
    })?;
    Ok(ExitCode::Done)
}

/// The list for a program, in the part's frame.
fn json(arguments: &EdgesArguments, list: &EdgeList) -> String {
    let document = serde_json::json!({
        "mesh": arguments.mesh.display().to_string(),
        "sharp_angle_deg": arguments.sharp_angle_deg,
        "edges": list.edges.iter().map(described).collect::<Vec<_>>(),
        "loops": list.loops.iter().map(described).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}

fn described(curve: &EdgeCurve) -> serde_json::Value {
    let millimetres = |point: Option<&DVec3>| point.map(|point| (*point * 1e3).to_array());
    let kind = match curve.kind {
        CurveKind::Straight => "straight",
        CurveKind::Arc { .. } => "arc",
        CurveKind::Polyline => "polyline",
    };
    let convexity = match curve.convexity {
        Convexity::Convex => "convex",
        Convexity::Concave => "concave",
        Convexity::Mixed => "mixed",
    };
    serde_json::json!({
        "id": curve.id,
        "kind": kind,
        "length_mm": curve.length * 1e3,
        "start_mm": millimetres(curve.points.first()),
        "end_mm": millimetres(curve.points.last()),
        "convexity": convexity,
        "closed": curve.closed,
        "corners": curve.corners.len(),
    })
}
