//! The triangles of one COLLADA geometry.

use std::collections::BTreeMap;
use std::rc::Rc;

use glam::DVec3;
use roxmltree::Node;

use super::tree::{Tree, child, children, is};
use crate::mesh_file::polygon::{Effort, fan, split, strip};
use crate::mesh_file::scene::{Fault, MeshPart, with_own_points};

/// A geometry by the symbols of its materials.
pub(super) struct Geometry {
    pub(super) parts: Vec<(String, MeshPart)>,
    /// Faces that are not plane.
    pub(super) bent: usize,
    /// Why it leaves open which solid it means.
    pub(super) doubtful: Option<String>,
}

/// What geometries share: points of sources that were read already, by their place in the text, and the effort left to split polygons.
pub(super) struct Shared {
    points: BTreeMap<usize, Rc<Vec<DVec3>>>,
    effort: Effort,
}

impl Shared {
    pub(super) fn new() -> Self {
        Self {
            points: BTreeMap::new(),
            effort: Effort::new(),
        }
    }
}

pub(super) fn geometry<'a>(
    tree: &Tree<'a>,
    element: Node<'a, 'a>,
    shared: &mut Shared,
) -> Result<Geometry, Fault> {
    let mut found = Geometry {
        parts: Vec::new(),
        bent: 0,
        doubtful: None,
    };
    for other in ["convex_mesh", "brep"] {
        if let Some(other) = child(element, other) {
            return Err(Fault::unsupported(
                format!("line {}: <{}>", tree.line(other), other.tag_name().name()),
                "export the part as a mesh of triangles",
            ));
        }
    }
    let Some(mesh) = child(element, "mesh") else {
        return Ok(found);
    };
    for primitive in mesh.children().filter(Node::is_element) {
        let name = primitive.tag_name().name();
        if !["triangles", "polylist", "polygons", "trifans", "tristrips"].contains(&name) {
            // Sources, lines, what belongs to a program.
            continue;
        }
        let Some(input) = positions(tree, primitive, shared)? else {
            continue;
        };
        let triangles = triangles(tree, primitive, &input, &mut found, &shared.effort)?;
        let symbol = primitive.attribute("material").unwrap_or_default();
        let part = with_own_points(&input.points, &triangles);
        found.parts.push((symbol.to_owned(), part));
    }
    Ok(found)
}

/// What a primitive's corners mean.
struct Input {
    points: Rc<Vec<DVec3>>,
    /// Place of a point's index among those of a corner.
    offset: usize,
    /// Indices of a corner.
    stride: usize,
}

impl Input {
    /// Corners of an element with indices, by their points.
    fn corners<'a>(&self, tree: &Tree<'a>, p: Node<'a, 'a>) -> Result<Vec<u32>, Fault> {
        let indices = tree.indices(p)?;
        let (stride, count) = (self.stride, self.points.len());
        if indices.len() % stride != 0 {
            let length = indices.len();
            let reason = format!("it has {length} indices, expected a multiple of {stride}");
            return Err(tree.fault(p, reason));
        }
        let corners = indices.chunks_exact(stride).map(|one| one[self.offset]);
        let corners: Vec<u32> = corners.collect();
        match corners.iter().find(|index| **index as usize >= count) {
            None => Ok(corners),
            Some(index) => {
                let reason =
                    format!("a corner refers to the missing vertex {index} (there are {count})");
                Err(tree.fault(p, reason))
            }
        }
    }
}

