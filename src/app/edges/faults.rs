//! The page of a part whose surface is not closed: its faulty edges on it.

use std::path::Path;

use glam::DVec3;

use super::super::space::{MILLIMETRES, body, floats};
use super::part::{EYE, MOST_TRIANGLES, name_of, place, scene_of, short};
use crate::document::{
    Block, Cell, Column, Document, Drawing, DrawnLine, DrawnView, Section, Table, html,
};
use crate::drawing::{self, Numbered};
use crate::quantity::counted;
use crate::workpiece::{EdgeFault, EdgeFlaw, MeshFault, PartFile};

/// Faulty edges that are drawn and listed at most.
const MOST: usize = 500;

/// The page as a document. `scale` is the length of the file's unit [m].
pub(super) fn page(
    mesh: &Path,
    file: &PartFile,
    scale: f64,
    (fault, edges): (&MeshFault, &[EdgeFault<DVec3>]),
) -> String {
    let points = file.points.iter().map(|point| *point * scale).collect();
    let scene = scene_of(points, file.triangles.clone());
    let (solids, _) = drawing::solids(&scene, 0.0, MOST_TRIANGLES);
    let shown = &edges[..edges.len().min(MOST)];
    let drawn = Drawing {
        name: "The part and its faulty edges".to_owned(),
        views: vec![DrawnView {
            name: "Faulty edges".to_owned(),
            eye: EYE.to_array(),
        }],
        bodies: solids.iter().map(|solid| body(solid, None, None)).collect(),
        lines: shown.iter().enumerate().map(line).collect(),
        ..Drawing::default()
    };
    let numbered = |(number, edge): (usize, &EdgeFault<DVec3>)| Numbered {
        points: edge.ends.to_vec(),
        number,
        pale: false,
    };
    let numbered: Vec<Numbered> = shown.iter().enumerate().map(numbered).collect();
    let picture = (
        "The part and the numbers of its faulty edges; pale where the part hides them.".to_owned(),
        drawing::numbered(&scene, &numbered, EYE),
    );
    let mut blocks = vec![
        Block::InSpace(&drawn, vec![picture]),
        Block::Table(table(shown)),
    ];
    if shown.len() < edges.len() {
        blocks.push(Block::Hint(format!(
            "The first {} of {} faulty edges.",
            shown.len(),
            edges.len()
        )));
    }
    html(&Document {
        title: format!("Faulty edges of {}", name_of(mesh)),
        verdict: format!(
            "The surface is not closed: {}.",
            counted(edges.len(), "faulty edge")
        ),
        lead: vec![
            format!("{} {fault}.", name_of(mesh)),
            "Each edge of a closed surface has just two triangles, both counter-clockwise seen from outside. Mend the part where it was drawn, or with MeshLab (Filters, Cleaning and Repairing), and export it again.".to_owned(),
        ],
        sections: vec![Section::new("Part and faulty edges", blocks)],
        footer: "Made by idc edges.".to_owned(),
        ..Document::default()
    })
}

/// What is wrong with an edge, for people.
fn remark(flaw: EdgeFlaw) -> &'static str {
    match flaw {
        EdgeFlaw::Open => "Only one triangle has this edge: there is a hole or a crack.",
        EdgeFlaw::NonManifold => "More than two triangles have this edge.",
        EdgeFlaw::Misoriented => {
            "Its two triangles are wound against each other: one of them is turned."
        }
    }
}

fn line((number, edge): (usize, &EdgeFault<DVec3>)) -> DrawnLine {
    let [from, to] = edge.ends;
    DrawnLine {
        id: format!("fault-{number}"),
        label: number.to_string(),
        points: floats(edge.ends),
        colour: match edge.flaw {
            EdgeFlaw::Open => 0,
            EdgeFlaw::NonManifold => 1,
            EdgeFlaw::Misoriented => 2,
        },
        outward: [0.0; 3],
        facts: [
            ("fault", edge.flaw.name().to_owned()),
            (
                "length",
                format!("{} mm", short(MILLIMETRES * from.distance(to))),
            ),
            ("start", format!("({}) mm", place(from))),
            ("end", format!("({}) mm", place(to))),
        ]
        .map(|(name, value)| [name.to_owned(), value])
        .to_vec(),
        remark: remark(edge.flaw).to_owned(),
        ..DrawnLine::default()
    }
}

fn table(edges: &[EdgeFault<DVec3>]) -> Table {
    let columns = Column::list("id | fault | #length, mm | start, mm | end, mm");
    let row = |(number, edge): (usize, &EdgeFault<DVec3>)| {
        let [from, to] = edge.ends;
        let cells = [
            format!("fault-{number}"),
            edge.flaw.name().to_owned(),
            format!("{:.3}", MILLIMETRES * from.distance(to)),
            place(from),
            place(to),
        ];
        cells.map(Cell::from).to_vec()
    };
    let rows = edges.iter().enumerate().map(row).collect();
    Table::new("Faulty edges, in the part's frame.", columns, rows)
}
