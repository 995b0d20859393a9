//! The page of a part's edges, from which one is picked for a scenario.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec3;

use super::super::space::{MILLIMETRES, body, floats};
use super::part::{
    EYE, MOST_TRIANGLES, MeshUnit, convexity, kind, name_of, place, scene_of, short,
};
use crate::document::{
    Block, Cell, Column, Document, Drawing, DrawnLine, DrawnView, Section, Table, html,
};
use crate::drawing::{self, Numbered};
use crate::quantity::counted;
use crate::workpiece::{Convexity, CurveKind, EdgeCurve, EdgeList, EdgeSearch, TriangleMesh};

/// The page's colours for lines.
const COLOURS: usize = 5;
/// How far an outline is drawn within the face that it bounds, so that outlines of neighbours lie apart: share of the part's size, and of its own length [1].
const INSET: [f64; 2] = [0.012, 0.04];
/// Where edges are from: mesh file, its unit, angle from which they are sharp [deg].
type Source<'a> = (&'a Path, MeshUnit, f64);

/// The page as a document.
pub(super) fn page(source: Source<'_>, mesh: &TriangleMesh, list: &EdgeList) -> String {
    let (file, unit, sharp_angle) = source;
    let scene = scene_of(mesh.vertices().to_vec(), mesh.triangles().to_vec());
    let (solids, _) = drawing::solids(&scene, 0.0, MOST_TRIANGLES);
    let (low, high) = mesh.bounds();
    let size = high - low;
    let lines = |curves: &[EdgeCurve], view: usize| -> Vec<DrawnLine> {
        let colours = distinguishable(curves);
        let curves = curves.iter().zip(colours);
        curves
            .map(|(curve, colour)| DrawnLine {
                view: Some(view),
                colour,
                ..line(source, curve, size.length())
            })
            .collect()
    };
    let view = |name: &str| DrawnView {
        name: name.to_owned(),
        eye: EYE.to_array(),
    };
    let drawn = Drawing {
        name: "The part and its edges".to_owned(),
        views: vec![view("Edges"), view("Outlines (loops)")],
        bodies: solids.iter().map(|solid| body(solid, None, None)).collect(),
        lines: [lines(&list.edges, 0), lines(&list.loops, 1)].concat(),
        ..Drawing::default()
    };
    let numbered = |(number, curve): (usize, &EdgeCurve)| Numbered {
        points: closed(curve, curve.points.clone()),
        number,
        pale: curve.convexity != Convexity::Convex,
    };
    let numbered: Vec<Numbered> = list.edges.iter().enumerate().map(numbered).collect();
    let picture = (
        "The part and the numbers of its edges; pale where the part hides them.".to_owned(),
        drawing::numbered(&scene, &numbered, EYE),
    );
    let triangles: usize = solids.iter().map(|solid| solid.triangles.len()).sum();
    let kept = (triangles < mesh.triangles().len()).then(|| {
        let all = mesh.triangles().len();
        Block::Hint(format!(
            "The part is drawn with {triangles} of its {all} triangles; edges and numbers are those of the whole."
        ))
    });
    let blocks = [Block::InSpace(&drawn, vec![picture])]
        .into_iter()
        .chain(kept)
        .chain(
            mesh.notes()
                .iter()
                .map(|note| Block::Hint(format!("{note}."))),
        )
        .chain([Block::Table(table(list))]);
    html(&Document {
        title: format!("Edges of {}", name_of(file)),
        verdict: verdict(mesh, list),
        lead: vec![format!(
            "Pick an edge: its lines take the place of a scenario's [workpiece.edge]. An edge is one whose faces stand at an angle of at most {}°; file in {}.",
            short(180.0 - sharp_angle),
            unit.name()
        )],
        sections: vec![Section::new("Part and edges", blocks.collect())],
        footer: "Made by idc edges.".to_owned(),
        ..Document::default()
    })
}

