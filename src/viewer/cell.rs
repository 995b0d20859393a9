//! Draws the cell in space: bodies, edge path, contact force.

use ::rerun::components::TransformFrameId;
use ::rerun::log::TimeColumn;
use ::rerun::{
    Arrows3D, Boxes3D, Color, CoordinateFrame, Cylinders3D, Ellipsoids3D, EntityPath,
    EntityPathPart, FillMode, LineStrips3D, Mesh3D, Quaternion, Radius, Transform3D,
    ViewCoordinates,
};
use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::colours::{SKY_BLUE, rerun_colour};
use super::options::RerunOptions;
use super::rrd::{RrdError, RrdWriter};
use super::shading::shade;
use super::timelines::Axes;
use crate::arm::VisualShape;
use crate::scene::colour::Colour;
use crate::scene::error_scale::ErrorScale;
use crate::scene::{CollisionShape, EdgePath, Scene, SceneBody, ScenePoses, SceneShape};

/// Entity of which everything in space is a child.
pub(super) const CELL: &str = "/cell";
/// Entity of the edge path.
pub(super) const EDGE_PATH: &str = "/cell/edge_path";
/// Entity of the contact force's arrow.
pub(super) const CONTACT_FORCE: &str = "/cell/contact_force";

/// Entity of what is checked for collisions, a child for each body.
pub(super) const COLLISION: &str = "/cell/collision";

/// Colour of what is checked for collisions: unlike any body's, and seen through.
const COLLISION_COLOUR: Colour = [204, 121, 167, 110];
/// Half width of the edge path's line on the screen [points].
const EDGE_PATH_RADIUS: f32 = 2.5;
/// Half width of the force arrow's shaft [m].
const ARROW_RADIUS: f32 = 0.004;
/// Distance of the force arrow from the contact, sideways as the eye sees it [m]; at the contact
/// itself it would be hidden in the tool.
const ARROW_OFFSET: f64 = 0.045;

