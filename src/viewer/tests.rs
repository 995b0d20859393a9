//! Reads written files back with Rerun's own reader and looks for what was planted.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use ::rerun::external::re_sdk_types::blueprint::archetypes::EntityBehavior;
use ::rerun::external::re_tuid;
use ::rerun::log::Chunk;
use ::rerun::{
    Arrows3D, ChunkStore, ChunkStoreConfig, ComponentIdentifier, CoordinateFrame, Mesh3D, Scalars,
    StateChange, Transform3D,
};
use glamx::DPose3;

use super::options::PHASES;
use super::timelines::{PATH_LENGTH, SIM_TIME};
use super::*;
use crate::arm::VisualShape;
use crate::recording::{PhaseSpan, RecordedChannel, Unit, schema};
use crate::scene::{
    CollisionShape, ContactArrow, EdgePath, SceneBody, SceneLimits, ScenePoses, SceneShape,
};
use glam::DVec3;

const SAMPLES: usize = 2001;
const FRAMES: usize = 101;

/// Two seconds at 1 kHz: contact from 0.5 s on, 100 N with a ripple of 2 N, 50 mm a second.
fn recording() -> Recording {
    let time: Vec<f64> = (0..SAMPLES).map(|i| i as f64 * 1e-3).collect();
    let after_contact = |value: f64, t: &f64| if *t < 0.5 { 0.0 } else { value };
    let force = time
        .iter()
        .map(|t| after_contact(100.0 + 2.0 * (9.0 * t).sin(), t));
    let path = time.iter().map(|t| after_contact(0.05 * (t - 0.5), t));
    let channels = vec![
        RecordedChannel::new(schema::PATH_LENGTH, Unit::Metre, path.collect()),
        RecordedChannel::new(schema::CONTACT_FORCE, Unit::Newton, force.collect()),
        RecordedChannel::new(schema::DESIRED_FORCE, Unit::Newton, vec![100.0; SAMPLES]),
        RecordedChannel::new("joint_1_torque", Unit::NewtonMetre, vec![30.0; SAMPLES]),
    ];
    let span = |name: &str, start, end| PhaseSpan {
        name: name.to_owned(),
        start,
        end,
    };
    let phases = vec![span("approach", 0.0, 0.5), span("follow", 0.5, 2.0)];
    Recording::new(time, channels, phases).unwrap()
}

fn scene() -> Scene {
    let frame_times: Vec<f64> = (0..FRAMES).map(|i| i as f64 * 0.02).collect();
    let shape = |geometry| SceneShape {
        body_from_shape: DPose3::from_translation(DVec3::new(0.0, 0.0, 0.25)),
        geometry,
        colour: [200, 120, 40, 255],
    };
    let poses = frame_times
        .iter()
        .map(|t| DPose3::from_translation(DVec3::X * *t));
    let bodies = vec![
        SceneBody {
            entity: "arm/link_1".to_owned(),
            shapes: vec![shape(VisualShape::Sphere { radius: 0.1 })],
            world_from_body: ScenePoses::Moving(poses.collect()),
        },
        SceneBody {
            entity: "workpiece".to_owned(),
            shapes: vec![shape(VisualShape::Mesh {
                vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
                triangles: vec![[0, 1, 2]],
            })],
            world_from_body: ScenePoses::Static(DPose3::IDENTITY),
        },
    ];
    let arrow = |t: &f64| ContactArrow {
        point_in_world: DVec3::Y,
        force_in_world: if *t < 0.5 {
            DVec3::ZERO
        } else {
            -100.0 * DVec3::Z
        },
    };
    Scene {
        title: "plate edge".to_owned(),
        bodies,
        collision_shapes: vec![
            CollisionShape {
                name: "link 1/hull".to_owned(),
                moves_with: Some("arm/link_1".to_owned()),
                vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Z],
                triangles: vec![[0, 1, 2]],
            },
            CollisionShape {
                name: "post".to_owned(),
                moves_with: None,
                vertices: vec![DVec3::Y, DVec3::X, DVec3::Z],
                triangles: vec![[0, 1, 2]],
            },
        ],
        frame_path_lengths: frame_times
            .iter()
            .map(|t| (0.05 * (t - 0.5)).max(0.0))
            .collect(),
        edge_path: EdgePath {
            points_in_world: vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0],
            relative_force_error: vec![0.02, f64::NAN],
            length: 2.0,
        },
        finished_edge: None,
        contact_arrows: frame_times.iter().map(arrow).collect(),
        frame_times,
        limits: SceneLimits {
            stroke: Some([0.0, 0.05]),
            joint_torque: vec![120.0],
        },
    }
}