/// The triangles of a primitive.
fn triangles<'a>(
    tree: &Tree<'a>,
    primitive: Node<'a, 'a>,
    input: &Input,
    found: &mut Geometry,
    effort: &Effort,
) -> Result<Vec<[u32; 3]>, Fault> {
    let mut polygons = Polygons {
        points: &input.points,
        triangles: Vec::new(),
        found,
        effort,
    };
    match primitive.tag_name().name() {
        "triangles" => {
            for p in children(primitive, "p") {
                let corners = input.corners(tree, p)?;
                if corners.len() % 3 != 0 {
                    let count = corners.len();
                    let reason = format!("it has {count} corners, expected a multiple of 3");
                    return Err(tree.fault(p, reason));
                }
                let triples = corners.chunks_exact(3);
                let triples = triples.map(|three| [three[0], three[1], three[2]]);
                polygons.triangles.extend(triples);
            }
        }
        "polylist" => polylist(tree, primitive, input, &mut polygons)?,
        "polygons" => {
            let faces = primitive.children();
            for face in faces.filter(|face| is(*face, "p") || is(*face, "ph")) {
                let outline = match is(face, "p") {
                    true => Some(face),
                    false => child(face, "p"),
                };
                let outline = outline.ok_or_else(|| tree.fault(face, "it has no outline <p>"))?;
                let holes = children(face, "h").map(|hole| input.corners(tree, hole));
                let holes = holes.collect::<Result<Vec<_>, Fault>>()?;
                polygons.add(tree, face, &input.corners(tree, outline)?, &holes)?;
            }
        }
        strips => {
            for p in children(primitive, "p") {
                let corners = input.corners(tree, p)?;
                polygons.triangles.extend(match strips {
                    "trifans" => fan(&corners),
                    _ => strip(&corners),
                });
            }
        }
    }
    Ok(polygons.triangles)
}

/// Faces on their way to triangles.
struct Polygons<'a> {
    points: &'a [DVec3],
    triangles: Vec<[u32; 3]>,
    found: &'a mut Geometry,
    effort: &'a Effort,
}

impl Polygons<'_> {
    fn add(
        &mut self,
        tree: &Tree,
        face: Node,
        corners: &[u32],
        holes: &[Vec<u32>],
    ) -> Result<(), Fault> {
        let split = split(self.points, corners, holes, self.effort)
            .map_err(|reason| tree.fault(face, reason))?;
        self.found.bent += usize::from(split.off_plane.is_some());
        if split.folded {
            self.found.doubtful.get_or_insert_with(|| {
                format!(
                    "line {}: a face is far from plane, and split one way or the other it is another shape; expected plane faces: export the part with triangles",
                    tree.line(face)
                )
            });
        }
        self.triangles.extend(split.triangles);
        Ok(())
    }
}

fn polylist(
    tree: &Tree,
    primitive: Node,
    input: &Input,
    polygons: &mut Polygons,
) -> Result<(), Fault> {
    let element = |name: &str| primitive.children().find(|child| is(*child, name));
    let (Some(counts), Some(p)) = (element("vcount"), element("p")) else {
        // Of no faces.
        return Ok(());
    };
    let all = input.corners(tree, p)?;
    let mut rest = &all[..];
    for count in tree.indices(counts)? {
        let Some((own, others)) = rest.split_at_checked(count as usize) else {
            return Err(tree.fault(
                counts,
                format!("it asks for more corners than the {} of <p>", all.len()),
            ));
        };
        polygons.add(tree, p, own, &[])?;
        rest = others;
    }
    if rest.is_empty() {
        return Ok(());
    }
    Err(tree.fault(
        counts,
        format!("it asks for {} corners less than <p> has", rest.len()),
    ))
}

