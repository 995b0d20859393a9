//! Scenes as drawings that are turned on a page.

use glam::{DQuat, DVec3};

use crate::document::{Drawing, DrawnArrow, DrawnBody, DrawnLegend, DrawnLine, DrawnView, Shade};
use crate::drawing::{self, CELL_EYE, Solid, edge_direction};
use crate::quantity::with_unit;
use crate::scene::Scene;
use crate::scene::colour::Colour;
use crate::scene::error_scale::ErrorScale;
use crate::scene::finished_edge::FinishedEdge;

/// Millimetres a metre.
pub(super) const MILLIMETRES: f64 = 1e3;
/// Triangles of a cell at most: about 0.7 MB of a page.
const MOST_TRIANGLES: usize = 30_000;
/// From the direction in which the edge looks longest, so that the part looks solid too [rad].
const TURN: f64 = 0.4;
/// Pieces of a finished edge at most.
const PIECES: usize = 400;
/// Shades of a legend.
const STEPS: usize = 41;
/// Of a run's drawing the view that shows all, and that of the finished edge.
const CELL: usize = 1;
const FINISHED: usize = 2;

/// The part and its edge in the colours of its force error, and the whole cell at a moment [s]; none without an edge.
pub(super) fn of_run(scene: &Scene, moment: f64) -> Option<Drawing> {
    if scene.edge_path.relative_force_error.is_empty() {
        return None;
    }
    let (solids, force) = drawing::solids(scene, moment, MOST_TRIANGLES);
    let drawn = |solid: &Solid| match solid.entity.as_str() {
        "workpiece" => body(solid, None, None),
        _ => body(solid, Some(CELL), Some(shade(solid.colour))),
    };
    let arrow = force.map(|arrow| {
        let force = arrow.force_in_world;
        DrawnArrow {
            view: Some(CELL),
            at: (MILLIMETRES * arrow.point_in_world).as_vec3().to_array(),
            along: force.normalize_or_zero().as_vec3().to_array(),
            label: with_unit(force.length(), "N"),
        }
    });
    let view = |name: &str, eye: DVec3| DrawnView {
        name: name.to_owned(),
        // So few digits that they come back from a file as they were.
        eye: ((1e3 * eye).round() / 1e3).to_array(),
    };
    let from = DQuat::from_rotation_z(TURN) * edge_direction(scene);
    let mut views = vec![view("Force error", from), view("Whole cell", CELL_EYE)];
    let mut lines = vec![edge(scene)];
    if let Some(finished) = &scene.finished_edge {
        views.push(view("Finished edge", from));
        lines.push(chamfer(finished));
    }
    Some(Drawing {
        name: "The part, its edge in the colours of the force error, and the cell".to_owned(),
        words: format!(
            "The mean force error of each of {} pieces of the edge while following. The whole cell is that in the middle of following; its arrow is the contact force with its friction.{}{}",
            scene.edge_path.relative_force_error.len(),
            match scene.finished_edge {
                Some(_) =>
                    " The finished edge is that after all passes, ends and all, each piece in the colour of the leg that is farthest out of tolerance: green within it, blue too little, orange too much.",
                None => "",
            },
            simplified(&solids).unwrap_or_default()
        ),
        views,
        bodies: solids.iter().map(drawn).collect(),
        lines,
        arrow,
        legend: Some(legend(scene)),
    })
}

/// How much of the bodies is drawn, where it is not all.
fn simplified(solids: &[Solid]) -> Option<String> {
    let drawn: usize = solids.iter().map(|solid| solid.triangles.len()).sum();
    let whole: usize = solids.iter().map(|solid| solid.whole).sum();
    (drawn < whole).then(|| {
        format!(" The bodies are drawn with {drawn} of their {whole} triangles; the line of the edge is that of the whole part.")
    })
}

