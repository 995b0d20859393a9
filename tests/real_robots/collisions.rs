//! Collisions of three robots along a motion with a part and obstacles placed at random, against coal on the same bodies.

use std::process::Command;

use glam::{DQuat, DVec3};
use glamx::DPose3;
use idc_cell::arm::MAX_JOINTS;
use idc_cell::arm::kinematics::link_poses;
use idc_cell::cell::{Cell, Setup};
use idc_cell::collision::{Body, Mount};
use idc_cell::scenario::{Obstacle, ObstacleShape, Scenario};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use super::plate_edge::{JOBS, scenario_of};
use crate::common::{project, skipped};

/// Nearer to touching than this a placement may be judged either way [m].
const TOUCHING: f64 = 1e-3;
/// Placements of each robot: some in the ordinary tests, more with `IDC_ALL_PLACEMENTS=1`, two minutes on a processor.
fn count_of_placements() -> usize {
    match std::env::var_os("IDC_ALL_PLACEMENTS") {
        Some(_) => 67,
        None => 20,
    }
}

fn pose(pose: DPose3) -> Value {
    json!({ "position": pose.translation.to_array(), "quaternion": pose.rotation.to_array() })
}

fn described(body: &Body) -> Value {
    let mount = match body.mount {
        Mount::World(at) => json!({ "world": pose(at) }),
        Mount::Link(joint) => json!({ "link": joint }),
    };
    let solids = body.solids.iter().map(|solid| {
        let (vertices, triangles) = solid.triangles();
        let vertices: Vec<[f64; 3]> = vertices.iter().map(DVec3::to_array).collect();
        json!({ "vertices": vertices, "triangles": triangles, "convex": solid.is_convex() })
    });
    json!({ "name": body.name, "mount": mount, "solids": solids.collect::<Vec<_>>() })
}

/// A box and a bracket, an L with a hole, far away from the robot.
fn with_obstacles(mut scenario: Scenario) -> Scenario {
    let far = DPose3::from_translation(DVec3::new(0.0, 5.0, 1.0));
    let obstacle = |name: &str, shape: ObstacleShape| Obstacle {
        name: name.to_owned(),
        shape,
        world_from_obstacle: far,
    };
    let path = project("assets/bracket.stl");
    scenario.collision.margin = 0.0;
    scenario.collision.obstacles = vec![
        obstacle("box", ObstacleShape::Box(DVec3::new(0.1, 0.3, 0.2))),
        obstacle("bracket", ObstacleShape::Mesh { path, scale: 2e-3 }),
    ];
    scenario
}

/// The part and the obstacles anywhere about the robot's motion.
fn placed(scenario: &Scenario, random: &mut ChaCha8Rng) -> Scenario {
    let about = scenario.workpiece.world_from_part.translation;
    let mut anywhere = |rotation: DQuat| {
        let mut within = |most: f64| random.random_range(-most..most);
        let shift = DVec3::new(within(0.45), within(0.45), within(0.35));
        let turn = DQuat::from_rotation_z(within(3.1)) * DQuat::from_rotation_x(within(3.1));
        DPose3::from_parts(about + shift, turn * rotation)
    };
    let mut scenario = scenario.clone();
    scenario.workpiece.world_from_part = anywhere(DQuat::IDENTITY);
    for obstacle in &mut scenario.collision.obstacles {
        obstacle.world_from_obstacle = anywhere(DQuat::IDENTITY);
    }
    scenario
}

