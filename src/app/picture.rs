//! The scene that belongs to a run: arm, device, workpiece, edge, contact force.

use glam::DVec3;
use glamx::DPose3;

use crate::arm::{Arm, Visual, VisualShape};
use crate::cell::{Cell, DeviceShape};
use crate::collision::{Body, Mount, Role};
use crate::drawing::{CrossSection, cross_section};
use crate::path::{Phase, Reference};
use crate::plant::{Nominal, PlantParameters};
use crate::recording::csv::EdgeProfile;
use crate::recording::{Recording, RecordingError, schema};
use crate::scene::colour::Colour;
use crate::scene::finished_edge::FinishedEdge;
use crate::scene::{
    CollisionShape, ContactArrow, EdgePath, Scene, SceneBody, SceneLimits, ScenePoses, SceneShape,
};
use crate::simulation::FrameLog;

/// Segments of the drawn edge.
const EDGE_SEGMENTS: usize = 400;
pub(super) const PART: Colour = [150, 165, 178, 255];
const OBSTACLE: Colour = [200, 190, 170, 255];
/// Entity of the device's slide with the tool.
const SLIDE: &str = "device/slide";

/// Builds the scene of a run.
///
/// # Errors
/// The recording lacks a channel.
pub fn scene_of(
    cell: &Cell,
    recording: &Recording,
    frames: &FrameLog,
) -> Result<Scene, RecordingError> {
    let mut scene = motion_of(cell, frames);
    for (index, body) in scene.bodies.iter_mut().enumerate() {
        body.shapes.extend(visual_shapes(&cell.setup.arm, index));
    }
    scene.bodies.push(part(cell));
    scene.bodies.extend(obstacles(cell));
    scene.collision_shapes = collision_shapes(cell);
    scene.edge_path = edge_path(cell, recording)?;
    Ok(scene)
}

/// The part of the scene that changes from frame to frame: no arm's shapes, no part, no edge.
pub(super) fn motion_of(cell: &Cell, frames: &FrameLog) -> Scene {
    let mut bodies = arm(cell, frames);
    bodies.extend(device(cell, frames));
    Scene {
        title: cell.setup.scenario.title.clone(),
        bodies,
        collision_shapes: Vec::new(),
        frame_times: frames.times.clone(),
        frame_path_lengths: frames.path_lengths.clone(),
        edge_path: EdgePath::default(),
        finished_edge: None,
        contact_arrows: frames
            .contact_points
            .iter()
            .zip(&frames.contact_forces)
            .map(|(&point_in_world, &force_in_world)| ContactArrow {
                point_in_world,
                force_in_world,
            })
            .collect(),
        limits: SceneLimits {
            stroke: Some([0.0, cell.setup.scenario.nominal.device.full_stroke]),
            joint_torque: cell
                .setup
                .arm
                .chain
                .joints
                .iter()
                .map(|joint| joint.effort)
                .collect(),
        },
    }
}

fn arm(cell: &Cell, frames: &FrameLog) -> Vec<SceneBody> {
    let count = cell.setup.arm.chain.len();
    (0..=count)
        .map(|index| SceneBody {
            entity: arm_entity(&cell.setup.arm.link_names[index]),
            shapes: Vec::new(),
            world_from_body: match index {
                0 => ScenePoses::Static(cell.setup.scenario.arm.world_from_base),
                _ => {
                    ScenePoses::Moving(frames.links.iter().map(|links| links[index - 1]).collect())
                }
            },
        })
        .collect()
}

fn arm_entity(link: &str) -> String {
    // A path has no parts without letters; a link's name may have.
    let parts = link
        .split('/')
        .map(|part| if part.is_empty() { "_" } else { part });
    format!("arm/{}", parts.collect::<Vec<_>>().join("/"))
}

/// Appearance of a link of the arm; nothing beyond the last.
pub(super) fn visual_shapes(arm: &Arm, link: usize) -> impl Iterator<Item = SceneShape> {
    let visuals = arm.visuals.iter();
    visuals
        .filter(move |visual| visual.link_index == link)
        .map(shape_of)
}

