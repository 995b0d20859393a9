//! Rapier's results for the robots: mass matrix and gravity torques of its multibody against Pinocchio.

use glam::DVec3;
use glamx::DPose3;
use idc_cell::simulation::contact::ToolBall;
use idc_cell::simulation::world::{World, WorldDescription};
use idc_cell::workpiece::TriangleMesh;

use super::{Robot, load, references};

/// Largest difference accepted, measured as in the parent module; the project asks for 1e-4.
const TOLERANCE: f64 = 1e-9;

/// A tetrahedron out of everybody's way.
fn far_part() -> TriangleMesh {
    let vertices =
        [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|corner| corner + DVec3::splat(100.0));
    TriangleMesh::new(
        vertices.to_vec(),
        vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    )
    .unwrap()
}

fn differences(robot: &Robot) -> (f64, f64) {
    let (arm, part) = (load(robot), far_part());
    let mut world = World::new(&WorldDescription {
        chain: arm.chain.clone(),
        world_from_base: DPose3::IDENTITY,
        gravity: DVec3::from_array(robot.gravity),
        step: 1e-3,
        tool: ToolBall {
            radius: 5e-3,
            centre_in_link: DVec3::ZERO,
        },
        part: &part,
        friction: 0.0,
        most_held: 1,
    });
    let (mut mass_off, mut gravity_off) = (0.0f64, 0.0f64);
    for case in &robot.cases {
        world.set_positions(&case.q);
        let (mass, gravity) = (world.mass_matrix(), world.gravity_torques());
        for (i, row) in case.mass_matrix.iter().enumerate() {
            for (j, expected) in row.iter().enumerate() {
                let scale = (case.mass_matrix[i][i] * case.mass_matrix[j][j]).sqrt();
                mass_off = mass_off.max((mass[(i, j)] - expected).abs() / scale);
            }
        }
        let largest = case
            .gravity_torques
            .iter()
            .fold(0.0f64, |most, torque| most.max(torque.abs()));
        for (found, expected) in gravity.iter().zip(&case.gravity_torques) {
            gravity_off = gravity_off.max((found - expected).abs() / largest);
        }
    }
    (mass_off, gravity_off)
}

#[test]
fn rapier_has_the_mass_matrix_and_gravity_torques_of_pinocchio() {
    for robot in references().unwrap_or_default() {
        let (mass, gravity) = differences(&robot);
        println!(
            "{}: Rapier's mass matrix within {mass:.1e}, gravity torques within {gravity:.1e}",
            robot.name
        );
        assert!(
            mass < TOLERANCE && gravity < TOLERANCE,
            "{}: {mass:.1e}, {gravity:.1e}",
            robot.name
        );
    }
}
