//! Checks against closed forms, dense sampling and planted bodies.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use glamx::DPose3;

use super::*;
use crate::arm::VisualShape;
use crate::arm::chain::{KinematicChain, MAX_JOINTS};
use crate::arm::kinematics::link_poses;
use crate::arm::test_chains::{planar_two_link, random_chain, random_positions};
use crate::workpiece::TriangleMesh;

fn cuboid(size: [f64; 3]) -> VisualShape {
    let size = DVec3::from_array(size);
    VisualShape::Box { size }
}

fn body(name: &str, mount: Mount, shape: &VisualShape, shift: DVec3) -> Body {
    Body {
        name: name.to_owned(),
        mount,
        solids: vec![Solid::convex(shape, DPose3::from_translation(shift)).unwrap()],
    }
}

/// An arm of two links of 0.7 and 0.4 m that turn in the plane, 20 mm thick, with other bodies in the world.
fn two_links(others: Vec<(Role, Body)>, margin: f64) -> CollisionModel {
    let (chain, _) = planar_two_link();
    let link = |joint: usize, length: f64| {
        let shape = cuboid([length, 0.02, 0.02]);
        let shift = DVec3::new(0.5 * length, 0.0, 0.0);
        let name = ["upper", "fore"][joint];
        (Role::Robot, body(name, Mount::Link(joint), &shape, shift))
    };
    let mut bodies = vec![link(0, 0.7), link(1, 0.4)];
    bodies.extend(others);
    CollisionModel::new(ModelRequest {
        chain: &chain,
        world_from_base: DPose3::IDENTITY,
        bodies,
        ridden: None,
        margin,
        allowed: &[],
    })
    .unwrap()
}

fn positions(values: &[f64]) -> Positions {
    let mut positions = [0.0; MAX_JOINTS];
    positions[..values.len()].copy_from_slice(values);
    positions
}

fn sweep_of(joints: &[[f64; 2]]) -> JointMotion {
    let mut motion = JointMotion::default();
    for joints in joints {
        motion.line_to(positions(joints));
    }
    motion
}

/// A wire of 1 mm across the plane at a place.
fn wire(x: f64, y: f64) -> (Role, Body) {
    let shape = VisualShape::Cylinder {
        radius: 0.5e-3,
        length: 0.4,
    };
    let pose = DPose3::from_translation(DVec3::new(x, y, 0.0));
    (
        Role::Obstacle,
        body("wire", Mount::World(pose), &shape, DVec3::ZERO),
    )
}

#[test]
fn a_wire_between_two_samples_is_found_where_it_is_met() {
    // The outstretched arm turns by half a turn in one step; its middle line passes the wire at a quarter, its edge 10.5 mm before.
    let model = two_links(vec![wire(0.0, 1.0)], 0.0);
    let motion = sweep_of(&[[0.0, 0.0], [PI, 0.0]]);
    let meetings = model.meetings(&motion);
    assert_eq!(meetings.len(), 1, "{meetings:?}");
    let meeting = &meetings[0];
    assert_eq!(meeting.names, ["fore", "wire"]);
    let expected = (FRAC_PI_2 - f64::asin(0.0105)) / PI;
    assert_eq!(meeting.first.knot, 0);
    assert!((meeting.first.share - expected).abs() < 1e-4, "{meeting:?}");
    // Its samples alone, the first and the last, are free.
    assert!(model.is_free(&sweep_of(&[[0.0, 0.0]])));
    assert!(model.is_free(&sweep_of(&[[PI, 0.0]])));
    // Beyond the tip it is not met, 0.1 mm inside the tip's corner it is: the corner is sqrt(1.1^2 + 0.01^2) from the axis.
    let corner = 1.1f64.hypot(0.01);
    let beyond = |clearance: f64| two_links(vec![wire(0.0, corner + 0.5e-3 + clearance)], 0.0);
    assert!(beyond(2e-4).is_free(&motion));
    assert!(!beyond(-2e-4).is_free(&motion));
}

#[test]
fn a_margin_is_kept_to_a_tenth_of_a_millimetre() {
    let corner = 1.1f64.hypot(0.01);
    let motion = sweep_of(&[[0.0, 0.0], [PI, 0.0]]);
    for (clearance, free) in [(0.0102, true), (0.0098, false)] {
        let model = two_links(vec![wire(0.0, corner + 0.5e-3 + clearance)], 0.01);
        assert_eq!(model.is_free(&motion), free, "{clearance}");
        if !free {
            let meeting = &model.meetings(&motion)[0];
            assert_eq!(meeting.margin, 0.01);
        }
    }
}

