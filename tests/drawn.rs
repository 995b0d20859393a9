//! What recording.rrd shows of a run in space, read back with Rerun's own reader: the ball rides on the edge, and each link hangs on its joint.

use std::path::Path;

use glam::{DQuat, DVec3};
use glamx::DPose3;
use idc_cell::app::{edge_course, finished_edge, scene_of};
use idc_cell::arm::VisualShape;
use idc_cell::cell::Cell;
use idc_cell::recording::csv::EdgeProfile;
use idc_cell::run::run_cell;
use idc_cell::scenario::{BurrScenario, Obstacle, ObstacleShape};
use idc_cell::scene::Scene;
use idc_cell::scene::finished_edge::EdgeMoment;
use idc_cell::viewer::{RerunOptions, write_rrd};
use rerun::{
    ChunkStore, ChunkStoreConfig, CoordinateFrame, LineStrips3D, Mesh3D, TextDocument, Transform3D,
};

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
    let mut job = scenario("plate_edge_ideal");
    job.workpiece.edge.start = 0.1;
    job.workpiece.edge.end = Some(0.13);
    let cell = Cell::new(job).unwrap();
    let run = run_cell(&cell, &mut |_| ()).unwrap();
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
    let radius = cell.setup.scenario.nominal.mounting.tool_radius;
    let stiffness = cell.setup.scenario.nominal.contact.stiffness_at(0.0);
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

    for (index, joint) in cell.setup.arm.chain.joints.iter().enumerate() {
        let of = |index: usize| {
            poses(
                &store,
                &format!("/cell/arm/{}", cell.setup.arm.link_names[index]),
            )
        };
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

/// Corners of an entity's mesh and the frame that they are in; none where it is its own.
fn mesh(store: &ChunkStore, entity: &str) -> (Vec<DVec3>, Option<String>) {
    let corners = Mesh3D::descriptor_vertex_positions().component;
    let frame = CoordinateFrame::descriptor_frame().component;
    let (mut found, mut rides_on) = (Vec::new(), None);
    for chunk in store.iter_physical_chunks() {
        if chunk.entity_path().to_string() == entity {
            let rows = chunk.iter_slices::<[f32; 3]>(corners).flatten();
            found.extend(rows.map(|corner| DVec3::from_array(corner.map(f64::from))));
            let frames = chunk.iter_slices::<String>(frame);
            rides_on = frames.map(|row| row[0].to_string()).last().or(rides_on);
        }
    }
    (found, rides_on)
}

/// Distance of a point from the surface of a cylinder about z [m].
fn from_cylinder(point: DVec3, radius: f64, length: f64) -> f64 {
    let out = DVec3::new(point.x, point.y, 0.0).length() - radius;
    let beyond = point.z.abs() - 0.5 * length;
    if out <= 0.0 && beyond <= 0.0 {
        out.max(beyond).abs()
    } else {
        out.max(0.0).hypot(beyond.max(0.0))
    }
}

// Catches: a hull in the frame of another link, an obstacle off its place, a recording that grows with the shapes.
#[test]
fn what_is_checked_for_collisions_is_where_the_links_and_obstacles_are() {
    let mut job = scenario("plate_edge_ideal");
    job.workpiece.edge.start = 0.1;
    job.workpiece.edge.end = Some(0.13);
    let (size, turned) = (
        DVec3::new(0.1, 0.2, 0.3),
        DPose3::from_parts(DVec3::new(-0.9, 0.9, 0.5), DQuat::from_rotation_z(0.4)),
    );
    job.collision.obstacles.push(Obstacle {
        name: "tool rack".to_owned(),
        shape: ObstacleShape::Box(size),
        world_from_obstacle: turned,
    });
    let cell = Cell::new(job).unwrap();
    let run = run_cell(&cell, &mut |_| ()).unwrap();
    let scene = scene_of(&cell, &run.recording, &run.frames).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, scene: &Scene| {
        let file = folder.path().join(name);
        write_rrd(&file, &run.recording, scene, &RerunOptions::default()).unwrap();
        file
    };
    let file = write("recording.rrd", &scene);
    let store = read(&file);

    for (index, name) in cell.setup.arm.link_names.iter().enumerate() {
        let (corners, frame) = mesh(&store, &format!("/cell/collision/{name}"));
        let own = cell
            .setup
            .arm
            .visuals
            .iter()
            .filter(|own| own.link_index == index);
        let own: Vec<_> = own.collect();
        assert_eq!(corners.is_empty(), own.is_empty(), "{name}");
        let off = |corner: &DVec3| {
            let from = own.iter().map(|own| match own.shape {
                VisualShape::Cylinder { radius, length } => {
                    let point = own.link_from_visual.inverse().transform_point(*corner);
                    from_cylinder(point, radius, length)
                }
                _ => f64::INFINITY,
            });
            from.fold(f64::INFINITY, f64::min)
        };
        let most = corners.iter().map(off).fold(0.0, f64::max);
        assert!(most < 1e-6, "{name}: {most} m");
        // The base stands in the world, here at its origin.
        let expected = (index > 0).then(|| format!("tf#/cell/arm/{name}"));
        assert!(corners.is_empty() || frame == expected, "{name}: {frame:?}");
    }
    let (corners, frame) = mesh(&store, "/cell/collision/tool");
    assert_eq!(frame.as_deref(), Some("tf#/cell/device/slide"));
    // The spindle ends at the ball's centre.
    let end = corners.iter().map(|corner| corner.z).fold(0.0, f64::max);
    assert!(
        (end - cell.setup.scenario.nominal.mounting.tool_centre).abs() < 1e-6,
        "{end}"
    );
    let (corners, frame) = mesh(&store, "/cell/collision/tool\\ rack");
    assert!(frame.is_none() && corners.len() >= 8);
    for corner in corners {
        let own = turned.inverse().transform_point(corner).abs();
        assert!((own - 0.5 * size).length() < 1e-6, "{own}");
    }
    assert!(mesh(&store, "/cell/collision/floor").0.is_empty());

    let bytes = |file: &Path| std::fs::metadata(file).unwrap().len();
    // Three corners with their normals a triangle, once, whatever the run's length.
    let shapes = &scene.collision_shapes;
    let triangles: usize = shapes.iter().map(|shape| shape.triangles.len()).sum();
    let most = 80 * triangles + 4000 * shapes.len();
    let bare = write(
        "bare.rrd",
        &Scene {
            collision_shapes: vec![],
            ..scene
        },
    );
    let grown = bytes(&file) - bytes(&bare);
    assert!(
        grown < most as u64,
        "{grown} bytes for {triangles} triangles"
    );
}

/// Colours of an entity's mesh, a corner each: red, green, blue, opacity.
fn corner_colours(store: &ChunkStore, entity: &str) -> Vec<[u8; 4]> {
    let colours = Mesh3D::descriptor_vertex_colors().component;
    let chunks = store.iter_physical_chunks();
    let own = chunks.filter(|chunk| chunk.entity_path().to_string() == entity);
    let mut found = Vec::new();
    for chunk in own {
        let rows = chunk.iter_slices::<u32>(colours).flatten();
        found.extend(rows.map(|colour| colour.to_be_bytes()));
    }
    found
}

/// What an edge_profile.csv holds: burr before, burr after and leg of each station [m].
fn stations(text: &str) -> Vec<[f64; 3]> {
    let rows = text.lines().skip(1).map(|line| {
        let fields: Vec<f64> = line
            .split(',')
            .map(|field| field.parse().unwrap())
            .collect();
        [fields[1], fields[2], fields[3]].map(|millimetres| 1e-3 * millimetres)
    });
    rows.collect()
}

/// A leg's colour, of a tolerance of 0.2 to 0.6 mm: 35 % to 100 % of the way from nearly white to blue or vermilion.
fn colour_of(leg: f64) -> [f64; 4] {
    let blend = |end: [f64; 3], off: f64| {
        let way = 0.35 + 0.65 * off.min(1.0);
        let [r, g, b] = end.map(|end| 245.0 + way * (end - 245.0));
        [r, g, b, 255.0]
    };
    if leg < 0.2e-3 {
        blend([0.0, 114.0, 178.0], 1.0 - leg / 0.2e-3)
    } else if leg > 0.6e-3 {
        blend([213.0, 94.0, 0.0], leg / 0.6e-3 - 1.0)
    } else {
        [0.0, 158.0, 115.0, 255.0]
    }
}

/// What the samples say of the edge's course ends with the edge that the simulation leaves, and no burr grows again.
fn assert_course(course: &[EdgeMoment], profile: &EdgeProfile) {
    let (first, last) = (course.first().unwrap(), course.last().unwrap());
    for (place, station) in last.stations.iter().enumerate() {
        let near = |found: f64, expected: f64| {
            assert!(
                (found - expected).abs() < 1e-9,
                "station {station}: {found} {expected}"
            );
        };
        near(first.burr[place], profile.burr_before[*station]);
        near(first.leg[place], 0.0);
        near(last.burr[place], profile.burr_after[*station]);
        near(last.leg[place], profile.chamfer_leg[*station]);
        let falls = |two: &[EdgeMoment]| {
            two[1].burr[place] <= two[0].burr[place] && two[1].leg[place] >= two[0].leg[place]
        };
        assert!(course.windows(2).all(falls), "station {station}");
    }
    let among = course
        .iter()
        .filter(|m| m.burr != first.burr && m.burr != last.burr);
    assert!(among.count() > 10);
}

// Catches: a chamfer drawn beside its edge, in the colours of another station, or too much as too little.
#[test]
fn the_edge_is_drawn_before_and_after_in_the_colours_of_its_error() {
    let mut job = scenario("deburred_edge");
    job.workpiece.edge.start = 0.1;
    job.workpiece.edge.end = Some(0.16);
    // One fast pass over a burr of very different heights: some of it stays, and some of the chamfer is too small.
    job.passes.truncate(1);
    job.passes[0].force = Some(40.0);
    job.passes[0].feed = Some(0.1);
    job.workpiece.burr_root = 0.25e-3;
    job.workpiece.burr = BurrScenario::Random {
        seed: 1,
        mean_height: 0.3e-3,
        height_deviation: 0.2e-3,
        correlation_length: 8e-3,
    };
    job.expect.clear();
    let cell = Cell::new(job).unwrap();
    let run = run_cell(&cell, &mut |_| ()).unwrap();
    let profile = run.edge.as_ref().unwrap();
    let mut scene = scene_of(&cell, &run.recording, &run.frames).unwrap();
    assert!(scene.finished_edge.is_none());
    assert_course(&edge_course(&cell, &run.recording).unwrap(), profile);
    scene.finished_edge = Some(finished_edge(&cell, profile));
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str| {
        let file = folder.path().join(name);
        write_rrd(&file, &run.recording, &scene, &RerunOptions::default()).unwrap();
        file
    };
    let [file, again] = ["recording.rrd", "again.rrd"].map(write);
    assert!(std::fs::read(&file).unwrap() == std::fs::read(&again).unwrap());
    let store = read(&file);

    let stations = stations(&profile.text());
    let part = cell.setup.part.world_from_part;
    let edge: Vec<DVec3> = (cell.setup.part.edge.points.iter())
        .map(|point| part.transform_point(*point))
        .collect();
    let on_edge = |point: DVec3| distance(point, &edge);
    let (after, _) = mesh(&store, "/cell/edge/after");
    let (before, _) = mesh(&store, "/cell/edge/before");
    let colours = corner_colours(&store, "/cell/edge/after");
    assert_eq!(after.len(), 3 * stations.len());
    assert_eq!(before.len(), 2 * stations.len());
    assert_eq!(colours.len(), after.len());
    let legend = TextDocument::descriptor_text().component;
    let legend = store.iter_physical_chunks().find_map(|chunk| {
        let own = chunk.entity_path().to_string() == "/summary";
        let mut texts = chunk.iter_slices::<String>(legend);
        own.then(|| texts.next().unwrap()[0].to_string())
    });
    let legend = legend.unwrap();
    let factor = legend.split_once("Drawn ").unwrap().1;
    let factor: f64 = factor.split(' ').next().unwrap().parse().unwrap();
    assert!(
        legend.contains("within the tolerance, 0.2 to 0.6 mm"),
        "{legend}"
    );

    let mut kinds = [0; 3];
    for (i, [burr, _, leg]) in stations.iter().enumerate() {
        // As the file holds them, in f32: half a micrometre at a metre.
        let near = |found: f64, expected: f64| {
            assert!(
                (found - expected).abs() < 1e-6,
                "station {i}: {found} {expected}"
            );
        };
        near(on_edge(before[2 * i]), 0.0);
        near(before[2 * i + 1].distance(before[2 * i]), factor * burr);
        let [left, foot, right] = [0, 1, 2].map(|corner| after[3 * i + corner]);
        near(on_edge(foot), 0.2e-3);
        near(left.distance(foot), factor * leg);
        near(right.distance(foot), factor * leg);
        // The faces of a plate.
        assert!((left - foot).dot(right - foot).abs() < 1e-8);
        for colour in &colours[3 * i..3 * i + 3] {
            for (found, expected) in colour.iter().zip(colour_of(*leg)) {
                assert!(
                    (f64::from(*found) - expected).abs() <= 1.0,
                    "station {i}: {colour:?} of {leg} m"
                );
            }
        }
        kinds[if *leg < 0.2e-3 {
            0
        } else {
            1 + usize::from(*leg > 0.6e-3)
        }] += 1;
    }
    assert!(kinds.iter().all(|count| *count > 5), "{kinds:?}");

    let strips = LineStrips3D::descriptor_strips().component;
    let left = stations
        .iter()
        .filter(|[_, burr, _]| *burr > 0.02e-3)
        .count();
    let marked = store.iter_physical_chunks().filter(|chunk| {
        chunk.entity_path().to_string() == "/cell/edge/residual_burr"
            && chunk.components().contains_component(strips)
    });
    let marked: usize = marked.map(|chunk| chunk.num_rows()).sum();
    assert!(left > 20 && marked == 1, "{left} stations with a burr");
}
