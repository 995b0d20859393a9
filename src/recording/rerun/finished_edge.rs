//! Draws the edge before and after it was worked, beside its path.

use ::rerun::{LineStrips3D, Mesh3D, Radius, TextDocument};
use glam::DVec3;

use super::colours::{PURPLE, rerun_colour};
use super::options::SUMMARY;
use super::rrd::{RrdError, RrdWriter};
use crate::recording::finished_edge::FinishedEdge;
use crate::recording::scene::{Colour, Scene};

/// The burr before any work: a ribbon that stands on the edge.
pub(super) const BEFORE: &str = "/cell/edge/before";
/// The chamfer: a ribbon on either face, from the edge on.
pub(super) const AFTER: &str = "/cell/edge/after";
/// Burr that is left: a line at its height over the edge.
pub(super) const RESIDUAL_BURR: &str = "/cell/edge/residual_burr";

/// Colour of the burr that is gone, seen through.
const BURR: Colour = [170, 170, 170, 120];
/// Half width of the residual burr's line on the screen [points].
const RESIDUAL_RADIUS: f32 = 2.0;
/// Lift of the chamfer's ribbon off its face, so that the face does not shine through [m].
const LIFT: f64 = 0.2e-3;

/// Writes the edge before and after, of a run that worked it.
pub(super) fn write_finished_edge(
    rrd: &mut RrdWriter,
    edge: Option<&FinishedEdge>,
) -> Result<(), RrdError> {
    let Some(edge) = edge.filter(|edge| edge.points_in_world.len() > 1) else {
        return Ok(());
    };
    let factor = edge.factor();
    let tips = |heights: &[f64], station: usize| {
        edge.points_in_world[station] + factor * heights[station] * edge.outwards[station]
    };
    let stations = 0..edge.points_in_world.len();
    if edge.burr_before.iter().any(|height| *height > 0.0) {
        let ribbon = ribbon(stations.clone().map(|i| {
            let foot = edge.points_in_world[i];
            [foot, tips(&edge.burr_before, i)]
        }));
        let burr = ribbon.with_albedo_factor(*rerun_colour(BURR));
        rrd.add_static(BEFORE, &burr)?;
    }
    let chamfer = ribbon(stations.clone().map(|i| {
        let foot = edge.points_in_world[i] + LIFT * edge.outwards[i];
        let [left, right] =
            edge.into_faces[i].map(|into| foot + factor * edge.chamfer_leg[i] * into);
        [left, foot, right]
    }));
    let colours = stations.flat_map(|i| [rerun_colour(edge.colour(edge.chamfer_leg[i])); 3]);
    rrd.add_static(AFTER, &chamfer.with_vertex_colors(colours))?;
    let strips: Vec<Vec<[f32; 3]>> = (edge.burred().into_iter())
        .map(|stretch| {
            let mut strip: Vec<_> = stretch.map(|i| triple(tips(&edge.burr_after, i))).collect();
            // A single station is a point: a line of no length is not drawn.
            if let [point] = strip[..] {
                strip.push(point.map(|value| value + 1e-4));
            }
            strip
        })
        .collect();
    if strips.is_empty() {
        return Ok(());
    }
    let lines = LineStrips3D::new(strips)
        .with_colors([rerun_colour(PURPLE)])
        .with_radii([Radius::new_ui_points(RESIDUAL_RADIUS)]);
    rrd.add_static(RESIDUAL_BURR, &lines)
}

/// Writes the summary, and below it how to read the edge's colours; nothing where there is neither.
pub(super) fn write_summary(
    rrd: &mut RrdWriter,
    markdown: &str,
    scene: &Scene,
) -> Result<(), RrdError> {
    let legend = scene.finished_edge.as_ref().map(FinishedEdge::legend);
    let parts = (!markdown.is_empty()).then(|| markdown.to_owned());
    let parts: Vec<String> = parts.into_iter().chain(legend).collect();
    if parts.is_empty() {
        return Ok(());
    }
    let text = TextDocument::from_markdown(parts.join("\n\n"));
    rrd.add_static(SUMMARY, &text)
}

/// A band through rows of points across it. Without normals its colours are shown as they are, wherever the light comes from.
fn ribbon<const WIDTH: usize>(rows: impl Iterator<Item = [DVec3; WIDTH]>) -> Mesh3D {
    let points: Vec<[f32; 3]> = rows.flatten().map(triple).collect();
    let width = WIDTH as u32;
    let rows = points.len() as u32 / width;
    let quads = (1..rows).flat_map(|row| (1..width).map(move |column| row * width + column));
    let triangles = quads.flat_map(|corner| {
        let [left, below] = [corner - 1, corner - width];
        [[below - 1, below, corner], [below - 1, corner, left]]
    });
    Mesh3D::new(points).with_triangle_indices(triangles)
}

fn triple(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}