fn shape_of(visual: &Visual) -> SceneShape {
    SceneShape {
        body_from_shape: visual.link_from_visual,
        geometry: visual.shape.clone(),
        colour: visual.colour,
    }
}

fn device(cell: &Cell, frames: &FrameLog) -> [SceneBody; 2] {
    let last = cell.setup.arm.chain.len() - 1;
    let flange = |links: &Vec<DPose3>| links[last] * cell.setup.arm.chain.tip_from_last;
    device_bodies(
        &cell.setup.scenario.nominal,
        ScenePoses::Moving(frames.links.iter().map(flange).collect()),
        ScenePoses::Moving(frames.links.iter().map(|links| links[last + 1]).collect()),
    )
}

/// The device to its own measures: cylinders on the flange, carriage, spindle and ball nose on the slide.
pub(super) fn device_bodies(
    nominal: &Nominal<PlantParameters>,
    world_from_flange: ScenePoses,
    world_from_slide: ScenePoses,
) -> [SceneBody; 2] {
    let shape = DeviceShape::of(nominal);
    let moving = shape.moving.iter().chain([&shape.ball]);
    [
        SceneBody {
            entity: "device/cylinders".into(),
            shapes: shape.fixed.iter().map(shape_of).collect(),
            world_from_body: world_from_flange,
        },
        SceneBody {
            entity: SLIDE.into(),
            shapes: moving.map(shape_of).collect(),
            world_from_body: world_from_slide,
        },
    ]
}

/// What stands in the cell beside arm and part.
fn obstacles(cell: &Cell) -> impl Iterator<Item = SceneBody> {
    let obstacles = cell.setup.scenario.collision.obstacles.iter().enumerate();
    obstacles.filter_map(|(index, obstacle)| {
        let body = (cell.setup.collision.bodies()).find(|body| body.name == obstacle.name)?;
        let shapes = body.solids.iter().map(|solid| {
            let (vertices, triangles) = solid.triangles();
            SceneShape {
                body_from_shape: DPose3::IDENTITY,
                geometry: VisualShape::Mesh {
                    vertices,
                    triangles,
                },
                colour: OBSTACLE,
            }
        });
        Some(SceneBody {
            entity: format!("obstacles/{}", index + 1),
            shapes: shapes.collect(),
            world_from_body: ScenePoses::Static(obstacle.world_from_obstacle),
        })
    })
}

/// What is checked for collisions, but for the floor, which would hide the cell: the part at its nominal pose.
fn collision_shapes(cell: &Cell) -> Vec<CollisionShape> {
    let checked = cell.setup.collision.bodies_with_roles();
    let shown = checked.filter(|(role, _)| *role != Role::Floor);
    shown.map(|(_, body)| collision_shape(cell, body)).collect()
}

/// All solids of a body as one mesh.
fn collision_shape(cell: &Cell, body: &Body) -> CollisionShape {
    let (moves_with, pose) = match body.mount {
        Mount::World(pose) => (None, pose),
        Mount::Link(joint) => {
            let with = match cell.setup.arm.link_names.get(joint + 1) {
                Some(link) => arm_entity(link),
                None => SLIDE.to_owned(),
            };
            (Some(with), DPose3::IDENTITY)
        }
    };
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for solid in &body.solids {
        let (corners, own) = solid.triangles();
        let before = vertices.len() as u32;
        vertices.extend(corners.iter().map(|corner| pose.transform_point(*corner)));
        triangles.extend(own.iter().map(|own| own.map(|index| index + before)));
    }
    CollisionShape {
        name: body.name.clone(),
        moves_with,
        vertices,
        triangles,
    }
}

fn part(cell: &Cell) -> SceneBody {
    SceneBody {
        entity: "workpiece".into(),
        shapes: vec![SceneShape {
            body_from_shape: DPose3::IDENTITY,
            geometry: VisualShape::Mesh {
                vertices: cell.setup.part.mesh.vertices().to_vec(),
                triangles: cell.setup.part.mesh.triangles().to_vec(),
            },
            colour: PART,
        }],
        world_from_body: ScenePoses::Static(cell.setup.part.world_from_part),
    }
}