fn verdict(mesh: &TriangleMesh, list: &EdgeList) -> String {
    let (low, high) = mesh.bounds();
    let size = (MILLIMETRES * (high - low)).to_array().map(short);
    let ridden = |curves: &[EdgeCurve]| {
        let convex = |curve: &&EdgeCurve| curve.convexity == Convexity::Convex;
        curves.iter().filter(convex).count()
    };
    let [edges, outlines] = [list.edges.len(), list.loops.len()];
    let can = match [ridden(&list.edges), ridden(&list.loops)] {
        _ if edges == 0 => "no sharp edge".to_owned(),
        can if can == [edges, outlines] => format!(
            "{} and {} of faces, all of which a tool can ride",
            counted(edges, "edge"),
            counted(outlines, "outline")
        ),
        [of_edges, of_outlines] => format!(
            "{} and {} of faces, of which a tool can ride {of_edges} and {of_outlines}",
            counted(edges, "edge"),
            counted(outlines, "outline")
        ),
    };
    format!("{} mm: {can}.", size.join(" × "))
}

fn line(source: Source<'_>, curve: &EdgeCurve, size: f64) -> DrawnLine {
    let points = match curve.id.starts_with("loop") {
        true => within_its_face(curve, (INSET[0] * size).min(INSET[1] * curve.length)),
        false => curve.points.clone(),
    };
    let outward = curve.normals.iter().map(|(a, b)| *a + *b).sum::<DVec3>();
    let remark = match curve.convexity {
        Convexity::Convex => "",
        Convexity::Concave => "An inside edge, cannot be ridden.",
        Convexity::Mixed => "An inside edge in a part of it, cannot be ridden.",
    };
    DrawnLine {
        id: curve.id.clone(),
        label: number(curve).to_owned(),
        points: floats(closed(curve, points)),
        pale: !remark.is_empty(),
        outward: outward.normalize_or_zero().to_array(),
        facts: facts(curve),
        remark: remark.to_owned(),
        lines: match remark {
            "" => to_paste(source, curve),
            _ => String::new(),
        },
        ..DrawnLine::default()
    }
}

fn number(curve: &EdgeCurve) -> &str {
    curve.id.rsplit('-').next().unwrap_or_default()
}

/// A closed curve ends where it began.
fn closed(curve: &EdgeCurve, mut points: Vec<DVec3>) -> Vec<DVec3> {
    if curve.closed {
        points.extend(points.first().copied());
    }
    points
}

/// An outline moved into the face on its left.
fn within_its_face(curve: &EdgeCurve, by: f64) -> Vec<DVec3> {
    let count = curve.points.len();
    let left = |segment: usize| {
        let along = curve.points[(segment + 1) % count] - curve.points[segment];
        curve.normals[segment].0.cross(along).normalize_or_zero()
    };
    let moved = |(index, point): (usize, &DVec3)| {
        let [before, after] = [left((index + count - 1) % count), left(index)];
        // At a corner as far as both sides ask for, within bounds where it is acute.
        let both = before + after;
        *point + by * both * (2.0 / both.length_squared().max(1.0))
    };
    curve.points.iter().enumerate().map(moved).collect()
}

/// Colours such that curves that touch differ, as far as there are colours.
fn distinguishable(curves: &[EdgeCurve]) -> Vec<usize> {
    let key = |point: &DVec3| (1e7 * *point).round().to_array().map(|v| v as i64);
    let mut taken: BTreeMap<[i64; 3], BTreeSet<usize>> = BTreeMap::new();
    let mut used = [0usize; COLOURS];
    let mut colours = Vec::new();
    for curve in curves {
        let keys: Vec<_> = curve.points.iter().map(key).collect();
        let touched: BTreeSet<usize> = (keys.iter())
            .filter_map(|key| taken.get(key))
            .flatten()
            .copied()
            .collect();
        let order = |colour: &usize| (touched.contains(colour), used[*colour]);
        let colour = (0..COLOURS).min_by_key(order).unwrap_or(0);
        used[colour] += 1;
        for key in keys {
            taken.entry(key).or_default().insert(colour);
        }
        colours.push(colour);
    }
    colours
}

