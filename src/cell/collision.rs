//! The cell's bodies that must not meet.

use glamx::DPose3;

use super::device_shape::DeviceShape;
use super::error::CellError;
use super::part::Part;
use crate::arm::chain::KinematicChain;
use crate::arm::{Arm, Visual, VisualShape};
use crate::collision::{
    Body, CollisionModel, ModelError, ModelRequest, Mount, RiddenEdge, Role, Solid, SolidError,
};
use crate::plant::{Nominal, PlantParameters};
use crate::scenario::{Obstacle, ObstacleShape, Scenario};
use crate::workpiece::load_mesh;

/// Size of the floor, far beyond any arm's reach, and its thickness [m].
const FLOOR: [f64; 2] = [40.0, 1.0];

/// The model of a cell, its part at its nominal pose.
pub(super) fn model(
    scenario: &Scenario,
    arm: &Arm,
    arm_with_slide: &KinematicChain,
    part: &Part,
    notes: &mut Vec<String>,
) -> Result<CollisionModel, CellError> {
    let refused = |source| CellError::CollisionModel {
        file: scenario.path.clone(),
        source,
    };
    let base = scenario.arm.world_from_base;
    let mut bodies = links(arm, base).map_err(refused)?;
    bodies.extend(device(&scenario.nominal, arm).map_err(refused)?);
    let world_from_part = scenario.workpiece.world_from_part;
    let surface = Solid::surface(&part.mesh).map_err(|source| {
        refused(ModelError::Solid {
            body: "part".to_owned(),
            source,
        })
    })?;
    bodies.push((Role::Part, static_body("part", world_from_part, surface)));
    for obstacle in &scenario.collision.obstacles {
        bodies.push((Role::Obstacle, body_of(obstacle, scenario, notes)?));
    }
    bodies.extend(floor(scenario, &bodies, notes));
    let centre = glam::DVec3::new(0.0, 0.0, scenario.nominal.mounting.tool_centre);
    let ball = (centre, scenario.nominal.mounting.tool_radius);
    let model = CollisionModel::new(ModelRequest {
        chain: arm_with_slide,
        world_from_base: scenario.arm.world_from_base,
        bodies,
        ridden: Some(RiddenEdge::new(
            &part.mesh,
            &part.edge,
            world_from_part,
            ball,
        )),
        margin: scenario.collision.margin,
        allowed: &scenario.collision.allowed_pairs,
    })
    .map_err(refused)?;
    if !model.touching_at_rest.is_empty() {
        let pairs = model.touching_at_rest.iter();
        let pairs: Vec<_> = pairs.map(|[one, two]| format!("{one} and {two}")).collect();
        notes.push(format!(
            "not checked for collisions, as they touch with all joints at zero: {}",
            pairs.join("; ")
        ));
    }
    Ok(model)
}

fn static_body(name: &str, pose: DPose3, solid: Solid) -> Body {
    Body {
        name: name.to_owned(),
        mount: Mount::World(pose),
        solids: vec![solid],
    }
}

/// The arm's base and links that have a shape.
fn links(arm: &Arm, world_from_base: DPose3) -> Result<Vec<(Role, Body)>, ModelError> {
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
        bodies.extend(robot(Role::Robot, name, mount, shapes)?);
    }
    Ok(bodies)
}

/// The device's cylinders, and its slide with the tool but for the ball nose.
fn device(nominal: &Nominal<PlantParameters>, arm: &Arm) -> Result<Vec<(Role, Body)>, ModelError> {
    let shape = DeviceShape::of(nominal);
    let count = arm.chain.len();
    let flange = arm.chain.tip_from_last;
    let placed =
        |visual: &Visual, frame: DPose3| (visual.shape.clone(), frame * visual.link_from_visual);
    let fixed: Vec<_> = shape
        .fixed
        .iter()
        .map(|visual| placed(visual, flange))
        .collect();
    let moving: Vec<_> = (shape.moving.iter())
        .map(|visual| placed(visual, DPose3::IDENTITY))
        .collect();
    let mut bodies = Vec::new();
    for (role, name, joint, shapes) in [
        (Role::Device, "device", count - 1, &fixed),
        (Role::Tool, "tool", count, &moving),
    ] {
        let shapes = shapes.iter().map(|(shape, pose)| (shape, *pose));
        bodies.extend(robot(role, name, Mount::Link(joint), shapes)?);
    }
    Ok(bodies)
}

/// A body of the robot's; none without shapes.
fn robot<'a>(
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

fn body_of(
    obstacle: &Obstacle,
    scenario: &Scenario,
    notes: &mut Vec<String>,
) -> Result<Body, CellError> {
    let (pose, name) = (obstacle.world_from_obstacle, &obstacle.name);
    let refused = |source| CellError::CollisionModel {
        file: scenario.path.clone(),
        source: ModelError::Solid {
            body: name.clone(),
            source,
        },
    };
    let solid = match &obstacle.shape {
        ObstacleShape::Box(size) => {
            Solid::convex(&VisualShape::Box { size: *size }, DPose3::IDENTITY)
        }
        ObstacleShape::Mesh { path, scale } => {
            let mesh = load_mesh(path, *scale)?;
            let said = mesh.notes().iter();
            notes.extend(said.map(|note| format!("{}: {note}", path.display())));
            Solid::surface(&mesh)
        }
    };
    Ok(static_body(name, pose, solid.map_err(refused)?))
}

/// The floor: where the scenario says, else through the world's origin unless something of the cell stands below it.
fn floor(
    scenario: &Scenario,
    bodies: &[(Role, Body)],
    notes: &mut Vec<String>,
) -> Option<(Role, Body)> {
    const BELOW: f64 = 1e-2;
    let base = scenario.arm.world_from_base.translation.z;
    let lowest = CollisionModel::lowest(bodies).min(base);
    let height = match scenario.collision.floor_height {
        Some(height) => height,
        None if lowest < -BELOW => {
            notes.push(format!(
                "no floor is checked for collisions, as the cell reaches {:.0} mm below the world's origin; collision.floor_height_mm says where it is",
                -1e3 * lowest
            ));
            return None;
        }
        None => 0.0,
    };
    let [size, thickness] = FLOOR;
    let slab = VisualShape::Box {
        size: glam::DVec3::new(size, size, thickness),
    };
    let middle = glam::DVec3::new(0.0, 0.0, height - 0.5 * thickness);
    let solid = Solid::convex(&slab, DPose3::IDENTITY).ok()?;
    Some((
        Role::Floor,
        static_body("floor", DPose3::from_translation(middle), solid),
    ))
}
