//! The cell's bodies that must not meet.

use glamx::DPose3;
use std::path::Path;

use super::device_shape::DeviceShape;
use super::error::CellError;
use super::part::Part;
use crate::arm::chain::KinematicChain;
use crate::arm::{Arm, Visual, VisualShape};
use crate::collision::{
    Body, CollisionModel, ModelError, ModelRequest, Mount, RiddenEdge, Role, Solid, fixed_body,
    floor_at, links_of, robot_body,
};
use crate::plant::{Nominal, PlantParameters};
use crate::scenario::{Obstacle, ObstacleShape, Scenario};
use crate::workpiece::load_mesh;

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
    let mut bodies = links_of(arm, base).map_err(refused)?;
    bodies.extend(device(&scenario.nominal, arm).map_err(refused)?);
    let world_from_part = scenario.workpiece.world_from_part;
    let surface = Solid::surface(&part.mesh).map_err(|source| {
        refused(ModelError::Solid {
            body: "part".to_owned(),
            source,
        })
    })?;
    bodies.push((Role::Part, fixed_body("part", world_from_part, surface)));
    for obstacle in &scenario.collision.obstacles {
        bodies.push((
            Role::Obstacle,
            obstacle_body(obstacle, &scenario.path, notes)?,
        ));
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
        bodies.extend(robot_body(role, name, Mount::Link(joint), shapes)?);
    }
    Ok(bodies)
}

/// An obstacle that a file states.
///
/// # Errors
/// Its mesh cannot be read, or encloses nothing.
pub fn obstacle_body(
    obstacle: &Obstacle,
    file: &Path,
    notes: &mut Vec<String>,
) -> Result<Body, CellError> {
    let (pose, name) = (obstacle.world_from_obstacle, &obstacle.name);
    let refused = |source| CellError::CollisionModel {
        file: file.to_owned(),
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
    Ok(fixed_body(name, pose, solid.map_err(refused)?))
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
    Some((Role::Floor, floor_at(height)))
}