/// What a primitive's corners mean; none without faces.
fn positions<'a>(
    tree: &Tree<'a>,
    primitive: Node<'a, 'a>,
    shared: &mut Shared,
) -> Result<Option<Input>, Fault> {
    let offset = |input: Node| -> Result<usize, Fault> {
        // `idx` is that of COLLADA 1.3.
        let text = input
            .attribute("offset")
            .or_else(|| input.attribute("idx"))
            .unwrap_or("0");
        let parsed = text
            .trim()
            .parse::<usize>()
            .ok()
            .filter(|offset| *offset < 64);
        parsed.ok_or_else(|| {
            tree.fault(
                input,
                format!("its offset is `{text}`, expected a whole number from 0"),
            )
        })
    };
    let mut stride = 1;
    let mut own = None;
    for input in children(primitive, "input") {
        let offset = offset(input)?;
        stride = stride.max(offset + 1);
        match input.attribute("semantic") {
            Some("VERTEX") => {
                let vertices = tree.target(input, "source", "vertices")?;
                let position = children(vertices, "input")
                    .find(|inner| inner.attribute("semantic") == Some("POSITION"));
                let position =
                    position.ok_or_else(|| tree.fault(vertices, "it has no POSITION"))?;
                own = Some((tree.target(position, "source", "source")?, offset));
            }
            Some("POSITION") if own.is_none() => {
                own = Some((tree.target(input, "source", "source")?, offset));
            }
            _ => {}
        }
    }
    match own {
        Some((source, offset)) => Ok(Some(Input {
            points: shared.points(tree, source)?,
            offset,
            stride,
        })),
        None if child(primitive, "p").is_none() => Ok(None),
        None => Err(tree.fault(primitive, "it has no input VERTEX")),
    }
}

impl Shared {
    fn points<'a>(
        &mut self,
        tree: &Tree<'a>,
        source: Node<'a, 'a>,
    ) -> Result<Rc<Vec<DVec3>>, Fault> {
        let place = source.range().start;
        if let Some(known) = self.points.get(&place) {
            return Ok(Rc::clone(known));
        }
        let read = Rc::new(points(tree, source)?);
        self.points.insert(place, Rc::clone(&read));
        Ok(read)
    }
}

/// Points of a source, as its accessor picks them from its array.
fn points<'a>(tree: &Tree<'a>, source: Node<'a, 'a>) -> Result<Vec<DVec3>, Fault> {
    let accessor = child(source, "technique_common").and_then(|common| child(common, "accessor"));
    let accessor = accessor.ok_or_else(|| tree.fault(source, "it has no accessor"))?;
    let array = match tree.target(accessor, "source", "float_array") {
        Ok(array) => array,
        Err(fault) => tree
            .target(accessor, "source", "int_array")
            .map_err(|_| fault)?,
    };
    let numbers = tree.numbers(array)?;
    let whole = |name: &str, usual: usize| match accessor.attribute(name) {
        None => Ok(usual),
        Some(text) => text.trim().parse::<usize>().map_err(|_| {
            tree.fault(
                accessor,
                format!("its {name} is `{text}`, expected a whole number from 0"),
            )
        }),
    };
    let params: Vec<Option<&str>> = children(accessor, "param")
        .map(|param| param.attribute("name"))
        .collect();
    let (stride, offset) = (whole("stride", params.len().max(1))?, whole("offset", 0)?);
    let named = |name: &str| params.iter().position(|param| *param == Some(name));
    let axes = match (named("X"), named("Y"), named("Z")) {
        (Some(x), Some(y), Some(z)) => [x, y, z],
        // Without names of axes the first three.
        (None, None, None) if params.is_empty() || params.len() >= 3 => [0, 1, 2],
        _ => {
            return Err(tree.fault(
                accessor,
                format!("its {} params do not name X, Y and Z", params.len()),
            ));
        }
    };
    if stride == 0 || axes.iter().any(|axis| *axis >= stride) {
        return Err(tree.fault(
            accessor,
            format!("its stride is {stride}, expected 3 or more for X, Y and Z"),
        ));
    }
    let count = whole("count", numbers.len() / stride)?;
    let present = numbers.get(offset..).unwrap_or_default();
    let entries = present
        .chunks(stride)
        .take_while(|entry| axes.iter().all(|axis| *axis < entry.len()));
    let points: Vec<DVec3> = entries
        .take(count)
        .map(|entry| DVec3::from_array(axes.map(|axis| entry[axis])))
        .collect();
    if points.len() < count {
        return Err(tree.fault(
            accessor,
            format!(
                "it counts {count} points, and its array holds {}",
                points.len()
            ),
        ));
    }
    Ok(points)
}
