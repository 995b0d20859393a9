//! What cannot work is refused before it moves, by name and place.

use glam::DVec3;
use glamx::DPose3;
use idc_cell::cell::{Cell, CellError};
use idc_cell::path::{Obstacle as InTheWay, PlanError};
use idc_cell::place::{Hindrance, PlaceGrid, best_places, tried_places};
use idc_cell::run::run_cell;
use idc_cell::scenario::{Direction, Obstacle, ObstacleShape, Scenario};
use idc_cell::simulation::SimulationError;

use crate::common::{run, scenario};

fn refusal(scenario: Scenario) -> CellError {
    match Cell::new(scenario) {
        Ok(_) => panic!("the job was accepted"),
        Err(error) => error,
    }
}

fn at(mut scenario: Scenario, shift: DVec3) -> Scenario {
    scenario.workpiece.world_from_part.translation += shift;
    scenario
}

fn with_obstacle(mut scenario: Scenario, name: &str, size: DVec3, place: DVec3) -> Scenario {
    scenario.collision.obstacles.push(Obstacle {
        name: name.to_owned(),
        shape: ObstacleShape::Box(size),
        world_from_obstacle: DPose3::from_translation(place),
    });
    scenario
}

/// The names of the bodies that a plan was refused for.
fn meeting(error: &CellError) -> [String; 2] {
    let CellError::Plan { source, .. } = error else {
        panic!("{error}");
    };
    let PlanError::Waypoint {
        obstacle: InTheWay::Collision(meeting),
        ..
    } = &**source
    else {
        panic!("{error}");
    };
    meeting.names.clone()
}

#[test]
fn a_part_in_the_robot_s_base_is_refused_by_name() {
    // A position in metres where millimetres are asked for, but for the height.
    let mut typed = scenario("plate_edge_ideal");
    typed.workpiece.world_from_part.translation = DVec3::new(0.75e-3, 0.0, 0.05);
    let error = refusal(typed);
    let CellError::Penetration { names, depth, .. } = &error else {
        panic!("{error}");
    };
    assert!(
        names.contains(&"part".to_owned()) && *depth > 0.0,
        "{error}"
    );
}

#[test]
fn no_axis_within_its_limit_is_blamed_for_what_is_too_far_away() {
    let error = refusal(at(scenario("plate_edge_ideal"), DVec3::X * 1.2)).to_string();
    assert!(error.contains("out of reach by"), "{error}");
    assert!(!error.contains("its limit is"), "{error}");
}

#[test]
fn a_wire_across_the_way_between_two_waypoints_is_found() {
    let job = || scenario("plate_edge_ideal");
    let cell = Cell::new(job()).unwrap();
    // Half way along the edge and half way between two waypoints, 1 mm of wire across the tool's shank.
    let reference = cell.plan.reference(0.5 * cell.plan.duration() + 0.025);
    let place = reference.centre - reference.axis * 0.05;
    let thin = DVec3::new(0.2, 1e-3, 1e-3);
    let mut wired = with_obstacle(job(), "wire", thin, place);
    wired.collision.margin = 0.0;
    assert_eq!(meeting(&refusal(wired)), ["tool", "wire"]);
    // Farther back than the device reaches, the same wire is free.
    let mut free = with_obstacle(job(), "wire", thin, place + DVec3::new(0.6, 0.0, 0.6));
    free.collision.margin = 0.0;
    assert!(Cell::new(free).is_ok());
}

#[test]
fn a_wall_beside_the_arm_is_avoided_or_refused_by_name() {
    // Between base and part, as high as the shoulder: no posture passes it.
    let wall = with_obstacle(
        scenario("plate_edge_ideal"),
        "wall",
        DVec3::new(0.02, 3.0, 1.6),
        DVec3::new(0.4, 0.0, 0.8),
    );
    let error = refusal(wall);
    let names = meeting(&error);
    assert!(names.contains(&"wall".to_owned()), "{error}");
    let reported = error.to_string();
    assert!(
        reported.contains("waypoint") && reported.contains("mm deep"),
        "{reported}"
    );
}

#[test]
fn what_may_meet_by_the_scenario_does_not_count() {
    let place = DVec3::new(0.75, 0.0, 0.6);
    let blocked = || {
        with_obstacle(
            scenario("plate_edge_ideal"),
            "bar",
            DVec3::new(2.0, 0.05, 0.05),
            place,
        )
    };
    let names = meeting(&refusal(blocked()));
    let mut allowed = blocked();
    for _ in 0..20 {
        match Cell::new(allowed.clone()) {
            Ok(_) => return,
            Err(error) => {
                let [first, second] = meeting(&error);
                assert_eq!(second, names[1], "{error}");
                allowed.collision.allowed_pairs.push([first, second]);
            }
        }
    }
    panic!("{:?}", allowed.collision.allowed_pairs);
}

