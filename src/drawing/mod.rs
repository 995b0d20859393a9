//! A scene as a picture: solid bodies seen from one side as an image, over it in lines what is to be read - the edge in the colours of its force error,
//! the force, names, a scale. An SVG document with colours for light and dark grounds; the same scene gives the same bytes.

mod cross_section;
mod faces;
mod numbered;
mod png;
mod raster;
mod simplify;
mod solids;
mod svg;
mod view;

use glam::{DVec2, DVec3};

pub use cross_section::{CrossSection, cross_section};

use self::faces::{Face, faces};
use self::raster::{Camera, Raster};
use self::svg::Svg;
use crate::quantity::with_unit;
use crate::scene::error_scale::ErrorScale;
use crate::scene::{ContactArrow, EdgePath, Scene};

pub use self::numbered::{Numbered, numbered};
pub use self::solids::Solid;
pub use self::view::edge_direction;

/// Size of a picture [pixel]; shown smaller where there is less room.
const SIZE: [usize; 2] = [640, 440];
/// Pixels of an image to one of its picture, along each side: for sharp screens.
const DENSITY: usize = 2;
/// Size of such an image [pixel].
const FINE_SIZE: [usize; 2] = [DENSITY * SIZE[0], DENSITY * SIZE[1]];
/// Left free around what is shown [pixel]: room for names.
const MARGIN: f64 = 46.0;
/// Below an edge's picture: its legend [pixel].
const LEGEND: usize = 64;
/// Depth by which something must lie nearer to the eye to hide a piece of the edge [m].
const HIDDEN: f64 = 0.003;
/// From where a cell is looked at.
pub const CELL_EYE: DVec3 = DVec3::new(0.75, -1.0, 0.45);
/// Length of the arrow of the largest force [pixel].
const ARROW: f64 = 70.0;

/// The whole scene at a moment [s], with its bodies' names and the contact force.
#[must_use]
pub fn cell(scene: &Scene, moment: f64) -> String {
    let frame = frame_at(scene, moment);
    let all = faces(scene, frame, |_| true);
    let (camera, raster) = drawn(&all, CELL_EYE);
    let mut svg = Svg::with_image((SIZE, SIZE), "The cell", &image(&raster));
    edge_line(&mut svg, &scene.edge_path, &camera, None);
    names(&mut svg, scene, &all, &camera);
    force(&mut svg, scene, frame, &camera);
    scale_bar(&mut svg, &camera, SIZE[1] as f64 - 14.0);
    svg.text(
        [SIZE[0] as f64 - 10.0, SIZE[1] as f64 - 10.0],
        "end",
        &format!("at {}", with_unit(moment, "s")),
    );
    svg.end()
}

/// The part from where its edge is seen best, the edge in the colours of its force error, with their legend; none without an edge.
#[must_use]
pub fn edge(scene: &Scene) -> Option<String> {
    let path = &scene.edge_path;
    if path.relative_force_error.is_empty() {
        return None;
    }
    let part = faces(scene, 0, |name| name == "workpiece");
    let (camera, raster) = drawn(&part, edge_direction(scene));
    let size = [SIZE[0], SIZE[1] + LEGEND];
    let mut svg = Svg::with_image((size, SIZE), "The edge", &image(&raster));
    let scale = ErrorScale::of(path);
    edge_line(&mut svg, path, &camera, Some((scale, &raster)));
    ends(&mut svg, path, &camera);
    scale_bar(&mut svg, &camera, SIZE[1] as f64 - 14.0);
    legend(&mut svg, scale, path);
    Some(svg.end())
}

/// The bodies at a moment [s], and the contact force; where they have more triangles than `most` together, they are simplified.
#[must_use]
pub fn solids(scene: &Scene, moment: f64, most: usize) -> (Vec<Solid>, Option<ContactArrow>) {
    let frame = frame_at(scene, moment);
    let arrow = scene.contact_arrows.get(frame).copied();
    (
        solids::solids(scene, frame, most),
        arrow.filter(|arrow| arrow.force_in_world != DVec3::ZERO),
    )
}

