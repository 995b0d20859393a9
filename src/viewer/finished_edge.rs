//! Draws the edge before and after it was worked, beside its path.

use ::rerun::{LineStrips3D, Mesh3D, Radius, TextDocument};
use glam::DVec3;

use super::colours::{PURPLE, rerun_colour};
use super::options::SUMMARY;
use super::rrd::{RrdError, RrdWriter};
use super::timelines::Axes;
use crate::scene::Scene;
use crate::scene::colour::Colour;
use crate::scene::finished_edge::FinishedEdge;

/// The burr before any work: a ribbon that stands on the edge.
pub(super) const BEFORE: &str = "/cell/edge/before";
/// The chamfer: a ribbon on either face, from the edge on.
pub(super) const AFTER: &str = "/cell/edge/after";
/// Burr that is left: a line at its height over the edge.
pub(super) const RESIDUAL_BURR: &str = "/cell/edge/residual_burr";

/// The burr that stands at a time.
pub(super) const BURR: &str = "/cell/edge/burr";

/// Colour of the burr before any work, seen through, and of that which stands.
const GONE: Colour = [170, 170, 170, 90];
const BURR_COLOUR: Colour = [214, 150, 72, 255];
/// Half width of the residual burr's line on the screen [points].
const RESIDUAL_RADIUS: f32 = 2.0;
/// Lift of the chamfer's ribbon off its face, so that the face does not shine through [m].
const LIFT: f64 = 0.2e-3;

/// Writes the edge before and after, of a run that worked it; with the samples' axes also how it came about.
pub(super) fn write_finished_edge(
    rrd: &mut RrdWriter,
    edge: Option<&FinishedEdge>,
    axes: Option<&Axes>,
) -> Result<(), RrdError> {
    let Some(edge) = edge.filter(|edge| edge.points_in_world.len() > 1) else {
        return Ok(());
    };
    let stations: Vec<usize> = (0..edge.points_in_world.len()).collect();
    if edge.burr_before.iter().any(|height| *height > 0.0) {
        let burr = burr_at(edge, &stations, &edge.burr_before);
        rrd.add_static(BEFORE, &burr.with_albedo_factor(*rerun_colour(GONE)))?;
    }
    let residual = residual_burr(edge);
    match axes.filter(|_| !edge.course.is_empty()) {
        None => {
            rrd.add_static(AFTER, &chamfer(edge, &stations, &edge.chamfer_leg))?;
            residual.map_or(Ok(()), |lines| rrd.add_static(RESIDUAL_BURR, &lines))
        }
        Some(axes) => {
            for moment in &edge.course {
                let at = |entity: &'static str| (entity, axes.columns(&[moment.sample]));
                let burr = burr_at(edge, &moment.stations, &moment.burr);
                let (entity, times) = at(BURR);
                rrd.add_row(
                    entity,
                    times,
                    &burr.with_albedo_factor(*rerun_colour(BURR_COLOUR)),
                )?;
                let (entity, times) = at(AFTER);
                rrd.add_row(entity, times, &chamfer(edge, &moment.stations, &moment.leg))?;
            }
            let end = edge.course.last().map_or(0, |moment| moment.sample);
            residual.map_or(Ok(()), |lines| {
                rrd.add_row(RESIDUAL_BURR, axes.columns(&[end]), &lines)
            })
        }
    }
}

/// Tip of a burr of a height [m] at a station.
fn tip(edge: &FinishedEdge, station: usize, height: f64) -> DVec3 {
    edge.points_in_world[station] + edge.factor() * height * edge.outwards[station]
}

/// A ribbon that stands on the edge at stations, as high as the burr there [m].
fn burr_at(edge: &FinishedEdge, stations: &[usize], heights: &[f64]) -> Mesh3D {
    let rows = stations.iter().zip(heights);
    ribbon(rows.map(|(i, height)| [edge.points_in_world[*i], tip(edge, *i, *height)]))
}

/// A ribbon on either face, as wide as the chamfer's leg at stations [m], in the colours of its error; of none where no chamfer is yet.
fn chamfer(edge: &FinishedEdge, stations: &[usize], legs: &[f64]) -> Mesh3D {
    let factor = edge.factor();
    let rows = stations.iter().zip(legs);
    let colours = (legs.iter()).flat_map(|leg| [rerun_colour(edge.colour(*leg)); 3]);
    let band = ribbon(rows.map(|(i, leg)| {
        let foot = edge.points_in_world[*i] + LIFT * edge.outwards[*i];
        let [left, right] = edge.into_faces[*i].map(|into| foot + factor * leg * into);
        [left, foot, right]
    }));
    band.with_vertex_colors(colours)
}

/// Lines at the height of the burr that is left, where it is more than may be.
fn residual_burr(edge: &FinishedEdge) -> Option<LineStrips3D> {
    let strips: Vec<Vec<[f32; 3]>> = (edge.burred().into_iter())
        .map(|stretch| {
            let points = stretch.map(|i| triple(tip(edge, i, edge.burr_after[i])));
            let mut strip: Vec<_> = points.collect();
            // A single station is a point: a line of no length is not drawn.
            if let [point] = strip[..] {
                strip.push(point.map(|value| value + 1e-4));
            }
            strip
        })
        .collect();
    (!strips.is_empty()).then(|| {
        LineStrips3D::new(strips)
            .with_colors([rerun_colour(PURPLE)])
            .with_radii([Radius::new_ui_points(RESIDUAL_RADIUS)])
    })
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
