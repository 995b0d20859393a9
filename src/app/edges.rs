//! `idc edges`: what edges a part has.

use super::cli::{EdgesArguments, MeshUnit};
use super::error::{AppError, ExitCode};
use super::output::say;
use crate::workpiece::{EdgeSearch, list_edges, load_mesh};

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
    let mesh = load_mesh(&arguments.mesh, scale)?;
    let search = EdgeSearch {
        sharp_angle: angle.to_radians(),
        ..EdgeSearch::default()
    };
    say(&list_edges(&mesh, &search).table())?;
    Ok(ExitCode::Done)
}