#[test]
fn a_run_in_which_bodies_meet_stops_and_keeps_what_was_recorded() {
    let mut cell = Cell::new(scenario("plate_edge_ideal")).unwrap();
    let middle = cell.plan.reference(0.5 * cell.plan.duration());
    // Planned without the post; it stands where the spindle comes by in the middle of the edge.
    let place = middle.centre - middle.axis * 0.1;
    let mut with_post = scenario("plate_edge_ideal");
    with_post.collision.allowed_pairs = Vec::new();
    let far = with_obstacle(
        with_post,
        "post",
        DVec3::splat(0.04),
        DVec3::new(-3.0, 0.0, 1.0),
    );
    let mut model = Cell::new(far).unwrap().setup.collision;
    model.move_body("post", DPose3::from_translation(place));
    cell.setup.collision = model;
    let finished = run_cell(&cell, &mut |_| ()).unwrap();
    let Some(SimulationError::Collision {
        names, phase, time, ..
    }) = &finished.stop
    else {
        panic!("{:?}", finished.stop);
    };
    assert_eq!((names[1].as_str(), *phase), ("post", "follow"));
    let last = finished.recording.time().last().copied().unwrap();
    assert!((last - time).abs() < 1e-9 && last < 0.5 * cell.plan.duration());
}

#[test]
fn the_weight_of_the_tool_is_reported_with_what_to_change() {
    let down = |force: f64, mass: Option<f64>| {
        let mut scenario = scenario("plate_edge_ideal");
        scenario.process.tool_axis = Some(Direction(DVec3::NEG_Z));
        scenario.process.force = force;
        if let Some(mass) = mass {
            scenario.nominal.device.moving_mass = mass;
        }
        scenario
    };
    // 4 kg straight down on an edge at 45 degrees press with 4 x 9.81 / cos 45 = 55.5 N.
    let error = refusal(down(30.0, None));
    let CellError::Weight {
        pressing,
        most_mass,
        ..
    } = &error
    else {
        panic!("{error}");
    };
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert!((pressing - 4.0 * 9.81 / half).abs() < 1e-6, "{error}");
    assert!((most_mass - 30.0 * half / 9.81).abs() < 1e-9, "{error}");
    assert!(
        error.to_string().contains("moving_mass_kg at most 2.16"),
        "{error}"
    );
    let summary = run(down(30.0, Some(2.16))).summary;
    assert!((summary.force_mean_n.unwrap() / 30.0 - 1.0).abs() < 5e-3);
    let summary = run(down(80.0, None)).summary;
    assert!((summary.force_mean_n.unwrap() / 80.0 - 1.0).abs() < 5e-3);
}

#[test]
fn a_tool_axis_along_the_bisector_is_the_job_without_a_lean() {
    let plain = Cell::new(scenario("plate_edge_ideal")).unwrap();
    let axis = plain.plan.reference(0.5 * plain.plan.duration()).axis;
    let mut given = scenario("plate_edge_ideal");
    given.process.tool_axis = Some(Direction(axis));
    let given = Cell::new(given).unwrap();
    assert!((given.axial_share - 1.0).abs() < 1e-12);
    let [a, b] = [&plain, &given].map(|cell| cell.plan.reference(0.5 * cell.plan.duration()));
    for (a, b) in a.position.iter().zip(&b.position) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
    // Into the part's face it is no tool axis.
    let mut aside = scenario("plate_edge_ideal");
    aside.process.tool_axis = Some(Direction(DVec3::Z));
    let error = refusal(aside);
    assert!(
        error.to_string().contains("from the edge's bisector"),
        "{error}"
    );
}

#[test]
fn the_best_place_of_a_grid_is_confirmed_by_a_run_and_the_map_by_planning() {
    let job = scenario("plate_edge_ideal");
    let setup = idc_cell::cell::Setup::load(job.clone()).unwrap();
    let grid = PlaceGrid {
        x: vec![0.1, 0.45, 0.7, 0.95, 1.4],
        y: vec![-0.2, 0.1],
        z: 0.2,
        rolls: 6,
    };
    let tried = tried_places(&setup, &grid, &|| ());
    assert_eq!(tried.len(), 10);
    let at_place = |position: DVec3, roll: Option<f64>| {
        let mut scenario = job.clone();
        scenario.workpiece.world_from_part.translation = position;
        scenario.process.roll = roll;
        scenario
    };
    for place in &tried {
        match place.outcome {
            Ok(possible) => {
                let cell = Cell::new(at_place(place.position, Some(possible.roll))).unwrap();
                assert!((cell.plan.duration() - possible.cycle_time).abs() < 1e-9);
                assert!(place.rolls > 0);
            }
            Err(Hindrance::Reach) => {
                assert!(Cell::new(at_place(place.position, None)).is_err());
            }
            Err(_) => {}
        }
    }
    let outcomes: Vec<_> = tried.iter().map(|place| place.outcome).collect();
    assert!(outcomes.contains(&Err(Hindrance::Reach)), "{outcomes:?}");
    let best = best_places(&tried);
    let (position, possible) = best[0];
    assert!(
        best.iter()
            .all(|(_, other)| other.comfort <= possible.comfort)
    );
    let summary = run(at_place(position, Some(possible.roll))).summary;
    assert!((summary.force_mean_n.unwrap() / 150.0 - 1.0).abs() < 0.01);
}