/// A robot's motion and its placements, with what is found of each pair.
fn document(cell: &Cell, random: &mut ChaCha8Rng) -> (Value, Vec<Vec<bool>>) {
    let joints = cell.setup.arm_with_slide.len();
    let base = cell.setup.scenario.arm.world_from_base;
    let motion: Vec<Vec<Value>> = (cell.plan.motion().knots().iter())
        .map(|knot| {
            let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
            let poses = &mut poses[..joints];
            link_poses(&cell.setup.arm_with_slide, base, &knot[..joints], poses);
            poses.iter().map(|at| pose(*at)).collect()
        })
        .collect();
    let of_robot = |body: &&Body| {
        matches!(body.mount, Mount::Link(_)) || body.name == cell.setup.arm.link_names[0]
    };
    let robot: Vec<Value> = cell
        .setup
        .collision
        .bodies()
        .filter(of_robot)
        .map(described)
        .collect();
    let (mut placements, mut verdicts) = (Vec::new(), Vec::new());
    for _ in 0..count_of_placements() {
        let model = Setup::load(placed(&cell.setup.scenario, random))
            .unwrap()
            .collision;
        let fixed = model.bodies().filter(|body| !of_robot(body));
        let fixed: Vec<Value> = fixed.map(described).collect();
        let ours = ["part", "box", "bracket"];
        let with_fixed = |pair: &[String; 2]| {
            ours.contains(&pair[1].as_str()) && pair[0] != cell.setup.arm.link_names[0]
        };
        let pairs: Vec<[String; 2]> = model.checked().filter(with_fixed).collect();
        let met: Vec<[String; 2]> = (model.meetings(cell.plan.motion()).into_iter())
            .map(|meeting| meeting.names)
            .collect();
        verdicts.push(pairs.iter().map(|pair| met.contains(pair)).collect());
        placements.push(json!({ "bodies": fixed, "pairs": pairs }));
    }
    (
        json!({ "robot": robot, "motion": motion, "placements": placements }),
        verdicts,
    )
}

#[test]
fn meetings_along_a_motion_are_those_that_coal_finds() {
    let python = project("build/references/venv/bin/python");
    if !python.is_file() {
        skipped("build/references/venv is absent; run .ci/install_references");
        return;
    }
    let mut random = ChaCha8Rng::seed_from_u64(21);
    let (mut documents, mut verdicts) = (Vec::new(), Vec::new());
    for job in JOBS
        .iter()
        .filter(|job| ["ur5", "kuka_iiwa", "panda"].contains(&job.robot))
    {
        let Some(scenario) = scenario_of(job, job.force) else {
            return;
        };
        let cell = Cell::new(with_obstacles(scenario)).unwrap();
        let (document, own) = document(&cell, &mut random);
        documents.push(document);
        verdicts.extend(own);
    }
    assert_eq!(verdicts.len(), 3 * count_of_placements());
    let folder = tempfile::tempdir().unwrap();
    let [asked, reported] = ["asked.json", "answered.json"].map(|name| folder.path().join(name));
    std::fs::write(&asked, serde_json::to_string(&documents).unwrap()).unwrap();
    let script = project("tests/reference/coal_placements.py");
    let done = Command::new(python)
        .arg(script)
        .args([&asked, &reported])
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{errors}");
    let text = std::fs::read_to_string(reported).unwrap();
    let distances: Vec<Vec<f64>> = serde_json::from_str(&text).unwrap();
    let (mut meeting, mut near, mut pairs) = (0, 0, 0);
    for (placement, (own, distances)) in verdicts.iter().zip(&distances).enumerate() {
        assert_eq!(own.len(), distances.len());
        meeting += usize::from(own.contains(&true));
        for (pair, (met, distance)) in own.iter().zip(distances).enumerate() {
            pairs += 1;
            near += usize::from(distance.abs() < TOUCHING);
            let agree = *met == (*distance <= 0.0) || distance.abs() < TOUCHING;
            assert!(
                agree,
                "placement {placement}, pair {pair}: met {met}, by coal {distance} m"
            );
        }
    }
    println!(
        "{meeting} of {} placements meet; {pairs} pairs, {near} of them within 1 mm of touching",
        verdicts.len()
    );
    let share = meeting as f64 / verdicts.len() as f64;
    assert!((0.2..0.8).contains(&share), "{meeting} meet");
}
