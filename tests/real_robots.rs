//! Robot files that nobody here wrote: their dynamics against Pinocchio, ours and Rapier's, and the plate edge with each of them.
//!
//! `.ci/install_references` installs them and writes `build/references/robots.json`; without it these tests
//! say that they were skipped.

mod collisions;
mod engine;
mod five_axes;
mod plate_edge;

use glam::{DMat4, DQuat, DVec3};
use glamx::DPose3;
use idc_cell::arm::dynamics::{gravity_torques, mass_matrix};
use idc_cell::arm::inverse_kinematics::{IkOptions, solve};
use idc_cell::arm::kinematics::tip_pose;
use idc_cell::arm::{Arm, ArmOptions, VisualShape, load_arm};
use nalgebra::DMatrix;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::common::{project, skipped};

/// Largest difference accepted. Of the mass matrix: of element i, j against sqrt(M_ii M_jj). Of the gravity
/// torques: against the largest of them. The project asks for 1e-4; both sides are exact to rounding.
const TOLERANCE: f64 = 1e-9;

#[derive(Deserialize)]
struct References {
    robots: Vec<Robot>,
}

#[derive(Deserialize)]
struct Robot {
    name: String,
    urdf: PathBuf,
    package_directories: BTreeMap<String, PathBuf>,
    base_link: String,
    tip_link: String,
    gravity: [f64; 3],
    joints: Vec<String>,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    q: Vec<f64>,
    mass_matrix: Vec<Vec<f64>>,
    gravity_torques: Vec<f64>,
    base_from_tip: [[f64; 4]; 4],
}

/// The reference robots, or none with a message that the test is skipped.
fn references() -> Option<Vec<Robot>> {
    let Ok(text) = std::fs::read_to_string(project("build/references/robots.json")) else {
        skipped("build/references/robots.json is absent; run .ci/install_references");
        return None;
    };
    let references: References = serde_json::from_str(&text).expect("robots.json is as written");
    assert_eq!(references.robots.len(), 5);
    Some(references.robots)
}

fn load(robot: &Robot) -> Arm {
    let options = ArmOptions {
        base_link: Some(robot.base_link.clone()),
        tip_link: robot.tip_link.clone(),
        package_directories: robot.package_directories.clone(),
        ..ArmOptions::default()
    };
    let arm = load_arm(&robot.urdf, &options).unwrap_or_else(|error| panic!("{error}"));
    for note in &arm.notes {
        println!("{}: {note}", robot.name);
    }
    arm
}

fn pose(rows: &[[f64; 4]; 4]) -> DPose3 {
    let matrix = DMat4::from_cols_array_2d(rows).transpose();
    let (_, rotation, translation) = matrix.to_scale_rotation_translation();
    DPose3::from_parts(translation, rotation)
}

#[test]
fn real_robots_have_the_mass_matrix_gravity_torques_and_tip_of_pinocchio() {
    for robot in references().unwrap_or_default() {
        let arm = load(&robot);
        let chain = &arm.chain;
        let names: Vec<_> = chain.joints.iter().map(|joint| &joint.name).collect();
        assert_eq!(names, robot.joints.iter().collect::<Vec<_>>());
        let (mut worst_mass, mut worst_gravity) = (0.0f64, 0.0f64);
        for case in &robot.cases {
            let mut mass = DMatrix::zeros(chain.len(), chain.len());
            mass_matrix(chain, &case.q, &mut mass);
            for (i, row) in case.mass_matrix.iter().enumerate() {
                for (j, expected) in row.iter().enumerate() {
                    let scale = (case.mass_matrix[i][i] * case.mass_matrix[j][j]).sqrt();
                    worst_mass = worst_mass.max((mass[(i, j)] - expected).abs() / scale);
                }
            }
            let mut gravity = vec![0.0; chain.len()];
            let down = DVec3::from_array(robot.gravity);
            gravity_torques(chain, DQuat::IDENTITY, down, &case.q, &mut gravity);
            let largest = case
                .gravity_torques
                .iter()
                .fold(0.0f64, |m, g| m.max(g.abs()));
            for (ours, expected) in gravity.iter().zip(&case.gravity_torques) {
                worst_gravity = worst_gravity.max((ours - expected).abs() / largest);
            }
            let tip = tip_pose(chain, DPose3::IDENTITY, &case.q);
            let expected = pose(&case.base_from_tip);
            assert!((tip.translation - expected.translation).length() < 1e-12);
            assert!(tip.rotation.dot(expected.rotation).abs() > 1.0 - 1e-12);
        }
        println!(
            "{}: {} cases, mass matrix within {worst_mass:.1e}, gravity torques within {worst_gravity:.1e}",
            robot.name,
            robot.cases.len()
        );
        assert!(
            worst_mass < TOLERANCE && worst_gravity < TOLERANCE,
            "{}",
            robot.name
        );
    }
}

#[test]
fn real_robots_are_drawn_near_their_links() {
    for robot in references().unwrap_or_default() {
        let arm = load(&robot);
        // Every link of the five has a mesh; none of their links is longer than 0.8 m.
        for index in 0..arm.link_names.len() {
            let mut farthest = 0.0f64;
            for visual in arm
                .visuals
                .iter()
                .filter(|visual| visual.link_index == index)
            {
                if let VisualShape::Mesh { vertices, .. } = &visual.shape {
                    for vertex in vertices {
                        let point = visual.link_from_visual.transform_point(*vertex);
                        farthest = farthest.max(point.length());
                    }
                }
            }
            let link = &arm.link_names[index];
            assert!(
                (0.03..0.8).contains(&farthest),
                "{}: {link} is drawn up to {farthest} m away",
                robot.name
            );
        }
    }
}

#[test]
fn real_robots_reach_poses_they_can_reach() {
    for robot in references().unwrap_or_default() {
        let arm = load(&robot);
        let chain = &arm.chain;
        for case in &robot.cases {
            // The file's own limits may be narrowed by a safety controller.
            let bounds = chain.joints.iter().zip(&case.q);
            let q: Vec<_> = bounds
                .map(|(joint, q)| q.clamp(joint.lower, joint.upper))
                .collect();
            let target = tip_pose(chain, DPose3::IDENTITY, &q);
            let start = vec![0.1; chain.len()];
            let solution = solve(
                chain,
                DPose3::IDENTITY,
                &target,
                &start,
                &IkOptions::default(),
            );
            let solution = solution.unwrap_or_else(|failure| panic!("{}: {failure:?}", robot.name));
            let reached = tip_pose(chain, DPose3::IDENTITY, &solution.q);
            assert!((reached.translation - target.translation).length() < 2e-9);
            for (joint, position) in chain.joints.iter().zip(&solution.q) {
                assert!(
                    (joint.lower..=joint.upper).contains(position),
                    "{}",
                    joint.name
                );
            }
        }
    }
}
