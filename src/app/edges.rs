//! `idc edges`: what edges a part has, as a list or as a page to pick one from.

mod faults;
mod page;
mod part;

use std::path::PathBuf;

use clap::Args;

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, is_same, prepare_file};
use super::output::say;
use super::progress;
use super::terminal::shown_path;
use crate::recording::atomic::write_text;
use crate::workpiece::{
    EdgeCurve, EdgeList, EdgeSearch, MeshFault, PartFile, TriangleMesh, WorkpieceError, list_edges,
};
use glam::DVec3;
use part::{MeshUnit, convexity, kind};

#[derive(Debug, Args)]
pub(super) struct EdgesArguments {
    /// Mesh file: STL, OBJ, COLLADA, PLY or glTF.
    mesh: PathBuf,
    /// Unit of the mesh file: mm, m or inch [default: the one that COLLADA and glTF state, which is m here; else mm].
    #[arg(long)]
    unit: Option<MeshUnit>,
    /// By how much two faces turn from one to the other for their edge to count as sharp: 180 less the angle between them [deg].
    #[arg(long, default_value_t = 30.0, allow_negative_numbers = true)]
    sharp_angle_deg: f64,
    /// File for a page with the part in 3D, on which edges are picked; its lines go into a scenario. Of a part that is refused it shows the faulty edges.
    #[arg(long, value_name = "PAGE.html", help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put the page in place of a file that --out names.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print them as JSON.
    #[arg(long, help_heading = "Output")]
    json: bool,
}

pub(super) fn list(arguments: &EdgesArguments) -> Result<ExitCode, AppError> {
    let angle = arguments.sharp_angle_deg;
    if !(1.0..=170.0).contains(&angle) {
        return Err(AppError::Option {
            option: "sharp-angle-deg",
            value: angle,
            expected: "1 to 170",
        });
    }
    if let Some(out) = &arguments.out
        && is_same(out, &arguments.mesh)
    {
        return Err(AppError::Overwrites {
            file: out.display().to_string(),
        });
    }
    let spinner = progress::spinner("looking for edges", arguments.json);
    let file = PartFile::read(&arguments.mesh)?;
    let unit = arguments.unit.unwrap_or(match file.states_unit {
        true => MeshUnit::M,
        false => MeshUnit::Mm,
    });
    let mesh = match file.mesh(unit.length()) {
        Ok(mesh) => mesh,
        Err(fault) => {
            spinner.finish_and_clear();
            return refused(arguments, &file, unit, fault);
        }
    };
    let search = EdgeSearch {
        sharp_angle: angle.to_radians(),
        ..EdgeSearch::default()
    };
    let list = list_edges(&mesh, &search);
    spinner.finish_and_clear();
    if let Some(out) = &arguments.out {
        let _claim = prepare_file(out, "--out", OverwritePolicy::of(arguments.force))?;
        write_text(
            out,
            &page::page((&arguments.mesh, unit, angle), &mesh, &list),
        )?;
    }
    say(&if arguments.json {
        json(arguments, &mesh, &list)
    } else {
        let notes = mesh.notes().iter().map(|note| format!("note: {note}\n"));
        list.table() + &notes.collect::<String>()
    })?;
    if let (Some(out), false) = (&arguments.out, arguments.json) {
        say(&format!("page written to {}\n", shown_path(out)))?;
    }
    Ok(ExitCode::Done)
}

/// A part that has no edges to list; where its surface has faults, the page shows them.
fn refused(
    arguments: &EdgesArguments,
    file: &PartFile,
    unit: MeshUnit,
    fault: MeshFault,
) -> Result<ExitCode, AppError> {
    if let (Some(out), MeshFault::NotClosed { edges }) = (&arguments.out, &fault) {
        let _claim = prepare_file(out, "--out", OverwritePolicy::of(arguments.force))?;
        let page = faults::page(&arguments.mesh, file, unit.length(), (&fault, edges));
        write_text(out, &page)?;
        if !arguments.json {
            say(&format!(
                "page of the faulty edges written to {}\n",
                shown_path(out)
            ))?;
        }
    }
    let file = arguments.mesh.clone();
    Err(WorkpieceError::Mesh { file, fault }.into())
}

/// The list for a program, in the part's frame.
fn json(arguments: &EdgesArguments, mesh: &TriangleMesh, list: &EdgeList) -> String {
    let mended = mesh.mended().iter().map(|mended| {
        let places = mended.places.iter();
        let places: Vec<_> = places.map(|place| (*place * 1e3).to_array()).collect();
        serde_json::json!({ "note": mended.note(), "places_mm": places })
    });
    let document = serde_json::json!({
        "mesh": arguments.mesh.display().to_string(),
        "sharp_angle_deg": arguments.sharp_angle_deg,
        "volume_mm3": mesh.volume() * 1e9,
        "notes": mesh.notes(),
        "mended": mended.collect::<Vec<_>>(),
        "edges": list.edges.iter().map(described).collect::<Vec<_>>(),
        "loops": list.loops.iter().map(described).collect::<Vec<_>>(),
    });
    format!("{document:#}\n")
}

fn described(curve: &EdgeCurve) -> serde_json::Value {
    let millimetres = |point: Option<&DVec3>| point.map(|point| (*point * 1e3).to_array());
    serde_json::json!({
        "id": curve.id,
        "kind": kind(curve),
        "length_mm": curve.length * 1e3,
        // Smallest and largest.
        "angle_deg": curve.face_angle_range().map(f64::to_degrees),
        "start_mm": millimetres(curve.points.first()),
        "end_mm": millimetres(curve.points.last()),
        "convexity": convexity(curve),
        "closed": curve.closed,
        "corners": curve.corners.len(),
    })
}