fn edge(scene: &Scene) -> DrawnLine {
    let path = &scene.edge_path;
    let scale = ErrorScale::of(path);
    let errors = path.relative_force_error.iter();
    DrawnLine {
        id: "followed edge".to_owned(),
        points: floats(path.points_in_world.iter().copied()),
        shades: errors.clone().map(|e| shade(scale.colour(*e))).collect(),
        values: errors.map(|error| (100.0 * error) as f32).collect(),
        facts: vec![[
            "length".to_owned(),
            with_unit(MILLIMETRES * path.length, "mm"),
        ]],
        ..DrawnLine::default()
    }
}

/// The finished edge, ends and all: of each piece the leg that is farthest out of tolerance.
fn chamfer(finished: &FinishedEdge) -> DrawnLine {
    let legs = &finished.chamfer_leg;
    let step = legs.len().div_ceil(PIECES).max(1);
    let worst = |legs: &[f64]| {
        let error = |leg: &f64| finished.error(*leg).abs();
        let worst = legs.iter().max_by(|a, b| error(a).total_cmp(&error(b)));
        worst.copied().unwrap_or_default()
    };
    let last = legs.len().saturating_sub(1);
    let places: Vec<usize> = (0..last).step_by(step).chain([last]).collect();
    let pieces = places
        .windows(2)
        .map(|ends| worst(&legs[ends[0]..=ends[1]]));
    let pieces: Vec<f64> = pieces.collect();
    let [least, most] = finished.leg_limits;
    let end = 2.0
        * if most.is_finite() {
            most
        } else {
            least.max(1e-3)
        };
    let leg = |step: usize| end * step as f64 / (STEPS - 1) as f64;
    let points = places.iter().map(|place| finished.points_in_world[*place]);
    DrawnLine {
        id: "finished edge".to_owned(),
        view: Some(FINISHED),
        points: floats(points),
        shades: pieces
            .iter()
            .map(|leg| shade(finished.colour(*leg)))
            .collect(),
        values: pieces
            .iter()
            .map(|leg| (MILLIMETRES * leg) as f32)
            .collect(),
        legend: Some(DrawnLegend {
            title: "chamfer leg".to_owned(),
            unit: "mm".to_owned(),
            unsigned: true,
            ends: [0.0, 0.5 * end, end].map(|leg| with_unit(MILLIMETRES * leg, "mm")),
            shades: (0..STEPS)
                .map(|step| shade(finished.colour(leg(step))))
                .collect(),
            none: None,
        }),
        ..DrawnLine::default()
    }
}

fn legend(scene: &Scene) -> DrawnLegend {
    let scale = ErrorScale::of(&scene.edge_path);
    let end = scale.percent();
    let errors = &scene.edge_path.relative_force_error;
    let place = |step: usize| scale.end * (2.0 * step as f64 / (STEPS - 1) as f64 - 1.0);
    let none = || (shade(scale.colour(f64::NAN)), "no contact".to_owned());
    DrawnLegend {
        title: "force error".to_owned(),
        unit: "%".to_owned(),
        unsigned: false,
        ends: [
            format!("−{end} %"),
            "as desired".to_owned(),
            format!("+{end} %"),
        ],
        shades: (0..STEPS)
            .map(|step| shade(scale.colour(place(step))))
            .collect(),
        none: errors.iter().any(|error| error.is_nan()).then(none),
    }
}

/// A solid as a page draws it.
pub(super) fn body(solid: &Solid, view: Option<usize>, shade: Option<Shade>) -> DrawnBody {
    DrawnBody {
        view,
        shade,
        corners: floats(solid.corners.iter().copied()),
        triangles: solid.triangles.iter().flatten().copied().collect(),
    }
}

/// Coordinates [mm] one after the other.
pub(super) fn floats(points: impl IntoIterator<Item = DVec3>) -> Vec<f32> {
    let points = points.into_iter();
    points
        .flat_map(|point| (MILLIMETRES * point).as_vec3().to_array())
        .collect()
}

fn shade([red, green, blue, _]: Colour) -> Shade {
    [red, green, blue]
}