/// The motion that is planned in the middle of following.
pub(super) fn in_the_middle(cell: &Cell) -> Reference {
    let phases = cell.plan.phases();
    let follow = phases.iter().find(|(phase, ..)| *phase == Phase::Follow);
    let middle = follow.map_or(0.5 * cell.plan.duration(), |(_, from, to)| {
        0.5 * (from + to)
    });
    cell.plan.reference(middle)
}

/// How the tool stands across the edge in the middle of following, as a picture.
pub(super) fn across_the_edge(cell: &Cell) -> String {
    let reference = in_the_middle(cell);
    let place = cell.setup.part.edge.at(reference.edge_length);
    let turn = cell.setup.scenario.workpiece.world_from_part.rotation;
    cross_section(&CrossSection {
        tangent: reference.tangent,
        normals: [turn * place.normal_a, turn * place.normal_b],
        bisector: reference.normal,
        axis: reference.axis,
        gravity: cell.setup.scenario.simulation.gravity,
    })
}

/// The edge before and after it was worked, where it really lies.
#[must_use]
pub fn finished_edge(cell: &Cell, profile: &EdgeProfile) -> FinishedEdge {
    let part = cell.setup.part.world_from_part;
    let stations = profile
        .place
        .iter()
        .map(|place| cell.setup.part.edge.at(*place));
    let stations: Vec<_> = stations.collect();
    // Along a face, away from the edge: against the other face's normal.
    let into =
        |own: DVec3, other: DVec3| part.rotation * (-other).reject_from(own).normalize_or_zero();
    let chamfer = cell.setup.scenario.workpiece.chamfer;
    FinishedEdge {
        points_in_world: (stations.iter().map(|at| part.transform_point(at.point))).collect(),
        outwards: (stations.iter().map(|at| part.rotation * at.bisector)).collect(),
        into_faces: (stations.iter())
            .map(|at| {
                [
                    into(at.normal_a, at.normal_b),
                    into(at.normal_b, at.normal_a),
                ]
            })
            .collect(),
        burr_before: profile.burr_before.clone(),
        burr_after: profile.burr_after.clone(),
        chamfer_leg: profile.chamfer_leg.clone(),
        leg_limits: chamfer.leg,
        burr_limit: chamfer.residual_burr,
        course: Vec::new(),
    }
}

/// The edge as it was planned, with the mean relative error of the force over each segment while following.
fn edge_path(cell: &Cell, recording: &Recording) -> Result<EdgePath, RecordingError> {
    let edge = &cell.setup.part.edge;
    let points_in_world = (0..=EDGE_SEGMENTS)
        .map(|i| {
            let place = edge.length * i as f64 / EDGE_SEGMENTS as f64;
            cell.setup
                .scenario
                .workpiece
                .world_from_part
                .transform_point(edge.at(place).point)
        })
        .collect();
    let mut sums = vec![(0.0, 0usize); EDGE_SEGMENTS];
    if let Some(span) = recording.phase(crate::metrics::FOLLOW_PHASE) {
        let force = recording.values(schema::CONTACT_FORCE)?;
        let place = recording.values(schema::PATH_LENGTH)?;
        let desired = cell.setup.scenario.process.force;
        for i in recording.samples_in(span).filter(|&i| force[i] > 0.0) {
            // A sample between two of them is of the one that begins there, whatever its last bits are.
            let segment = (place[i] / edge.length * EDGE_SEGMENTS as f64 + 1e-9) as usize;
            let sum = &mut sums[segment.min(EDGE_SEGMENTS - 1)];
            sum.0 += (force[i] - desired) / desired;
            sum.1 += 1;
        }
    }
    let relative_force_error = sums
        .into_iter()
        .map(|(sum, count)| {
            if count == 0 {
                f64::NAN
            } else {
                sum / count as f64
            }
        })
        .collect();
    Ok(EdgePath {
        points_in_world,
        length: edge.length,
        relative_force_error,
    })
}