#[test]
fn the_depth_is_that_of_boxes_that_overlap() {
    let table = body(
        "table",
        Mount::World(DPose3::from_translation(DVec3::new(0.0, 0.5, 0.0))),
        &cuboid([4.0, 0.2, 0.4]),
        DVec3::ZERO,
    );
    let model = two_links(vec![(Role::Obstacle, table)], 0.0);
    // The forearm turned up stands with its tip 0.4 m above the upper arm's middle line, 0 to 0.02 m from the table's underside.
    let motion = sweep_of(&[[0.0, 0.0], [0.0, FRAC_PI_2]]);
    let meetings = model.meetings(&motion);
    assert!(
        meetings.is_empty() || meetings[0].depth < 1.1e-3,
        "{meetings:?}"
    );
    let lower = body(
        "table",
        Mount::World(DPose3::from_translation(DVec3::new(0.0, 0.47, 0.0))),
        &cuboid([4.0, 0.2, 0.4]),
        DVec3::ZERO,
    );
    let model = two_links(vec![(Role::Obstacle, lower)], 0.0);
    let meeting = &model.meetings(&motion)[0];
    assert_eq!((meeting.names[0].as_str(), meeting.deepest), ("fore", 1));
    assert!((meeting.depth - 0.03).abs() < 1e-6, "{meeting:?}");
}

#[test]
fn a_body_that_lies_wholly_in_a_closed_surface_is_found() {
    let half = 2.0;
    let corner = |i: usize| {
        let side = |bit: usize| if i >> bit & 1 == 1 { half } else { -half };
        DVec3::new(side(0), side(1), side(2))
    };
    let triangles = [
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
    ];
    let mesh = TriangleMesh::new((0..8).map(corner).collect(), triangles.to_vec()).unwrap();
    let hall = |x: f64| {
        let pose = DPose3::from_translation(DVec3::new(x, 0.0, 0.0));
        let solids = vec![Solid::surface(&mesh).unwrap()];
        let hall = Body {
            name: "block".to_owned(),
            mount: Mount::World(pose),
            solids,
        };
        two_links(vec![(Role::Obstacle, hall)], 0.0)
    };
    let motion = sweep_of(&[[0.0, 0.0], [0.1, 0.0]]);
    let names: Vec<_> = (hall(0.0).meetings(&motion).into_iter())
        .map(|m| m.names[0].clone())
        .collect();
    assert_eq!(names, ["upper", "fore"]);
    assert!(hall(4.0).is_free(&motion));
}

#[test]
fn levers_are_those_of_the_outstretched_arm() {
    let model = two_links(vec![wire(5.0, 0.0)], 0.0);
    let of_fore = |pair: &&Pair| model.named(pair) == ["fore", "wire"];
    let pair = model.pairs.iter().find(of_fore).unwrap();
    // The farthest corner of the fore link from each joint; the bound goes by a ball about the link, a little farther.
    for (lever, farthest) in pair.levers.iter().zip([1.1f64, 0.4]) {
        let farthest = farthest.hypot(0.01);
        assert!(
            *lever >= farthest && *lever < 1.05 * farthest,
            "{lever} {farthest}"
        );
    }
}

#[test]
fn no_point_moves_farther_than_the_bound_says() {
    for seed in 0..20 {
        let mut chain = random_chain(seed, 6);
        for joint in &mut chain.joints {
            (joint.lower, joint.upper) = (-1.5, 1.5);
        }
        let pose = DPose3::from_translation(DVec3::new(100.0, 0.0, 0.0));
        let far = body("far", Mount::World(pose), &cuboid([0.1; 3]), DVec3::ZERO);
        let shape = cuboid([0.3, 0.1, 0.2]);
        let tool = body("tool", Mount::Link(5), &shape, DVec3::new(0.1, 0.2, 0.3));
        let model = CollisionModel::new(ModelRequest {
            chain: &chain,
            world_from_base: DPose3::IDENTITY,
            bodies: vec![(Role::Robot, tool), (Role::Obstacle, far)],
            ridden: None,
            margin: 0.0,
            allowed: &[],
        })
        .unwrap();
        let from = random_positions(seed, 6);
        let to = random_positions(seed + 100, 6);
        let mut ways = [0.0; MAX_JOINTS];
        for (way, (from, to)) in ways.iter_mut().zip(from.iter().zip(&to)) {
            *way = (to - from).abs();
        }
        let bound = model.pairs[0].moved_by(&ways);
        for corner in 0..8 {
            let side = |bit: usize| if corner >> bit & 1 == 1 { 0.5 } else { -0.5 };
            let point =
                DVec3::new(0.1, 0.2, 0.3) + DVec3::new(0.3 * side(0), 0.1 * side(1), 0.2 * side(2));
            let moved = (at(&chain, &from, point) - at(&chain, &to, point)).length();
            assert!(moved <= bound, "{moved} m of at most {bound} m");
        }
    }
}