fn options() -> RerunOptions {
    RerunOptions {
        summary_markdown: "| mean | 100 N |".to_owned(),
        ..RerunOptions::default()
    }
}

/// The recording's and the blueprint's stores of a file.
fn read(path: &Path) -> (ChunkStore, ChunkStore) {
    let mut file = fs::File::open(path).unwrap();
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::ALL_DISABLED, &mut file).unwrap();
    let mut by_kind: BTreeMap<bool, ChunkStore> = stores
        .into_iter()
        .map(|(id, store)| (id.is_recording(), store))
        .collect();
    (
        by_kind.remove(&true).unwrap(),
        by_kind.remove(&false).unwrap(),
    )
}

fn chunks<'a>(store: &'a ChunkStore, entity: &str) -> Vec<&'a Chunk> {
    store
        .iter_physical_chunks()
        .map(AsRef::as_ref)
        .filter(|chunk| chunk.entity_path().to_string() == entity)
        .collect()
}

/// The one chunk of an entity that changes with time.
fn moving<'a>(store: &'a ChunkStore, entity: &str) -> &'a Chunk {
    let moving: Vec<_> = chunks(store, entity)
        .into_iter()
        .filter(|c| !c.is_static())
        .collect();
    assert_eq!(moving.len(), 1, "{entity}");
    moving[0]
}

fn times(chunk: &Chunk, timeline: &'static str) -> Vec<i64> {
    chunk.timelines()[&timeline.into()].times_raw().to_vec()
}

fn scalars(chunk: &Chunk) -> Vec<f64> {
    chunk
        .iter_slices::<f64>(Scalars::descriptor_scalars().component)
        .map(|row| row[0])
        .collect()
}

fn written() -> (ChunkStore, ChunkStore) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("recording.rrd");
    write_rrd(&path, &recording(), &scene(), &options()).unwrap();
    read(&path)
}

#[test]
fn every_sample_of_a_signal_is_there_on_both_timelines() {
    let (data, _) = written();
    let force = moving(&data, "/plots/force");
    assert_eq!(
        scalars(force),
        recording().values(schema::CONTACT_FORCE).unwrap()
    );
    let expected: Vec<i64> = (0..SAMPLES as i64).map(|i| i * 1_000_000).collect();
    assert_eq!(times(force, SIM_TIME), expected);
    // 0.05 m/s from 0.5 s on, seen at 0.5, 1.0 and 2.0 s.
    let path = times(force, PATH_LENGTH);
    assert_eq!([path[500], path[1000], path[2000]], [0, 25_000, 75_000]);
}

#[test]
fn constants_are_two_points_in_the_units_of_the_plot() {
    let (data, _) = written();
    for (entity, value) in [
        ("/plots/force/band_plus_5", 105.0),
        ("/plots/force/band_minus_10", 90.0),
        ("/plots/joint_torque/limit_plus", 100.0),
    ] {
        let chunk = moving(&data, entity);
        assert_eq!(scalars(chunk), [value; 2], "{entity}");
        assert_eq!(times(chunk, SIM_TIME), [0, 2_000_000_000], "{entity}");
    }
}

