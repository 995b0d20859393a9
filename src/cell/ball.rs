//! Whether the tool's ball can follow the edge: how large a ball may be that touches it there and reaches into nothing else of the part.
//!
//! The largest ball about p + n r that touches a surface at p alone is found by shrinking (Ma, Bae, Choi, The Visual Computer 28, 2012): a point q of the surface
//! within the ball of radius r lies on that of
//!
//! ```text
//! r' = |q - p|^2 / (2 n (q - p))
//! ```
//!
//! p point of the edge, n bisector of its faces.

use glam::DVec3;

use super::error::CellError;
use super::part::Part;
use crate::collision::RIDDEN_ZONE;
use crate::scenario::Scenario;
use crate::workpiece::{ContactSurface, EdgeCurve, SurfaceContact};

/// Depth, of the ball's radius, to which it may reach into the edge elsewhere [1]: what a mesh's facets make of a bend.
const INTO_EDGE: f64 = 0.03;
/// The same of what it does not ride [1], as where the motion is checked.
const INTO_OTHERS: f64 = 0.1;
/// Balls above this multiple of the tool's are all the same [1].
const ENOUGH: f64 = 1.05;
/// Spacing of places, of the ball's radius [1], within bounds [m]; no more of them than this.
const SPACING: f64 = 0.1;
const SPACINGS: [f64; 2] = [2e-4, 1e-3];
const MOST_PLACES: f64 = 8000.0;
/// Distance beside a corner at which its sides are read [m].
const BESIDE: f64 = 1e-6;
/// Times that a ball is shrunk.
const TIMES: usize = 40;

/// The ball must touch the edge, and nothing else of the part, all along.
pub(super) fn check(scenario: &Scenario, part: &Part) -> Result<(), CellError> {
    let radius = scenario.nominal.mounting.tool_radius;
    let tightest = largest_balls(part, radius)
        .into_iter()
        .min_by(|a, b| a.1.total_cmp(&b.1));
    match tightest {
        Some((place, largest)) if largest < radius => Err(CellError::BallTooLarge {
            file: scenario.path.clone(),
            radius,
            largest,
            edge_length: place,
            point: (scenario.workpiece.world_from_part).transform_point(part.edge.at(place).point),
        }),
        _ => Ok(()),
    }
}

/// Places along the followed edge with the radius of the largest ball that can be there [m], no more than a little above the tool's.
#[must_use]
pub fn largest_balls(part: &Part, radius: f64) -> Vec<(f64, f64)> {
    let edge = &part.edge;
    let surface = ContactSurface::new(&part.mesh);
    let spacing = (SPACING * radius)
        .clamp(SPACINGS[0], SPACINGS[1])
        .max(edge.length / MOST_PLACES);
    let count = (edge.length / spacing).ceil().max(1.0) as usize;
    let even = (0..=count).map(|index| edge.length * index as f64 / count as f64);
    let beside = edge.corner_stations().into_iter();
    let beside = beside.flat_map(|corner| [corner - BESIDE, corner + BESIDE]);
    let mut places: Vec<f64> = even
        .chain(beside)
        .map(|place| place.clamp(0.0, edge.length))
        .collect();
    places.sort_by(f64::total_cmp);
    let mut contacts = Vec::new();
    let mut largest = |place: f64| shrunk(edge, &surface, place, ENOUGH * radius, &mut contacts);
    places
        .iter()
        .map(|&place| (place, largest(place)))
        .collect()
}

/// The largest ball at a place of the edge, at most of a radius [m].
fn shrunk(
    edge: &EdgeCurve,
    surface: &ContactSurface,
    place: f64,
    most: f64,
    contacts: &mut Vec<SurfaceContact>,
) -> f64 {
    let at = edge.at(place);
    let mut radius = most;
    for _ in 0..TIMES {
        let centre = at.point + at.bisector * radius;
        surface.genuine_contacts(centre, radius * (1.0 - INTO_EDGE), contacts);
        let met = contacts.iter().find(|contact| {
            let near = contact.distance < radius * (1.0 - INTO_OTHERS);
            near || distance_to(edge, contact.point) < RIDDEN_ZONE * radius
        });
        let Some(met) = met else {
            break;
        };
        let to = met.point - at.point;
        let ahead = at.bisector.dot(to);
        let touching = if ahead > 0.0 {
            0.5 * to.length_squared() / ahead
        } else {
            0.0
        };
        radius = touching.clamp(0.5 * radius, 0.99 * radius);
    }
    radius
}

/// Distance of a point from an edge [m].
fn distance_to(edge: &EdgeCurve, point: DVec3) -> f64 {
    let count = edge.normals.len();
    let pieces = (0..count).map(|index| {
        let from = edge.points[index];
        let along = edge.points[(index + 1) % edge.points.len()] - from;
        let share = (point - from).dot(along) / along.length_squared().max(1e-300);
        (point - from - along * share.clamp(0.0, 1.0)).length()
    });
    pieces.fold(f64::INFINITY, f64::min)
}