/// What is shown of an edge, the first two under the pointer as well.
fn facts(curve: &EdgeCurve) -> Vec<[String; 2]> {
    let shape = match curve.kind {
        CurveKind::Arc { radius, angle } => format!(
            "arc, radius {} mm over {}°",
            short(MILLIMETRES * radius),
            short(angle.to_degrees())
        ),
        CurveKind::Polyline => format!("polyline of {}", counted(curve.normals.len(), "piece")),
        CurveKind::Straight => kind(curve).to_owned(),
    };
    let mut facts = vec![
        (
            "length",
            format!("{} mm", short(MILLIMETRES * curve.length)),
        ),
        ("angle between the faces", angle(curve)),
        ("form", shape),
        ("side", convexity(curve).to_owned()),
        ("start", format!("({}) mm", place(curve.points[0]))),
    ];
    if curve.closed {
        facts.push((
            "closed",
            format!("yes, {}", counted(curve.corners.len(), "corner")),
        ));
    } else {
        facts.push(("end", format!("({}) mm", place(end(curve)))));
    }
    facts
        .into_iter()
        .map(|(name, value)| [name.to_owned(), value])
        .collect()
}

fn end(curve: &EdgeCurve) -> DVec3 {
    curve
        .at(if curve.closed { 0.0 } else { curve.length })
        .point
}

/// Lines of a scenario that choose an edge.
fn to_paste((mesh, unit, sharp_angle): Source<'_>, curve: &EdgeCurve) -> String {
    let key = curve.id.split('-').next().unwrap_or_default();
    let mesh = mesh.display().to_string();
    let mut text = format!(
        "# of [workpiece] with mesh = {mesh:?}\n# and mesh_unit = \"{}\"\n[workpiece.edge]\n{key} = {}\n",
        unit.name(),
        number(curve),
    );
    let default = EdgeSearch::default().sharp_angle.to_degrees();
    if (sharp_angle - default).abs() > 1e-9 {
        text += &format!("sharp_angle_deg = {sharp_angle:?}\n");
    }
    // Rounded up it would lie beyond the end.
    let end = (1e3 * MILLIMETRES * curve.length + 1e-6).floor() / 1e3;
    text + &format!("# start_mm = 0\n# end_mm = {end}\n")
}

/// All curves with their numbers.
fn table(list: &EdgeList) -> Table {
    let columns = Column::list(
        "id | form | #length, mm | #angle, deg | side | start, mm | end, mm | closed | #corners",
    );
    let row = |curve: &EdgeCurve| {
        let cells = [
            curve.id.clone(),
            kind(curve).to_owned(),
            length(curve),
            angle(curve).replace('°', ""),
            convexity(curve).to_owned(),
            place(curve.points[0]),
            place(end(curve)),
            if curve.closed { "yes" } else { "no" }.to_owned(),
            curve.corners.len().to_string(),
        ];
        cells.map(Cell::from).to_vec()
    };
    let curves = list.edges.iter().chain(&list.loops);
    let caption = "Edges, then outlines of faces (loops), in the part's frame. Angle: between the two faces, in the part at a convex edge and in the open at a concave one. Convex ones can be ridden.";
    Table::new(caption, columns, curves.map(row).collect())
}

fn length(curve: &EdgeCurve) -> String {
    format!("{:.3}", MILLIMETRES * curve.length)
}

fn angle(curve: &EdgeCurve) -> String {
    let [low, high] = curve.face_angle_range().map(f64::to_degrees);
    match high - low < 0.1 {
        true => format!("{low:.1}°"),
        false => format!("{low:.1} to {high:.1}°"),
    }
}
