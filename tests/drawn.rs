//! What recording.rrd shows of a run in space, read back with Rerun's own reader: the ball rides on the edge, and each link hangs on its joint.

use std::path::Path;

use glam::{DQuat, DVec3};
use idc_cell::app::{run_cell, scene_of};
use idc_cell::cell::Cell;
use idc_cell::recording::rerun::{RerunOptions, write_rrd};
use rerun::{ChunkStore, ChunkStoreConfig, Transform3D};

use crate::common::scenario;

/// Translation and rotation of an entity, frame by frame; one of what does not move.
fn poses(store: &ChunkStore, entity: &str) -> Vec<(DVec3, DQuat)> {
    let chunks = store.iter_physical_chunks();
    let own = chunks.filter(|chunk| chunk.entity_path().to_string() == entity);
    let mut found = Vec::new();
    for chunk in own {
        let translation = Transform3D::descriptor_translation().component;
        let quaternion = Transform3D::descriptor_quaternion().component;
        let translations = chunk.iter_slices::<[f32; 3]>(translation);
        let quaternions = chunk.iter_slices::<[f32; 4]>(quaternion);
        found.extend(translations.zip(quaternions).map(|(t, q)| {
            let [x, y, z, w] = q[0].map(f64::from);
            let along = DVec3::from_array(t[0].map(f64::from));
            (along, DQuat::from_xyzw(x, y, z, w).normalize())
        }));
    }
    assert!(!found.is_empty(), "{entity}");
    found
}

fn read(path: &Path) -> ChunkStore {
    let mut file = std::fs::File::open(path).unwrap();
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::ALL_DISABLED, &mut file).unwrap();
    let mut recordings = stores.into_iter().filter(|(id, _)| id.is_recording());
    recordings.next().unwrap().1
}

/// Distance of a point from a chain of segments [m].
fn distance(point: DVec3, corners: &[DVec3]) -> f64 {
    let from_segment = |ends: &[DVec3]| {
        let way = ends[1] - ends[0];
        let along = (point - ends[0]).dot(way) / way.length_squared();
        (point - ends[0] - way * along.clamp(0.0, 1.0)).length()
    };
    corners
        .windows(2)
        .map(from_segment)
        .fold(f64::INFINITY, f64::min)
}

// Catches: a rotation that is written transposed or with the wrong sign, of links, slide or their shapes.
#[test]
fn the_ball_that_is_drawn_rides_on_the_edge_and_links_hang_on_their_joints() {
    let mut job = scenario("plate_edge");
    job.workpiece.edge.start = 0.1;
    job.workpiece.edge.end = Some(0.13);
    let cell = Cell::new(job).unwrap();
    let run = run_cell(&cell, &mut |_, _| ()).unwrap();
    let scene = scene_of(&cell, &run.recording, &run.frames).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("recording.rrd");
    write_rrd(&file, &run.recording, &scene, &RerunOptions::default()).unwrap();
    let store = read(&file);

    let slide = poses(&store, "/cell/device/slide");
    let shapes = scene.bodies.iter();
    let mut shapes = shapes.filter(|body| body.entity == "device/slide");
    let ball = shapes.next().unwrap().shapes.len();
    let (centre, _) = poses(&store, &format!("/cell/device/slide/part_{ball}"))[0];
    let follow = run.recording.phase("follow").unwrap();
    let radius = cell.scenario.device.tool_radius;
    let stiffness = cell.scenario.contact.stiffness;
    let mut seen = 0;
    for (frame, time) in scene.frame_times.iter().enumerate() {
        if *time > follow.start && *time < follow.end {
            let (along, rotation) = slide[frame];
            let apart = distance(along + rotation * centre, &scene.edge_path.points_in_world);
            let pressed = scene.contact_arrows[frame].force_in_world.length() / stiffness;
            let off = apart - (radius - pressed);
            assert!(off.abs() < 1e-4, "{apart} m at {time} s, off by {off} m");
            seen += 1;
        }
    }
    assert!(seen > 20);

    for (index, joint) in cell.arm.chain.joints.iter().enumerate() {
        let of = |index: usize| poses(&store, &format!("/cell/arm/{}", cell.arm.link_names[index]));
        let (before, own) = (of(index), of(index + 1));
        for (frame, (place, _)) in own.iter().enumerate() {
            let (from, rotation) = before[frame.min(before.len() - 1)];
            let hangs = rotation.inverse() * (*place - from);
            let joint = joint.parent_from_joint.translation;
            assert!(
                (hangs - joint).length() < 1e-5,
                "{index}: {hangs}, not {joint}"
            );
        }
    }
}
