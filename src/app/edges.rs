//! `idc edges`: what edges a part has.

use super::cli::{EdgesArguments, MeshUnit};
use super::error::{AppError, ExitCode};
use crate::workpiece::{EdgeSearch, list_edges, load_mesh};

pub(super) fn list(arguments: &EdgesArguments) -> Result<ExitCode, AppError> {
    let scale = match arguments.unit {
        MeshUnit::Mm => 1e-3,
        MeshUnit::M => 1.0,
        MeshUnit::Inch => 0.0254,
    };
    let mesh = load_mesh(&arguments.mesh, scale)?;
    let search = EdgeSearch { sharp_angle: arguments.sharp_angle_deg.to_radians(), ..EdgeSearch::default() };
    print!("{}", list_edges(&mesh, &search).table());
    Ok(ExitCode::Done)
}
