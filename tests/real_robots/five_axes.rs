//! An arm of five axes: it cannot choose the turn about the tool's axis, and a ball nose does not ask for it. Being simple, the arm also shows in
//! closed form what the check of effort limits counts.

use glam::DVec3;
use glamx::DPose3;
use idc_cell::arm::kinematics::tip_pose;
use idc_cell::cell::{Cell, CellError};
use idc_cell::path::{Obstacle, PlanError};
use idc_cell::scenario::{LimitOverride, Scenario};

use crate::common::{run, scenario};

/// Waist, shoulder, elbow and wrist pitch, then a last axis along `last`; dry friction [N m] in each.
fn urdf(last: &str, friction: f64) -> String {
    let axes = [
        ("base", "waist", "0 0 1", 0.3),
        ("waist", "shoulder", "0 1 0", 0.1),
        ("shoulder", "elbow", "0 1 0", 0.45),
        ("elbow", "wrist", "0 1 0", 0.45),
        ("wrist", "last", last, 0.1),
    ];
    let mut text = String::from(r#"<robot name="five"><link name="base"/>"#);
    for (parent, name, axis, up) in axes {
        text += &format!(
            r#"<link name="{name}"><inertial><origin xyz="0 0 0.1"/><mass value="4"/>
            <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.02"/></inertial></link>
            <joint name="{name}_axis" type="revolute"><parent link="{parent}"/><child link="{name}"/>
            <origin xyz="0 0 {up}"/><axis xyz="{axis}"/><dynamics friction="{friction}"/>
            <limit lower="-3" upper="3" effort="300" velocity="3"/></joint>"#
        );
    }
    text + r#"<link name="flange"/><joint name="mount" type="fixed"><parent link="last"/><child link="flange"/>
        <origin xyz="0 0 0.08"/></joint></robot>"#
}

/// The arm on the plate edge, 120 mm of it.
fn five_axis_scenario(folder: &tempfile::TempDir, last: &str, friction: f64) -> Scenario {
    let file = folder.path().join("five.urdf");
    std::fs::write(&file, urdf(last, friction)).unwrap();
    let mut scenario = scenario("plate_edge_ideal");
    scenario.arm.urdf = file;
    scenario.arm.flange_link = "flange".into();
    (scenario.workpiece.edge.start, scenario.workpiece.edge.end) = (0.09, Some(0.21));
    scenario
}

/// Phase and torque that a scenario is refused for when an axis has this effort limit [N m].
fn refused_torque(mut scenario: Scenario, joint: &str, limit: f64) -> (&'static str, f64) {
    scenario.arm.limit_overrides = vec![LimitOverride {
        joint: joint.into(),
        effort: Some(limit),
        velocity: None,
    }];
    match Cell::new(scenario).err() {
        Some(CellError::Plan { source, .. }) => match *source {
            PlanError::Waypoint {
                phase,
                obstacle: Obstacle::Effort { axis, value, .. },
                ..
            } if axis == joint => (phase, value),
            other => panic!("{other}"),
        },
        other => panic!("{other:?}"),
    }
}

#[test]
fn five_axes_that_can_tilt_the_tool_follow_the_edge() {
    let folder = tempfile::tempdir().unwrap();
    let cell = Cell::new(five_axis_scenario(&folder, "1 0 0", 0.0))
        .unwrap_or_else(|error| panic!("{error}"));
    let distance = cell.setup.scenario.nominal.mounting.tool_centre
        + cell.setup.scenario.process.working_stroke;
    for i in 0..=50 {
        let reference = cell
            .plan
            .reference(cell.plan.duration() * f64::from(i) / 50.0);
        let flange = tip_pose(
            &cell.setup.arm.chain,
            DPose3::IDENTITY,
            &reference.position[..5],
        );
        let axis = flange.rotation * DVec3::Z;
        assert!(axis.distance(reference.axis) < 1e-6);
        assert!((flange.translation + axis * distance).distance(reference.centre) < 1e-6);
    }
    let summary = run(five_axis_scenario(&folder, "1 0 0", 0.0)).summary;
    assert!(summary.coefficient_of_variation_percent.unwrap() <= 1.0);
}

#[test]
fn five_axes_whose_last_only_spins_the_tool_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let error = Cell::new(five_axis_scenario(&folder, "0 0 1", 0.0))
        .err()
        .unwrap();
    println!("{error}");
    let CellError::Plan { source, .. } = &error else {
        panic!("{error}");
    };
    assert!(matches!(**source, PlanError::Waypoint { .. }), "{error}");
}

#[test]
fn contact_force_and_tool_friction_count_against_effort_limits() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = five_axis_scenario(&folder, "1 0 0", 0.0);
    let (force, friction) = (scenario.process.force, scenario.nominal.cell.friction);
    let (phase, torque) = refused_torque(scenario, "waist_axis", 15.0);
    // Gravity does not turn the waist. The ball starts at (x, y), pushed back along -x and held back along y, the tool going along -y.
    let lift = 0.005 - force / 150e3;
    let (x, y) = (0.75 - lift * 0.5f64.sqrt(), 0.06);
    let expected = force * (friction * x + 0.5f64.sqrt() * y);
    assert_eq!(phase, "follow");
    // The first look falls up to 4 ms after the start, when the arm already gathers speed.
    assert!(
        (torque.abs() - expected).abs() < 1e-2 * expected,
        "{torque} N m, expected {expected} N m"
    );
}

#[test]
fn joint_friction_counts_against_effort_limits() {
    let folder = tempfile::tempdir().unwrap();
    let start = Cell::new(five_axis_scenario(&folder, "1 0 0", 0.0))
        .unwrap_or_else(|error| panic!("{error}"))
        .plan
        .start();
    let torque = |friction: f64| {
        let mut scenario = five_axis_scenario(&folder, "1 0 0", friction);
        scenario.arm.seed_posture = Some(start.clone());
        refused_torque(scenario, "shoulder_axis", 10.0)
    };
    let ((phase, without), (_, with)) = (torque(0.0), torque(5.0));
    assert_eq!(phase, "approach");
    assert!(
        (with.abs() - without.abs() - 5.0).abs() < 1e-6,
        "{without} and {with} N m"
    );
}
