//! The plate edge, 120 mm of it at 20 mm/s, with each of the real robots: at a force that its effort limits allow, and refused beyond them.
//!
//! All carry the device as it comes, 4 kg moving mass included, its housing left out. The part lies where the robot reaches it in comfort.

use glam::{DQuat, DVec3};
use glamx::DPose3;
use idc_cell::cell::{Cell, CellError};
use idc_cell::path::{Obstacle, PlanError};
use idc_cell::plant::ContactLaw;
use idc_cell::scenario::Scenario;

use super::references;
use crate::common::{run, scenario};

/// A robot's job.
pub(super) struct Job {
    pub robot: &'static str,
    /// Part in front of the robot and above its base [m].
    place: [f64; 2],
    /// Part turned about world y, its far side down [deg].
    pitch: f64,
    /// Force within the effort limits [N].
    pub force: f64,
    /// Force beyond them [N].
    too_much: f64,
    /// The axis that gives in first, and its effort limit as the robot's file has it [N m].
    axis: (&'static str, f64),
}

/// A job for each of the robots.
pub(super) const JOBS: [Job; 5] = [
    // The file gives every axis 300 N m, so it takes a force far beyond its payload to exceed one.
    Job {
        robot: "kuka_iiwa",
        place: [0.5, 0.2],
        pitch: 30.0,
        force: 300.0,
        too_much: 1500.0,
        axis: ("lbr_iiwa_joint_2", 300.0),
    },
    // Its wrist has 12 N m, of which holding the device alone takes a third or more.
    Job {
        robot: "panda",
        place: [0.4, 0.2],
        pitch: 0.0,
        force: 100.0,
        too_much: 300.0,
        axis: ("panda_joint6", 12.0),
    },
    Job {
        robot: "xarm6",
        place: [0.4, 0.35],
        pitch: 30.0,
        force: 150.0,
        too_much: 200.0,
        axis: ("joint2", 50.0),
    },
    Job {
        robot: "ur5",
        place: [0.55, 0.2],
        pitch: 0.0,
        force: 300.0,
        too_much: 400.0,
        axis: ("shoulder_lift_joint", 150.0),
    },
    Job {
        robot: "ur10",
        place: [0.7, 0.2],
        pitch: 0.0,
        force: 300.0,
        too_much: 600.0,
        axis: ("wrist_1_joint", 54.0),
    },
];

/// The scenario, unless the robots are not installed.
pub(super) fn scenario_of(job: &Job, force: f64) -> Option<Scenario> {
    let robot = references()?
        .into_iter()
        .find(|robot| robot.name == job.robot)
        .unwrap();
    let mut scenario = scenario("plate_edge_ideal");
    assert_eq!(scenario.process.feed, 0.02);
    assert_eq!(scenario.nominal.device.moving_mass, 4.0);
    scenario.arm.urdf = robot.urdf;
    scenario.arm.base_link = Some(robot.base_link);
    scenario.arm.flange_link = robot.tip_link;
    scenario.arm.package_directories = robot.package_directories;
    (scenario.workpiece.edge.start, scenario.workpiece.edge.end) = (0.09, Some(0.21));
    scenario.workpiece.world_from_part = DPose3::from_parts(
        DVec3::new(job.place[0], 0.0, job.place[1]),
        DQuat::from_rotation_y(job.pitch.to_radians())
            * DQuat::from_rotation_z(-std::f64::consts::FRAC_PI_2),
    );
    scenario.process.force = force;
    // Light robots carry the slide, which is what their limits here were found with, and no housing.
    scenario.nominal.mounting.housing_mass = 0.0;
    // Six bar would not give what some of the arms are too weak for.
    scenario.nominal.device.regulator.supply = 10e5;
    Some(scenario)
}

fn check(job: &Job) {
    let Some(scenario) = scenario_of(job, job.force) else {
        return;
    };
    let summary = run(scenario).summary;
    let (mean, variation) = (
        summary.force_mean_n.unwrap(),
        summary.coefficient_of_variation_percent.unwrap(),
    );
    let share = summary.joint_torque_share_percent.unwrap();
    println!(
        "{}: {} N, mean {mean:.2} N, coefficient of variation {variation:.4} %, most loaded {} at {share:.1} % of its limit",
        job.robot,
        job.force,
        summary.most_loaded_joint.unwrap()
    );
    assert!(summary.path_length_mm.unwrap() > 119.0, "{}", job.robot);
    assert!(
        (mean / job.force - 1.0).abs() < 5e-3,
        "{}: mean force {mean} N",
        job.robot
    );
    assert!(
        variation <= 1.0,
        "{}: coefficient of variation {variation} %",
        job.robot
    );
    assert!(
        share <= 100.0,
        "{}: {share} % of an effort limit",
        job.robot
    );
    refused(job);
}

/// Too much force is refused before anything moves, by axis and limit.
fn refused(job: &Job) {
    let mut scenario = scenario_of(job, job.too_much).unwrap();
    // Or the tool would be planned so deep in the part that its shank is in it.
    let stiffness = 20.0 * scenario.nominal.contact.stiffness_at(0.0);
    scenario.nominal.contact.law = ContactLaw::Linear { stiffness };
    let error = Cell::new(scenario).err().unwrap();
    println!("{}: {} N: {error}", job.robot, job.too_much);
    let CellError::Plan { source, .. } = &error else {
        panic!("{error}");
    };
    let PlanError::Waypoint {
        phase,
        obstacle: Obstacle::Effort { axis, value, limit },
        ..
    } = &**source
    else {
        panic!("{error}");
    };
    assert_eq!(
        (*phase, axis.as_str(), *limit),
        ("follow", job.axis.0, job.axis.1)
    );
    assert!(value.abs() > *limit);
    let message = error.to_string();
    let (name, limit) = job.axis;
    assert!(message.contains(&format!(
        "axis {name} would need {:.2} N m, its limit is {limit:.2} N m",
        value.abs()
    )));
}

fn check_of(robot: &str) {
    check(JOBS.iter().find(|job| job.robot == robot).unwrap());
}

#[test]
fn kuka_iiwa() {
    check_of("kuka_iiwa");
}

#[test]
fn panda() {
    check_of("panda");
}

#[test]
fn xarm6() {
    check_of("xarm6");
}

#[test]
fn ur5() {
    check_of("ur5");
}

#[test]
fn ur10() {
    check_of("ur10");
}