#[test]
fn bodies_move_at_frame_rate_and_the_arrow_shows_contact_only() {
    let (data, _) = written();
    let link = moving(&data, "/cell/arm/link_1");
    let translations: Vec<f32> = link
        .iter_slices::<[f32; 3]>(Transform3D::descriptor_translation().component)
        .map(|row| row[0][0])
        .collect();
    assert_eq!(translations.len(), FRAMES);
    assert!((translations[50] - 1.0).abs() < 1e-6);
    assert!(
        chunks(&data, "/cell/workpiece")
            .iter()
            .all(|chunk| chunk.is_static())
    );
    assert_eq!(chunks(&data, "/cell/workpiece/part_1").len(), 2);

    let arrow = moving(&data, "/cell/contact_force");
    let lengths: Vec<Vec<f32>> = arrow
        .iter_slices::<[f32; 3]>(Arrows3D::descriptor_vectors().component)
        .map(|row| row.iter().map(|vector| vector[2]).collect())
        .collect();
    assert_eq!(lengths.len(), FRAMES);
    // No contact at 0.48 s, 100 N drawn as 0.1 m downwards at 0.5 s.
    assert!(lengths[24].is_empty());
    assert_eq!(lengths[25], [-0.1]);
}

/// Texts of a component of an entity.
fn texts(store: &ChunkStore, entity: &str, component: ComponentIdentifier) -> Vec<String> {
    let own = chunks(store, entity).into_iter();
    let texts = own.flat_map(|chunk| chunk.iter_slices::<String>(component));
    texts.map(|row| row[0].to_string()).collect()
}

#[test]
fn collision_shapes_ride_on_their_bodies_and_are_hidden_at_first() {
    let (data, layout) = written();
    let frame = CoordinateFrame::descriptor_frame().component;
    let corners = Mesh3D::descriptor_vertex_positions().component;
    for (entity, rides_on, first) in [
        // A name with a slash is one part of the path.
        (
            "/cell/collision/link\\ 1\\/hull",
            vec!["tf#/cell/arm/link_1"],
            [0.0, 0.0, 0.0],
        ),
        ("/cell/collision/post", vec![], [0.0, 1.0, 0.0]),
    ] {
        let own = chunks(&data, entity);
        assert!(!own.is_empty() && own.iter().all(|chunk| chunk.is_static()));
        assert_eq!(texts(&data, entity, frame), rides_on, "{entity}");
        let mut found = own.iter();
        let mut found = found.by_ref().flat_map(|chunk| {
            let rows = chunk.iter_slices::<[f32; 3]>(corners);
            rows.map(<[[f32; 3]]>::to_vec).collect::<Vec<_>>()
        });
        assert_eq!(found.next().unwrap()[0], first, "{entity}");
    }
    let hidden = layout.iter_physical_chunks().filter(|chunk| {
        let place = "/ViewContents/overrides/cell/collision/visualizers";
        chunk.entity_path().to_string().ends_with(place)
    });
    let visible = EntityBehavior::descriptor_visible().component;
    let hidden: Vec<bool> = hidden
        .flat_map(|chunk| {
            let rows = chunk.iter_slices::<bool>(visible);
            rows.map(|row| row.value(0)).collect::<Vec<_>>()
        })
        .collect();
    // In the view of the cell and in that of the edge.
    assert_eq!(hidden, [false, false]);
}

#[test]
fn phases_are_states_with_an_end() {
    let (data, _) = written();
    let phases = moving(&data, PHASES);
    let names: Vec<String> = phases
        .iter_slices::<String>(StateChange::descriptor_state().component)
        .map(|row| row[0].to_string())
        .collect();
    assert_eq!(names, ["approach", "follow", ""]);
    assert_eq!(times(phases, SIM_TIME), [0, 500_000_000, 2_000_000_000]);
}

#[test]
fn nothing_is_on_a_clock() {
    let (data, _) = written();
    for chunk in data.iter_physical_chunks() {
        for timeline in chunk.timelines().keys() {
            assert!(
                [SIM_TIME, PATH_LENGTH].contains(&timeline.as_str()),
                "{timeline}"
            );
        }
    }
}

