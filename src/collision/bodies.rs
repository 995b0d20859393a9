//! Bodies that every model is made of: an arm's links, what stands in the world, the floor.

use glam::DVec3;
use glamx::DPose3;

use super::body::{Body, Mount, Solid, SolidError};
use super::model::{ModelError, Role};
use crate::arm::{Arm, VisualShape};

/// Size of the floor, far beyond any arm's reach, and its thickness [m].
const FLOOR: [f64; 2] = [40.0, 1.0];

/// A body that stands in the world.
#[must_use]
pub fn fixed_body(name: &str, pose: DPose3, solid: Solid) -> Body {
    Body {
        name: name.to_owned(),
        mount: Mount::World(pose),
        solids: vec![solid],
    }
}

/// The arm's base and links that have a shape.
///
/// # Errors
/// A shape without volume.
pub fn links_of(arm: &Arm, world_from_base: DPose3) -> Result<Vec<(Role, Body)>, ModelError> {
    let mut bodies = Vec::new();
    for (index, name) in arm.link_names.iter().enumerate() {
        let own = arm
            .collisions
            .iter()
            .filter(|shape| shape.link_index == index);
        let shapes = own.map(|own| (&own.shape, own.link_from_shape));
        let mount = match index {
            0 => Mount::World(world_from_base),
            _ => Mount::Link(index - 1),
        };
        bodies.extend(robot_body(Role::Robot, name, mount, shapes)?);
    }
    Ok(bodies)
}

/// A body of the robot's; none without shapes.
///
/// # Errors
/// A shape without volume.
pub fn robot_body<'a>(
    role: Role,
    name: &str,
    mount: Mount,
    shapes: impl Iterator<Item = (&'a VisualShape, DPose3)>,
) -> Result<Option<(Role, Body)>, ModelError> {
    let refused = |source: SolidError| ModelError::Solid {
        body: name.to_owned(),
        source,
    };
    let solids: Vec<Solid> = shapes
        .map(|(shape, pose)| Solid::convex(shape, pose).map_err(refused))
        .collect::<Result<_, _>>()?;
    if solids.is_empty() {
        return Ok(None);
    }
    let body = Body {
        name: name.to_owned(),
        mount,
        solids,
    };
    Ok(Some((role, body)))
}

/// The floor at a height [m].
#[must_use]
pub fn floor_at(height: f64) -> Body {
    let [size, thickness] = FLOOR;
    let slab = Solid::cuboid(DVec3::new(size, size, thickness));
    let middle = DVec3::new(0.0, 0.0, height - 0.5 * thickness);
    fixed_body("floor", DPose3::from_translation(middle), slab)
}
