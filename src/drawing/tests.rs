//! Pictures of scenes whose look is known.

use glamx::DPose3;

use super::*;
use crate::arm::VisualShape;
use crate::scene::{ContactArrow, SceneBody, ScenePoses, SceneShape};

/// A plate of 200 x 100 x 10 mm with an edge along its upper front side, two frames, 50 N downwards in the second.
fn plate() -> Scene {
    let points: Vec<DVec3> = (0..=10)
        .map(|i| DVec3::new(-0.1 + 0.02 * f64::from(i), -0.05, 0.005))
        .collect();
    let mut errors = vec![0.0; 10];
    errors[3] = 0.02;
    errors[7] = -0.02;
    Scene {
        title: "plate".to_owned(),
        bodies: vec![SceneBody {
            entity: "workpiece".to_owned(),
            shapes: vec![SceneShape {
                body_from_shape: DPose3::IDENTITY,
                geometry: VisualShape::Box {
                    size: DVec3::new(0.2, 0.1, 0.01),
                },
                colour: [150, 165, 178, 255],
            }],
            world_from_body: ScenePoses::Static(DPose3::IDENTITY),
        }],
        frame_times: vec![0.0, 1.0],
        frame_path_lengths: vec![0.0, 0.1],
        edge_path: EdgePath {
            points_in_world: points,
            relative_force_error: errors,
            ..EdgePath::default()
        },
        contact_arrows: [0.0, -50.0]
            .map(|force| ContactArrow {
                point_in_world: DVec3::new(0.0, -0.05, 0.005),
                force_in_world: DVec3::new(0.0, 0.0, force),
            })
            .to_vec(),
        ..Scene::default()
    }
}

#[test]
fn an_edge_is_drawn_in_the_colours_of_its_error_with_their_scale() {
    let scene = plate();
    let svg = edge(&scene).unwrap();
    for expected in [
        "−2 %",
        "+2 %",
        "as desired",
        "start",
        "mm</text>",
        "data:image/png;base64,",
    ] {
        assert!(svg.contains(expected), "{expected}");
    }
    // Too much and too little once each along the edge, besides the ends of the legend's bar.
    let lines = |colour: &str| {
        let lines = svg.lines().filter(|line| line.starts_with("<line"));
        lines.filter(|line| line.contains(colour)).count()
    };
    assert_eq!(
        [lines("#d55e00"), lines("#0072b2"), lines("#f5f5f5")],
        [1, 1, 8]
    );
    assert!(!svg.contains("no contact"));
    assert_eq!(svg, edge(&scene).unwrap());
}

#[test]
fn an_edge_is_looked_at_from_the_side_of_the_tool_and_across() {
    let scene = plate();
    let eye = edge_direction(&scene);
    assert!(eye.z > 0.25 && eye.x.abs() < 0.3, "{eye}");
    // All of it is seen: nothing is drawn pale.
    assert!(!edge(&scene).unwrap().contains("opacity"));
}

#[test]
fn an_edge_behind_the_part_is_drawn_pale() {
    let mut scene = plate();
    for point in &mut scene.edge_path.points_in_world {
        point.z = -0.005;
        point.y = 0.05;
    }
    assert!(edge(&scene).unwrap().contains("opacity=\"0.45\""));
    scene.edge_path = EdgePath::default();
    assert_eq!(edge(&scene), None);
}

#[test]
fn the_force_is_labelled_at_the_moment_that_is_shown() {
    let scene = plate();
    assert!(cell(&scene, 0.9).contains(">50.00 N</text>"));
    assert!(!cell(&scene, 0.1).contains(" N</text>"));
    assert!(cell(&scene, 0.9).contains(">part</text>"));
    // A scale of a round length: 50 mm of a plate of 200 mm.
    assert!(cell(&scene, 0.9).contains(" mm</text>"));
}

// Catches: a rotation that is drawn the other way round, or one before the other.
#[test]
fn a_turned_shape_on_a_turned_body_is_drawn_where_it_is() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut scene = plate();
    let corner = DVec3::new(1.0, 2.0, 3.0);
    scene.bodies[0].shapes[0].geometry = VisualShape::Mesh {
        vertices: vec![corner, corner + DVec3::X, corner + DVec3::Y],
        triangles: vec![[0, 1, 2]],
    };
    let turned = |axis: DVec3, by: DVec3| {
        let rotation = glam::DQuat::from_axis_angle(axis, quarter);
        DPose3::from_parts(by, rotation)
    };
    // About x: y goes to z and z to -y; then about z: x goes to y and y to -x.
    scene.bodies[0].shapes[0].body_from_shape = turned(DVec3::X, DVec3::new(10.0, 0.0, 0.0));
    let body = turned(DVec3::Z, DVec3::new(0.0, 0.0, 100.0));
    let expected = [
        DVec3::new(3.0, 11.0, 102.0),
        DVec3::new(3.0, 12.0, 102.0),
        DVec3::new(3.0, 11.0, 103.0),
    ];
    let moving = ScenePoses::Moving(vec![DPose3::IDENTITY, body]);
    for poses in [ScenePoses::Static(body), moving] {
        scene.bodies[0].world_from_body = poses;
        let drawn = faces(&scene, 1, |_| true);
        for (corner, expected) in drawn[0].corners.into_iter().zip(expected) {
            assert!(
                (corner - expected).length() < 1e-9,
                "{corner}, not {expected}"
            );
        }
        // Of the triangle in its own plane it was z.
        assert!((drawn[0].normals[0] - DVec3::X).length() < 1e-9);
    }
}
