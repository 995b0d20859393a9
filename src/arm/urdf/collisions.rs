//! Shapes in the file that nothing may meet: the links' collision geometry, or what is drawn of a link that has none that can be used.

use std::path::Path;

use super::tree::{Placed, Tree, pose_of};
use super::visuals::shapes;
use super::{ArmOptions, CollisionShape, Refusal};
use urdf_rs::{Geometry, Pose};

/// Collision shapes of the base and of the moving links, each with the place in the tree of the link of the file that it belongs to.
pub(super) fn load(
    tree: &Tree,
    folder: &Path,
    options: &ArmOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<(usize, CollisionShape)>, Refusal> {
    let mut found = Vec::new();
    let mut without = Vec::new();
    let mut unusable: Vec<(&str, Refusal)> = Vec::new();
    for (place, placed) in tree.placed.iter().enumerate() {
        let here =
            |shapes: Vec<CollisionShape>| shapes.into_iter().map(move |shape| (place, shape));
        let link = placed.link;
        let own: Vec<_> = (link.collision.iter())
            .map(|collision| (&collision.origin, &collision.geometry))
            .collect();
        let drawn: Vec<_> = (link.visual.iter())
            .map(|visual| (&visual.origin, &visual.geometry))
            .collect();
        if own.is_empty() {
            // The colours and axes of what is drawn have been noted already.
            found.extend(here(of_link(
                placed,
                &drawn,
                folder,
                options,
                &mut Vec::new(),
            )?));
            if !drawn.is_empty() {
                without.push(link.name.as_str());
            }
            continue;
        }
        match of_link(placed, &own, folder, options, notes) {
            Ok(shapes) => found.extend(here(shapes)),
            Err(refusal @ Refusal::Mesh { .. }) if !drawn.is_empty() => {
                unusable.push((link.name.as_str(), refusal));
                found.extend(here(of_link(
                    placed,
                    &drawn,
                    folder,
                    options,
                    &mut Vec::new(),
                )?));
            }
            Err(refusal) => return Err(refusal),
        }
    }
    if !without.is_empty() {
        notes.push(format!(
            "links without collision geometry have for collisions the shape that is drawn of them: {}",
            without.join(", ")
        ));
    }
    if let Some((_, first)) = unusable.first() {
        let links: Vec<&str> = unusable.iter().map(|(link, _)| *link).collect();
        notes.push(format!(
            "{first}; links with collision meshes that cannot be used have the shape that is drawn of them: {}",
            links.join(", ")
        ));
    }
    Ok(found)
}

fn of_link(
    placed: &Placed,
    geometries: &[(&Pose, &Geometry)],
    folder: &Path,
    options: &ArmOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<CollisionShape>, Refusal> {
    let mut found = Vec::new();
    for (origin, geometry) in geometries {
        let link = &placed.link.name;
        let origin = pose_of(origin, || format!("collision origin of link `{link}`"))?;
        for (shape, _, shift) in shapes(placed, geometry, "collision", folder, options, notes)? {
            found.push(CollisionShape {
                link_index: placed.link_index,
                link_from_shape: placed.moving_from_link * origin * shift,
                shape,
            });
        }
    }
    Ok(found)
}