#[test]
fn the_layout_has_a_view_for_every_plot_and_one_root() {
    let (data, layout) = written();
    assert_eq!(data.id().application_id().as_str(), "idc-cell");
    let entities: Vec<String> = layout
        .iter_physical_chunks()
        .map(|chunk| chunk.entity_path().to_string())
        .collect();
    let heads = |prefix: &str| {
        let is_head = |e: &&String| e.starts_with(prefix) && e.matches('/').count() == 2;
        entities.iter().filter(is_head).count()
    };
    // Cell, edge, phases, force, joint torque, summary.
    assert_eq!(heads("/view/"), 6);
    // The row of two columns, the left column, its lower row, the tabs.
    assert_eq!(heads("/container/"), 5);
    let eyes = entities.iter().filter(|e| e.ends_with("/EyeControls3D"));
    assert_eq!(eyes.count(), 2);
    let shared_axis = "/view/5c0dca6a-e63f-9cf7-f657-2602590474cc/TimeAxis";
    assert!(entities.iter().any(|entity| entity == shared_axis));
}

#[test]
fn equal_input_gives_equal_bytes_and_other_input_another_id() {
    let directory = tempfile::tempdir().unwrap();
    let write = |name: &str, options: &RerunOptions| {
        let path = directory.path().join(name);
        write_rrd(&path, &recording(), &scene(), options).unwrap();
        path
    };
    let [first, second] = ["a.rrd", "b.rrd"].map(|name| write(name, &options()));
    assert!(fs::read(&first).unwrap() == fs::read(&second).unwrap());
    let other = write("c.rrd", &RerunOptions::default());
    assert_ne!(read(&first).0.id(), read(&other).0.id());
}

/// The samples and the frames of a part of the run, as they come while it goes on.
fn part(samples: std::ops::Range<usize>, frames: std::ops::Range<usize>) -> (Recording, Scene) {
    let whole = recording();
    let channels = whole.channels().iter();
    let channels = channels.map(|channel| RecordedChannel {
        values: channel.values[samples.clone()].to_vec(),
        ..channel.clone()
    });
    let time = whole.time()[samples.clone()].to_vec();
    let mut scene = scene();
    for body in &mut scene.bodies {
        if let ScenePoses::Moving(poses) = &mut body.world_from_body {
            *poses = poses[frames.clone()].to_vec();
        }
    }
    scene.frame_times = scene.frame_times[frames.clone()].to_vec();
    scene.frame_path_lengths = scene.frame_path_lengths[frames.clone()].to_vec();
    scene.contact_arrows = scene.contact_arrows[frames].to_vec();
    let recording = Recording::new(time, channels.collect(), vec![]).unwrap();
    (recording, scene)
}

/// Times and values of what changes with time, chunk after chunk.
fn trajectory(store: &ChunkStore, entity: &str) -> (Vec<i64>, Vec<i64>, Vec<f64>) {
    let mut own = chunks(store, entity);
    own.retain(|chunk| !chunk.is_static());
    own.sort_by_key(|chunk| chunk.id().as_tuid());
    let along = |timeline| own.iter().flat_map(|c| times(c, timeline)).collect();
    let values = own.iter().flat_map(|chunk| scalars(chunk)).collect();
    (along(SIM_TIME), along(PATH_LENGTH), values)
}