fn at(chain: &KinematicChain, q: &[f64], point: DVec3) -> DVec3 {
    let mut links = [DPose3::IDENTITY; MAX_JOINTS];
    link_poses(chain, DPose3::IDENTITY, q, &mut links[..q.len()]);
    links[q.len() - 1].transform_point(point)
}

#[test]
fn the_sweep_agrees_with_dense_samples() {
    // Wires all about, and the same motion sampled ten thousand times.
    let motion = sweep_of(&[[0.2, 0.1], [0.9, 1.7], [1.5, -0.4]]);
    let dense = |model: &CollisionModel| {
        let legs = [([0.2, 0.1], [0.9, 1.7]), ([0.9, 1.7], [1.5, -0.4])];
        legs.into_iter().any(|(from, to)| {
            (0..=5000).any(|step| {
                let share = f64::from(step) / 5000.0;
                let here = [0, 1].map(|j| from[j] + share * (to[j] - from[j]));
                !model.is_free(&sweep_of(&[here]))
            })
        })
    };
    let mut met = 0;
    for index in 0..40 {
        let angle = 0.3 + 0.05 * f64::from(index);
        let radius = 0.55 + 0.015 * f64::from(index % 37);
        let model = two_links(vec![wire(radius * angle.cos(), radius * angle.sin())], 0.0);
        let expected = dense(&model);
        met += usize::from(expected);
        assert_eq!(!model.is_free(&motion), expected, "wire {index}");
    }
    assert!((5..35).contains(&met), "{met} of 40 are met");
}

#[test]
fn neighbours_and_links_that_touch_at_rest_are_left_out_others_refused() {
    let chain = random_chain(3, 6);
    let frames = {
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        link_poses(&chain, DPose3::IDENTITY, &[0.0; 6], &mut links[..6]);
        links
    };
    // A ball on each link about the same point of the world at rest.
    let ball = |joint: usize| {
        let centre = frames[joint]
            .inverse()
            .transform_point(DVec3::new(3.0, 0.0, 0.0));
        let shape = VisualShape::Sphere { radius: 0.1 };
        let name = format!("link {joint}");
        (Role::Robot, body(&name, Mount::Link(joint), &shape, centre))
    };
    let model = |joints: &[usize], allowed: &[[String; 2]]| {
        CollisionModel::new(ModelRequest {
            chain: &chain,
            world_from_base: DPose3::IDENTITY,
            bodies: joints.iter().map(|joint| ball(*joint)).collect(),
            ridden: None,
            margin: 0.0,
            allowed,
        })
    };
    assert!(model(&[0, 1], &[]).unwrap().touching_at_rest.is_empty());
    let left_out = model(&[0, 2], &[]).unwrap();
    assert_eq!(
        left_out.touching_at_rest,
        [["link 0".to_owned(), "link 2".to_owned()]]
    );
    assert!(left_out.pairs.is_empty());
    let Err(ModelError::AtRest {
        first,
        second,
        depth,
    }) = model(&[0, 3], &[])
    else {
        panic!("three joints lie between them");
    };
    assert_eq!((first.as_str(), second.as_str()), ("link 0", "link 3"));
    assert!((depth - 0.2).abs() < 1e-6, "{depth}");
    let pair = |one: &str, two: &str| [[one.to_owned(), two.to_owned()]];
    assert!(
        model(&[0, 3], &pair("link 3", "link 0"))
            .unwrap()
            .pairs
            .is_empty()
    );
    let unknown = model(&[0, 1], &pair("link 0", "elbow")).err().unwrap();
    assert!(unknown.to_string().contains("elbow"), "{unknown}");
}

#[test]
fn a_watch_tells_the_first_frame_at_which_bodies_meet() {
    let model = two_links(vec![wire(0.0, 1.0)], 0.005);
    let frames: Vec<Positions> = (0..=3000)
        .map(|step| positions(&[PI * f64::from(step) / 3000.0, 0.0]))
        .collect();
    let mut watch = ClearanceWatch::new(model, &frames[0]);
    let met = frames.iter().position(|frame| watch.meets(frame).is_some());
    // The watch knows no margin: the edge of the arm, 10 mm off its middle line, on the wire of 0.5 mm.
    let expected = (3000.0 * (FRAC_PI_2 - f64::asin(0.0105)) / PI).ceil() as usize;
    assert_eq!(met, Some(expected));
}
