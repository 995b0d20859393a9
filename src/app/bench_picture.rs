//! The scene of a bench run: the device on its base, what it presses on, the contact force.

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::picture::{PART, device_bodies};
use crate::arm::VisualShape;
use crate::recording::{Recording, RecordingError, schema};
use crate::scenario::BenchScenario;
use crate::scene::{ContactArrow, EdgePath, Scene, SceneBody, SceneLimits, ScenePoses, SceneShape};

/// Time between two frames of the picture [s].
const FRAME_INTERVAL: f64 = 0.02;
/// Standard gravity [m/s2].
const GRAVITY: f64 = 9.806_65;
/// Size of the drawn load [m].
const LOAD: DVec3 = DVec3::new(0.06, 0.06, 0.015);

/// Builds the scene of a run.
///
/// # Errors
/// The recording lacks a channel.
pub(super) fn scene_of(
    scenario: &BenchScenario,
    recording: &Recording,
) -> Result<Scene, RecordingError> {
    let stroke = recording.values(schema::STROKE)?;
    let force = recording.values(schema::CONTACT_FORCE)?;
    let surface = recording.channel(schema::SURFACE_POSITION);
    let mut frames: Vec<usize> = Vec::new();
    // A part of a run has the frames that the whole would have there.
    let before = (recording.time()[0] / FRAME_INTERVAL - 1e-6)
        .ceil()
        .max(0.0);
    for (index, time) in recording.time().iter().enumerate() {
        if *time >= FRAME_INTERVAL * (before + frames.len() as f64) - 1e-9 {
            frames.push(index);
        }
    }
    let mount = mount(scenario.nominal.gravity_along_extension);
    let along = |length: f64| mount * DPose3::from_translation(DVec3::new(0.0, 0.0, length));
    let nominal = &scenario.nominal;
    let tip = nominal.mounting.tool_centre + nominal.mounting.tool_radius;
    let slide = frames.iter().map(|&i| along(stroke[i])).collect();
    let mut bodies = Vec::from(device_bodies(
        nominal,
        ScenePoses::Static(mount),
        ScenePoses::Moving(slide),
    ));
    if let Some(surface) = surface {
        let place = |&i: &usize| along(tip + surface.values[i] + 0.5 * LOAD.z);
        bodies.push(SceneBody {
            entity: "load".into(),
            shapes: vec![SceneShape {
                body_from_shape: DPose3::IDENTITY,
                geometry: VisualShape::Box { size: LOAD },
                colour: PART,
            }],
            world_from_body: ScenePoses::Moving(frames.iter().map(place).collect()),
        });
    }
    let axis = mount.rotation * DVec3::Z;
    Ok(Scene {
        title: scenario.title.clone(),
        bodies,
        collision_shapes: Vec::new(),
        frame_times: frames.iter().map(|&i| recording.time()[i]).collect(),
        frame_path_lengths: vec![0.0; frames.len()],
        edge_path: EdgePath::default(),
        finished_edge: None,
        contact_arrows: frames
            .iter()
            .map(|&i| ContactArrow {
                point_in_world: along(tip + stroke[i]).translation,
                force_in_world: axis * force[i],
            })
            .collect(),
        limits: SceneLimits {
            stroke: Some([0.0, nominal.device.full_stroke]),
            joint_torque: Vec::new(),
        },
    })
}

/// The device's base, its axis leaned so that gravity has the stated component along it.
fn mount(gravity_along_extension: f64) -> DPose3 {
    let upwards = (-gravity_along_extension / GRAVITY).clamp(-1.0, 1.0);
    DPose3 {
        rotation: DQuat::from_rotation_y(upwards.acos()),
        translation: DVec3::new(0.0, 0.0, 0.3),
    }
}