#[test]
fn encoded_while_it_is_made_it_holds_the_same() {
    let directory = tempfile::tempdir().unwrap();
    let grown = |name: &str, origin: &str| {
        let path = directory.path().join(name);
        let (samples, frames) = part(0..700, 0..35);
        let mut streaming =
            StreamingRrd::begin(&path, origin, &samples, &frames, &options()).unwrap();
        for (samples, frames) in [(700..1500, 35..75), (1500..SAMPLES, 75..FRAMES)] {
            let (samples, frames) = part(samples, frames);
            streaming.add(&samples, &frames).unwrap();
        }
        let summary = options().summary_markdown;
        let encoded = streaming.end(&recording(), &scene(), &summary).unwrap();
        encoded.write(&path).unwrap();
        path
    };
    let path = grown("grown.rrd", "a scenario");
    let (data, layout) = read(&path);
    let (whole, whole_layout) = written();
    for entity in [
        "/plots/force",
        "/plots/joint_torque",
        "/plots/force/band_plus_5",
    ] {
        let (time, _, values) = trajectory(&data, entity);
        assert!(!time.is_empty() && time.len() == values.len(), "{entity}");
        assert_eq!(
            trajectory(&data, entity),
            trajectory(&whole, entity),
            "{entity}"
        );
    }
    let places = |store: &ChunkStore| -> Vec<[f32; 3]> {
        let mut own = chunks(store, "/cell/arm/link_1");
        own.retain(|chunk| !chunk.is_static());
        own.sort_by_key(|chunk| chunk.id().as_tuid());
        let component = Transform3D::descriptor_translation().component;
        let rows = own
            .iter()
            .flat_map(|chunk| chunk.iter_slices::<[f32; 3]>(component));
        rows.map(|row| row[0]).collect()
    };
    assert_eq!(places(&data).len(), FRAMES);
    assert_eq!(places(&data), places(&whole));
    let when = |store| trajectory(store, "/cell/arm/link_1").0;
    assert_eq!(when(&data), when(&whole));
    let statics = |store: &ChunkStore| {
        let all = store.iter_physical_chunks();
        let all = all.filter(|chunk| chunk.is_static());
        let mut all: Vec<String> = all.map(|chunk| chunk.entity_path().to_string()).collect();
        all.sort();
        all
    };
    assert_eq!(statics(&data), statics(&whole));
    assert_eq!(statics(&layout), statics(&whole_layout));
    // Equal input gives equal bytes; a run of other files is another recording, even if it begins alike.
    let again = grown("again.rrd", "a scenario");
    assert!(fs::read(&path).unwrap() == fs::read(&again).unwrap());
    let other = read(&grown("other.rrd", "another scenario")).0;
    assert_ne!(other.id(), data.id());
}

#[test]
fn chunks_lie_where_the_footer_says() {
    use ::rerun::external::re_log_encoding::{
        Decodable as _, MessageHeader, MessageKind, RrdFooter, StreamFooter, ToApplication as _,
        ToTransport,
    };
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("recording.rrd");
    write_rrd(&path, &recording(), &scene(), &options()).unwrap();
    let file = fs::read(&path).unwrap();
    let end = file.len() - StreamFooter::ENCODED_SIZE_BYTES;
    let pointer = StreamFooter::from_rrd_bytes(&file[end..]).unwrap();
    let start = pointer.entries[0].rrd_footer_byte_span_from_start_excluding_header;
    let start = start.start as usize;
    let footer = <RrdFooter as ToTransport>::Output::from_rrd_bytes(&file[start..end]).unwrap();
    let stores = footer.to_application(()).unwrap().manifests;
    assert_eq!(stores.len(), 2);
    for store in stores.values() {
        let places = store.col_chunk_byte_offset().unwrap();
        let lengths = store.col_chunk_byte_size().unwrap();
        for (place, length) in places.zip(lengths) {
            let place = place as usize;
            let header = &file[place - MessageHeader::ENCODED_SIZE_BYTES..place];
            let header = MessageHeader::from_rrd_bytes(header).unwrap();
            assert_eq!(header.kind, MessageKind::ArrowMsg);
            assert_eq!(header.len, length);
        }
    }
}

#[test]
fn a_scene_that_does_not_fit_leaves_no_file() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("recording.rrd");
    let mut scene = scene();
    scene.contact_arrows.pop();
    let message = write_rrd(&path, &recording(), &scene, &options())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("contact arrows is 100, expected 101"),
        "{message}"
    );
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
}

#[test]
fn a_directory_that_is_not_there_is_named() {
    let path = Path::new("/nowhere/recording.rrd");
    let message = write_rrd(path, &recording(), &scene(), &options())
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("cannot write /nowhere/recording.rrd"),
        "{message}"
    );
}