/// The frame nearest to a moment.
fn frame_at(scene: &Scene, moment: f64) -> usize {
    let distance = |time: f64| (time - moment).abs();
    let times = scene.frame_times.iter().enumerate();
    let nearest = times.min_by(|a, b| distance(*a.1).total_cmp(&distance(*b.1)));
    nearest.map_or(0, |(frame, _)| frame)
}

/// A camera on triangles from a direction, and what it sees.
fn drawn(faces: &[Face], eye: DVec3) -> (Camera, Raster<'_>) {
    let points = faces.iter().flat_map(|face| face.corners);
    let camera = Camera::on(points, eye, SIZE.map(|length| length as f64), MARGIN);
    let fine = Camera {
        scale: DENSITY as f64 * camera.scale,
        ..camera
    };
    (camera, Raster::of(faces, &fine, FINE_SIZE))
}

/// An image as a PNG in base64.
fn image(raster: &Raster<'_>) -> String {
    png::base64_png(&raster.pixels(), FINE_SIZE)
}

/// Depth towards the eye of what is seen at a place of the picture [m]; minus infinity where there is nothing.
fn depth_at(raster: &Raster<'_>, place: DVec2) -> f64 {
    raster.depth_at(DENSITY as f64 * place)
}

/// The edge: each piece in its colour, or all in one; pale where the part hides it.
fn edge_line(
    svg: &mut Svg,
    path: &EdgePath,
    camera: &Camera,
    coloured: Option<(ErrorScale, &Raster<'_>)>,
) {
    let pieces = path.points_in_world.windows(2);
    let pieces: Vec<([DVec2; 2], f64)> = pieces
        .map(|two| {
            let seen = [two[0], two[1]].map(|point| camera.project(point));
            (seen.map(|(place, _)| place), 0.5 * (seen[0].1 + seen[1].1))
        })
        .collect();
    let Some((scale, raster)) = coloured else {
        for (piece, _) in &pieces {
            svg.line(*piece, "#d55e00", 2.0, 1.0);
        }
        return;
    };
    let hidden = |(piece, depth): &([DVec2; 2], f64)| {
        let middle = 0.5 * (piece[0] + piece[1]);
        depth_at(raster, middle) > depth + HIDDEN
    };
    for piece in &pieces {
        let opacity = if hidden(piece) { 0.25 } else { 1.0 };
        svg.line(piece.0, "#222222", 8.0, opacity);
    }
    for (piece, error) in pieces.iter().zip(&path.relative_force_error) {
        let opacity = if hidden(piece) { 0.45 } else { 1.0 };
        svg.line(piece.0, &hex(scale.colour(*error)), 5.0, opacity);
    }
}

/// Where the edge begins and which way it is followed.
fn ends(svg: &mut Svg, path: &EdgePath, camera: &Camera) {
    let points = &path.points_in_world;
    let on = points.len() / 20;
    let (Some(first), Some(next)) = (points.first(), points.get(on.max(1))) else {
        return;
    };
    let [start, next] = [*first, *next].map(|point| camera.project(point).0);
    let along = (next - start).normalize_or(DVec2::X);
    let aside = DVec2::new(along.y, -along.x);
    let aside = if aside.y > 0.0 { -aside } else { aside };
    let [from, to] = [14.0, 54.0].map(|length| start + 20.0 * aside + (length - 14.0) * along);
    svg.arrow([from, to], "currentColor", 1.5);
    svg.dot(start, 5.0);
    let word = start + 34.0 * aside;
    svg.text(
        [
            word.x.clamp(30.0, SIZE[0] as f64 - 30.0),
            word.y.clamp(16.0, SIZE[1] as f64 - 8.0),
        ],
        "middle",
        "start",
    );
}

/// Bodies that a reader looks for, by name, beside them.
fn names(svg: &mut Svg, scene: &Scene, faces: &[Face], camera: &Camera) {
    let known = [
        ("workpiece", "part"),
        ("device/cylinders", "device"),
        ("load", "surface"),
    ];
    let mut taken: Vec<f64> = Vec::new();
    for (entity, word) in known {
        let Some(number) = scene.bodies.iter().position(|body| body.entity == entity) else {
            continue;
        };
        let own = faces
            .iter()
            .filter(|face| usize::from(face.body) == number + 1);
        let places: Vec<DVec2> = own
            .flat_map(|face| face.corners)
            .map(|corner| camera.project(corner).0)
            .collect();
        let Some(right) = places.iter().copied().max_by(|a, b| a.x.total_cmp(&b.x)) else {
            continue;
        };
        let mut line = right.y;
        while taken.iter().any(|other| (line - other).abs() < 18.0) {
            line += 18.0;
        }
        taken.push(line);
        let to = DVec2::new((right.x + 26.0).min(SIZE[0] as f64 - 62.0), line);
        svg.line([right, to], "currentColor", 1.0, 0.7);
        svg.text([to.x + 4.0, to.y + 5.0], "start", word);
    }
}

/// The contact force: an arrow on the part at the contact, and its size.
fn force(svg: &mut Svg, scene: &Scene, frame: usize, camera: &Camera) {
    let Some(arrow) = scene.contact_arrows.get(frame) else {
        return;
    };
    let size = arrow.force_in_world.length();
    if size <= 0.0 {
        return;
    }
    let (tip, _) = camera.project(arrow.point_in_world);
    let (end, _) = camera.project(arrow.point_in_world + arrow.force_in_world / size);
    let along = (end - tip).normalize_or(DVec2::Y);
    // Beside the tool, in which it would be hidden.
    let aside = DVec2::new(-along.y, along.x);
    let aside = if aside.x > 0.0 { -aside } else { aside };
    let tip = tip + 30.0 * aside;
    let from = tip - ARROW * along;
    svg.arrow([from, tip], "#d55e00", 3.0);
    svg.text([from.x - 6.0, from.y + 5.0], "end", &with_unit(size, "N"));
}

/// A length that is a round number of millimetres.
fn scale_bar(svg: &mut Svg, camera: &Camera, bottom: f64) {
    let longest = 0.3 * SIZE[0] as f64 / camera.scale;
    let steps = (-4..2).flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * 10f64.powi(power)));
    let length = steps.rev().find(|length| *length <= longest);
    let Some(length) = length else {
        return;
    };
    let (left, right) = (12.0, 12.0 + length * camera.scale);
    for piece in [
        [DVec2::new(left, bottom), DVec2::new(right, bottom)],
        [
            DVec2::new(left, bottom - 5.0),
            DVec2::new(left, bottom + 5.0),
        ],
        [
            DVec2::new(right, bottom - 5.0),
            DVec2::new(right, bottom + 5.0),
        ],
    ] {
        svg.line(piece, "currentColor", 1.5, 1.0);
    }
    let millimetres = format!("{} mm", (1e4 * length).round() / 10.0);
    svg.text([right + 8.0, bottom + 5.0], "start", &millimetres);
}

