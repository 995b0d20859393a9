//! Shapes in the file that are drawn, their poses and colours.

use super::mesh::{self, MeshPart, bytes};
use super::tree::{LONGEST, Placed, Tree, pose_of, within};
use super::{ArmOptions, Refusal, Visual, VisualShape};
use glam::DVec3;
use glamx::DPose3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use urdf_rs::{Geometry, Material};

/// Colour of shapes whose file names none: a light grey.
const DEFAULT_COLOUR: [u8; 4] = [184, 186, 190, 255];

/// All visuals of the base and of the moving links.
pub(super) fn load(
    tree: &Tree,
    folder: &Path,
    options: &ArmOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<Visual>, Refusal> {
    let colours = named_colours(tree);
    let mut uncoloured = BTreeSet::new();
    let mut visuals = Vec::new();
    for placed in &tree.placed {
        for source in &placed.link.visual {
            let link = &placed.link.name;
            let origin = pose_of(&source.origin, || format!("visual origin of link `{link}`"))?;
            let pose = placed.moving_from_link * origin;
            let material = source.material.as_ref();
            let colour = material.and_then(|material| colour_of(material, &colours));
            if let (None, Some(material)) = (colour, material) {
                uncoloured.insert(material.name.clone());
            }
            for (shape, own_colour, shift) in
                shapes(placed, &source.geometry, "visual", folder, options, notes)?
            {
                visuals.push(Visual {
                    link_index: placed.link_index,
                    link_from_visual: pose * shift,
                    shape,
                    colour: colour.or(own_colour).unwrap_or(DEFAULT_COLOUR),
                });
            }
        }
    }
    if !uncoloured.is_empty() {
        let names: Vec<_> = uncoloured.into_iter().collect();
        notes.push(format!(
            "materials without a colour (textures are not drawn): {}",
            names.join(", ")
        ));
    }
    Ok(visuals)
}

/// Colours by material name: those of the robot, else the first place that gives the name a colour.
fn named_colours<'a>(tree: &Tree<'a>) -> BTreeMap<&'a str, [u8; 4]> {
    let robot = tree.robot;
    let in_links = robot.links.iter().flat_map(|link| &link.visual);
    let in_links = in_links.filter_map(|visual| visual.material.as_ref());
    let mut colours = BTreeMap::new();
    for material in robot.materials.iter().chain(in_links) {
        if let Some(colour) = &material.color {
            colours
                .entry(material.name.as_str())
                .or_insert_with(|| bytes(*colour.rgba));
        }
    }
    colours
}

fn colour_of(material: &Material, named: &BTreeMap<&str, [u8; 4]>) -> Option<[u8; 4]> {
    match &material.color {
        Some(colour) => Some(bytes(*colour.rgba)),
        None => named.get(material.name.as_str()).copied(),
    }
}

type Shape = (VisualShape, Option<[u8; 4]>, DPose3);

/// The shapes of one geometry, each with a colour of its own if it has one, and its shift; `role` is visual or collision.
pub(super) fn shapes(
    placed: &Placed,
    geometry: &Geometry,
    role: &'static str,
    folder: &Path,
    options: &ArmOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<Shape>, Refusal> {
    let link = &placed.link.name;
    let plain = |shape| (shape, None, DPose3::IDENTITY);
    let positive = |shape, values: &[f64]| {
        if values.iter().all(|value| value.is_finite() && *value > 0.0) {
            let most = values.iter().copied().fold(0.0, f64::max);
            within(most, LONGEST, "m", || {
                format!("{role} {shape} of link `{link}`")
            })
        } else {
            Err(Refusal::ShapeSize {
                link: link.clone(),
                role,
                shape,
                value: format!("{values:?}"),
            })
        }
    };
    match geometry {
        Geometry::Box { size } => {
            positive("box", &**size)?;
            let size = DVec3::from_array(**size);
            Ok(vec![plain(VisualShape::Box { size })])
        }
        Geometry::Cylinder { radius, length } => {
            positive("cylinder", &[*radius, *length])?;
            let (radius, length) = (*radius, *length);
            Ok(vec![plain(VisualShape::Cylinder { radius, length })])
        }
        Geometry::Sphere { radius } => {
            positive("sphere", &[*radius])?;
            Ok(vec![plain(VisualShape::Sphere { radius: *radius })])
        }
        Geometry::Capsule { radius, length } => {
            positive("capsule", &[*radius, *length])?;
            let (radius, length) = (*radius, *length);
            let cap = |z: f64| {
                let shift = DPose3::from_translation(DVec3::new(0.0, 0.0, z));
                (VisualShape::Sphere { radius }, None, shift)
            };
            let tube = plain(VisualShape::Cylinder { radius, length });
            Ok(vec![tube, cap(0.5 * length), cap(-0.5 * length)])
        }
        Geometry::Mesh { filename, scale } => {
            let scale = scale.map_or(DVec3::ONE, |scale| DVec3::from_array(*scale));
            let refused = |reason| Refusal::Mesh {
                link: link.clone(),
                role,
                mesh: filename.clone(),
                reason,
            };
            let parts = mesh::load(filename, scale, folder, options, notes).map_err(refused)?;
            let points = parts.iter().flat_map(|part| &part.vertices);
            let most = points.fold(0.0, |most: f64, point| most.max(point.abs().max_element()));
            within(most, LONGEST, "m", || {
                format!("a coordinate of {role} mesh `{filename}` of link `{link}`, by its scale,")
            })?;
            let shape = |part: MeshPart| {
                let shape = VisualShape::Mesh {
                    vertices: part.vertices,
                    triangles: part.triangles,
                };
                (shape, part.colour, DPose3::IDENTITY)
            };
            Ok(parts.into_iter().map(shape).collect())
        }
    }
}