/// Writes the bodies, and where those are that do not move.
pub(super) fn write_bodies(rrd: &mut RrdWriter, scene: &Scene) -> Result<(), RrdError> {
    rrd.add_static(CELL, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    for body in &scene.bodies {
        let entity = body_entity(body);
        if let ScenePoses::Static(pose) = &body.world_from_body {
            rrd.add_static(&entity, &transform(pose))?;
        }
        for (index, shape) in body.shapes.iter().enumerate() {
            write_shape(rrd, &format!("{entity}/part_{}", index + 1), shape)?;
        }
    }
    for shape in &scene.collision_shapes {
        write_collision_shape(rrd, shape)?;
    }
    // The colour that the contact force has in its plot.
    let look = Arrows3D::update_fields()
        .with_colors([rerun_colour(SKY_BLUE)])
        .with_radii([Radius::new_scene_units(ARROW_RADIUS)]);
    rrd.add_static(CONTACT_FORCE, &look)
}

/// Writes what changes from frame to frame: bodies that move, and the contact force. `path_before` as in [`Axes::of_frames`].
pub(super) fn write_frames(
    rrd: &mut RrdWriter,
    scene: &Scene,
    path_before: f64,
    options: &RerunOptions,
) -> Result<(), RrdError> {
    let frames = Axes::of_frames(scene, path_before);
    for body in &scene.bodies {
        if let ScenePoses::Moving(poses) = &body.world_from_body {
            write_motion(rrd, &body_entity(body), frames.all_columns(), poses)?;
        }
    }
    write_contact_force(rrd, scene, frames.all_columns(), options)
}

fn body_entity(body: &SceneBody) -> String {
    format!("{CELL}/{}", body.entity)
}

fn write_motion(
    rrd: &mut RrdWriter,
    entity: &str,
    times: Vec<TimeColumn>,
    poses: &[DPose3],
) -> Result<(), RrdError> {
    let motion = Transform3D::new()
        .with_many_translation(poses.iter().map(|pose| triple(pose.translation)))
        .with_many_quaternion(poses.iter().map(|pose| quaternion(pose.rotation)));
    rrd.add_columns(entity, times, motion.columns_of_unit_batches()?)
}

fn write_shape(rrd: &mut RrdWriter, entity: &str, shape: &SceneShape) -> Result<(), RrdError> {
    rrd.add_static(entity, &transform(&shape.body_from_shape))?;
    let colour: Color = rerun_colour(shape.colour);
    match &shape.geometry {
        VisualShape::Box { size } => {
            let solid = Boxes3D::from_half_sizes([triple(*size / 2.0)])
                .with_colors([colour])
                .with_fill_mode(FillMode::Solid);
            rrd.add_static(entity, &solid)
        }
        VisualShape::Cylinder { radius, length } => {
            let solid = Cylinders3D::from_lengths_and_radii([*length as f32], [*radius as f32])
                .with_colors([colour])
                .with_fill_mode(FillMode::Solid);
            rrd.add_static(entity, &solid)
        }
        VisualShape::Sphere { radius } => {
            let solid = Ellipsoids3D::from_radii([*radius as f32])
                .with_colors([colour])
                .with_fill_mode(FillMode::Solid);
            rrd.add_static(entity, &solid)
        }
        VisualShape::Mesh {
            vertices,
            triangles,
        } => {
            let mesh = shade(vertices, triangles);
            let solid = Mesh3D::new(mesh.positions)
                .with_vertex_normals(mesh.normals)
                .with_albedo_factor(*colour);
            rrd.add_static(entity, &solid)
        }
    }
}

/// In the frame of the body that it moves with, so that the file holds that body's poses once.
fn write_collision_shape(rrd: &mut RrdWriter, shape: &CollisionShape) -> Result<(), RrdError> {
    let entity = EntityPath::from(COLLISION).join(&vec![EntityPathPart::new(&*shape.name)].into());
    let entity = entity.to_string();
    if let Some(with) = &shape.moves_with {
        let frame = EntityPath::from(format!("{CELL}/{with}"));
        let frame = TransformFrameId::from_entity_path(&frame);
        rrd.add_static(&entity, &CoordinateFrame::new(frame))?;
    }
    let mesh = shade(&shape.vertices, &shape.triangles);
    let solid = Mesh3D::new(mesh.positions)
        .with_vertex_normals(mesh.normals)
        .with_albedo_factor(*rerun_colour(COLLISION_COLOUR));
    rrd.add_static(&entity, &solid)
}

/// One strip per segment, so that each has its colour.
pub(super) fn write_edge_path(rrd: &mut RrdWriter, path: &EdgePath) -> Result<(), RrdError> {
    let corners = path.points_in_world.windows(2);
    let strips: Vec<[[f32; 3]; 2]> = corners
        .map(|ends| [triple(ends[0]), triple(ends[1])])
        .collect();
    if strips.is_empty() {
        return Ok(());
    }
    let errors = path.relative_force_error.iter();
    let scale = ErrorScale::of(path);
    let lines = LineStrips3D::new(strips)
        .with_colors(errors.map(|error| rerun_colour(scale.colour(*error))))
        .with_radii([Radius::new_ui_points(EDGE_PATH_RADIUS)]);
    rrd.add_static(EDGE_PATH, &lines)
}

/// The force that the workpiece takes, its tip beside the point of contact.
fn write_contact_force(
    rrd: &mut RrdWriter,
    scene: &Scene,
    times: Vec<TimeColumn>,
    options: &RerunOptions,
) -> Result<(), RrdError> {
    let acts = |force: DVec3| force.length() > 0.0;
    let arrows = &scene.contact_arrows;
    let drawn: Vec<_> = arrows.iter().filter(|a| acts(a.force_in_world)).collect();
    if arrows.is_empty() {
        return Ok(());
    }
    let vectors: Vec<DVec3> = drawn
        .iter()
        .map(|arrow| arrow.force_in_world * options.arrow_metres_per_newton)
        .collect();
    let origins = drawn.iter().zip(&vectors).map(|(arrow, vector)| {
        let sideways = options.eye_direction.cross(*vector).normalize_or_zero();
        triple(arrow.point_in_world + ARROW_OFFSET * sideways - *vector)
    });
    let columns = Arrows3D::from_vectors(vectors.iter().map(|vector| triple(*vector)))
        .with_origins(origins)
        .columns(arrows.iter().map(|a| usize::from(acts(a.force_in_world))))?;
    rrd.add_columns(CONTACT_FORCE, times, columns)
}

fn transform(pose: &DPose3) -> Transform3D {
    Transform3D::new()
        .with_translation(triple(pose.translation))
        .with_quaternion(quaternion(pose.rotation))
}

fn triple(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}

fn quaternion(rotation: DQuat) -> Quaternion {
    Quaternion::from_xyzw(rotation.as_quat().to_array())
}
