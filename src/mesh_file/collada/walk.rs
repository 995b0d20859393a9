//! The nodes of a scene: transforms one after the other as they are written, the last first on a point; instances of geometries and of other nodes.

use std::collections::BTreeMap;

use glam::{DMat3, DMat4, DVec3};
use roxmltree::Node;

use super::geometry::{Geometry, Shared, geometry};
use super::material::{colour, material};
use super::tree::{Tree, is};
use crate::mesh_file::scene::{Assembly, Fault, MeshPart};

/// Levels of nodes and instances of nodes in each other; of more, or of nodes that hold themselves, there is no end.
const DEEPEST: usize = 200;

pub(super) struct Walk<'a> {
    tree: &'a Tree<'a>,
    /// Geometries that were read already, by their place in the text.
    known: BTreeMap<usize, Geometry>,
    shared: Shared,
    /// Colours of materials, by their place in the text.
    colours: BTreeMap<usize, Option<[f64; 4]>>,
    depth: usize,
    /// Faces that are not plane.
    pub(super) bent: usize,
    /// Why the file leaves open which solid it means.
    pub(super) doubtful: Option<String>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(tree: &'a Tree<'a>) -> Self {
        Self {
            tree,
            known: BTreeMap::new(),
            shared: Shared::new(),
            colours: BTreeMap::new(),
            depth: 0,
            bent: 0,
            doubtful: None,
        }
    }

    /// What the nodes in an element hold.
    pub(super) fn children(
        &mut self,
        parent: Node<'a, 'a>,
        place: DMat4,
        assembly: &mut Assembly,
    ) -> Result<(), Fault> {
        for node in parent.children().filter(|child| is(*child, "node")) {
            self.node(node, place, assembly)?;
        }
        Ok(())
    }

    /// Every geometry where it is, of a document without a scene.
    pub(super) fn all_geometries(
        &mut self,
        place: DMat4,
        assembly: &mut Assembly,
    ) -> Result<(), Fault> {
        let all: Vec<_> = self
            .tree
            .root()
            .descendants()
            .filter(|node| is(*node, "geometry"))
            .collect();
        for node in &all {
            self.instance(*node, None, place, assembly)?;
        }
        if !all.is_empty() {
            assembly
                .file
                .notes
                .push("it has no scene: its geometries were read where they are".to_owned());
        }
        Ok(())
    }

    fn node(
        &mut self,
        node: Node<'a, 'a>,
        parent: DMat4,
        assembly: &mut Assembly,
    ) -> Result<(), Fault> {
        if self.depth > DEEPEST {
            return Err(self.tree.fault(
                node,
                format!("it lies more than {DEEPEST} nodes deep, or in itself"),
            ));
        }
        self.depth += 1;
        assembly.pass(1 + node.children().count())?;
        let mut place = parent;
        for child in node.children().filter(Node::is_element) {
            if let Some(transform) = self.transform(child)? {
                place *= transform;
            }
        }
        for child in node.children().filter(Node::is_element) {
            match child.tag_name().name() {
                "instance_geometry" => {
                    let target = self.tree.target(child, "url", "geometry")?;
                    self.instance(target, Some(child), place, assembly)?;
                }
                "instance_node" => {
                    let target = self.tree.target(child, "url", "node")?;
                    self.node(target, place, assembly)?;
                }
                "instance_controller" => {
                    return Err(Fault::unsupported(
                        format!(
                            "line {}: <instance_controller> (a skin or a morph)",
                            self.tree.line(child)
                        ),
                        "export the mesh as it stands, without bones",
                    ));
                }
                "node" => self.node(child, place, assembly)?,
                _ => {}
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn instance(
        &mut self,
        element: Node<'a, 'a>,
        instance: Option<Node<'a, 'a>>,
        place: DMat4,
        assembly: &mut Assembly,
    ) -> Result<(), Fault> {
        if !self.known.contains_key(&element.range().start) {
            let read = geometry(self.tree, element, &mut self.shared)?;
            self.bent += read.bent;
            if self.doubtful.is_none() {
                self.doubtful.clone_from(&read.doubtful);
            }
            self.known.insert(element.range().start, read);
        }
        let parts = &self.known[&element.range().start].parts;
        // Each part looks for its material there.
        let bound = instance.map_or(0, |instance| instance.descendants().count());
        for (symbol, triangles) in parts {
            assembly.pass(bound)?;
            let own = instance.and_then(|instance| material(self.tree, instance, symbol));
            let part = MeshPart {
                colour: own.and_then(|own| {
                    let known = self.colours.entry(own.range().start);
                    *known.or_insert_with(|| colour(self.tree, own))
                }),
                ..triangles.clone()
            };
            assembly.place(&part, place)?;
        }
        Ok(())
    }

    /// The matrix of a transform; none of any other element.
    fn transform(&self, element: Node<'a, 'a>) -> Result<Option<DMat4>, Fault> {
        let name = element.tag_name().name();
        let count = match name {
            "translate" | "scale" => 3,
            "rotate" => 4,
            "skew" => 7,
            "lookat" => 9,
            "matrix" => 16,
            _ => return Ok(None),
        };
        let numbers = self.tree.numbers(element)?;
        if numbers.len() != count || numbers.iter().any(|number| !number.is_finite()) {
            return Err(self.tree.fault(
                element,
                format!(
                    "it has {} numbers, expected {count} finite ones",
                    numbers.len()
                ),
            ));
        }
        let vector = |from: usize| DVec3::from_slice(&numbers[from..from + 3]);
        let matrix = match name {
            "translate" => Some(DMat4::from_translation(vector(0))),
            "scale" => Some(DMat4::from_scale(vector(0))),
            // About no axis by no angle, as some write it.
            "rotate" => match vector(0).try_normalize() {
                Some(axis) => Some(DMat4::from_axis_angle(axis, numbers[3].to_radians())),
                None => (numbers[3] == 0.0).then_some(DMat4::IDENTITY),
            },
            "skew" => skew(numbers[0].to_radians(), vector(1), vector(4)),
            "lookat" => lookat(vector(0), vector(3), vector(6)),
            // Written row by row.
            _ => affine(&numbers),
        };
        match matrix {
            Some(matrix) => Ok(Some(matrix)),
            None => Err(self.tree.fault(element, "it is no transform: its directions are zero or fall together, or its last row is not 0 0 0 1")),
        }
    }
}

fn affine(numbers: &[f64]) -> Option<DMat4> {
    let mut rows = [0.0; 16];
    rows.copy_from_slice(numbers);
    (rows[12..] == [0.0, 0.0, 0.0, 1.0]).then(|| DMat4::from_cols_array(&rows).transpose())
}

/// Puts what looks along its own -z, with y up, at a place from where it looks at another.
fn lookat(eye: DVec3, interest: DVec3, up: DVec3) -> Option<DMat4> {
    let back = (eye - interest).try_normalize()?;
    let right = up.cross(back).try_normalize()?;
    let axes = DMat3::from_cols(right, back.cross(right), back);
    Some(DMat4::from_translation(eye) * DMat4::from_mat3(axes))
}

/// As RenderMan has it, after which COLLADA's is made: what lies along `along` turns by an angle towards `to`, each point moving parallel to `to`.
fn skew(angle: f64, along: DVec3, to: DVec3) -> Option<DMat4> {
    let (along, to) = (along.try_normalize()?, to.try_normalize()?);
    let between = along.angle_between(to);
    let across = along.reject_from_normalized(to);
    if angle.abs() >= between || across.length_squared() < 1e-24 {
        return None;
    }
    let share = angle.sin() / (between - angle).sin();
    let height = across / across.length_squared();
    let moved = [height.x, height.y, height.z].map(|height| share * height * to);
    let shear = DMat3::IDENTITY + DMat3::from_cols(moved[0], moved[1], moved[2]);
    Some(DMat4::from_mat3(shear))
}