#[test]
fn ids_within_a_store_differ() {
    let (data, layout) = written();
    for store in [&data, &layout] {
        let mut ids: Vec<re_tuid::Tuid> = store
            .iter_physical_chunks()
            .map(|chunk| chunk.id().as_tuid())
            .collect();
        let count = ids.len();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), count);
    }
}

// Catches: a quaternion that is written transposed, or with its numbers in another order.
#[test]
fn rotations_are_those_of_the_scene() {
    let turned = DPose3::from_parts(
        DVec3::new(1.0, 2.0, 3.0),
        glam::DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.8),
    );
    let mut scene = scene();
    scene.bodies[0].world_from_body = ScenePoses::Moving(vec![turned; FRAMES]);
    scene.bodies[1].world_from_body = ScenePoses::Static(turned);
    for body in &mut scene.bodies {
        body.shapes[0].body_from_shape = turned;
    }
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("recording.rrd");
    write_rrd(&path, &recording(), &scene, &options()).unwrap();
    let (data, _) = read(&path);
    // x, y, z, w as Rerun has them: the axis times the sine of half the angle, the cosine.
    let (sine, cosine) = 0.4f64.sin_cos();
    let expected = [sine / 3.0, 2.0 * sine / 3.0, 2.0 * sine / 3.0, cosine];
    for (entity, count) in [
        ("/cell/arm/link_1", FRAMES),
        ("/cell/arm/link_1/part_1", 1),
        ("/cell/workpiece", 1),
        ("/cell/workpiece/part_1", 1),
    ] {
        let chunks = chunks(&data, entity);
        let component = Transform3D::descriptor_quaternion().component;
        let rows = chunks.iter();
        let rows = rows.flat_map(|chunk| chunk.iter_slices::<[f32; 4]>(component));
        let rows: Vec<[f32; 4]> = rows.map(|row| row[0]).collect();
        assert_eq!(rows.len(), count, "{entity}");
        for (found, expected) in rows[0].into_iter().zip(expected) {
            assert!(
                (f64::from(found) - expected).abs() < 1e-6,
                "{entity}: {rows:?}"
            );
        }
    }
}

// Catches: rows sorted along the path, and ids of the clock, where a second pass goes over the edge again.
#[test]
fn a_path_that_is_gone_over_again_is_written_in_the_order_of_time() {
    let whole = recording();
    let channels = whole.channels().iter().map(|channel| {
        let mut channel = channel.clone();
        if channel.quantity == schema::PATH_LENGTH {
            let again = channel.values[..SAMPLES - SAMPLES / 2].to_vec();
            channel.values[SAMPLES / 2..].copy_from_slice(&again);
            channel.values[..SAMPLES / 2].fill(0.07);
        }
        channel
    });
    let twice = Recording::new(whole.time().to_vec(), channels.collect(), vec![]).unwrap();
    let mut scene = scene();
    scene.frame_path_lengths.reverse();
    let directory = tempfile::tempdir().unwrap();
    let [first, second] = ["a.rrd", "b.rrd"].map(|name| {
        let path = directory.path().join(name);
        write_rrd(&path, &twice, &scene, &options()).unwrap();
        path
    });
    assert!(fs::read(&first).unwrap() == fs::read(&second).unwrap());
    let (data, _) = read(&first);
    let force = moving(&data, "/plots/force");
    assert_eq!(scalars(force), whole.values(schema::CONTACT_FORCE).unwrap());
    assert!(times(force, SIM_TIME).is_sorted());
    let link = moving(&data, "/cell/arm/link_1");
    assert!(times(link, SIM_TIME).is_sorted() && !times(link, PATH_LENGTH).is_sorted());
    let translation = Transform3D::descriptor_translation().component;
    let places: Vec<f32> = link
        .iter_slices::<[f32; 3]>(translation)
        .map(|row| row[0][0])
        .collect();
    assert!(places.is_sorted() && places.len() == FRAMES);
}