/// The colours' legend: a bar with its ends and the right force, and what is grey.
fn legend(svg: &mut Svg, scale: ErrorScale, path: &EdgePath) {
    const STEPS: usize = 40;
    let (left, width, top) = (110.0, 300.0, SIZE[1] as f64 + 8.0);
    let step = width / STEPS as f64;
    for index in 0..STEPS {
        let share = (index as f64 + 0.5) / STEPS as f64;
        let colour = hex(scale.colour(scale.end * (2.0 * share - 1.0)));
        svg.bar(
            [left + index as f64 * step, top],
            [step + 0.5, 14.0],
            &colour,
        );
    }
    let end = scale.percent();
    let line = top + 32.0;
    svg.text([left, line], "middle", &format!("−{end} %"));
    svg.text([left + 0.5 * width, line], "middle", "as desired");
    svg.text([left + width, line], "middle", &format!("+{end} %"));
    svg.text([left - 10.0, top + 12.0], "end", "force error");
    if path.relative_force_error.iter().any(|error| error.is_nan()) {
        svg.bar(
            [left + width + 40.0, top],
            [24.0, 14.0],
            &hex(scale.colour(f64::NAN)),
        );
        svg.text([left + width + 72.0, top + 12.0], "start", "no contact");
    }
}

fn hex([red, green, blue, _]: [u8; 4]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests;
