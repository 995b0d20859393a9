//! Drives and what hangs on them: lag along the path, limits, the housing's mass, the payload; and results that do not depend on the step.

use std::f64::consts::TAU;

use glam::DVec3;
use glamx::DPose3;
use idc_cell::arm::chain::MAX_JOINTS;
use idc_cell::arm::dynamics::inverse_dynamics;
use idc_cell::arm::kinematics::link_poses;
use idc_cell::cell::{Cell, CellError};
use idc_cell::plant::ContactLaw;
use idc_cell::recording::schema::{self, JointSignal, joint_quantity};
use idc_cell::run::{FinishedCell, run_cell};
use idc_cell::scenario::{LimitOverride, Scenario};

use crate::common::{run, scenario};

/// The first centimetres of the plate's edge under the ideal device, with hardly a dwell.
fn short() -> Scenario {
    let mut short = scenario("plate_edge_ideal");
    short.workpiece.edge.end = Some(short.workpiece.edge.start + 0.03);
    short.process.settle_time = 0.1;
    short.expect.clear();
    short
}

/// Lag and lateral error in the middle of following [m].
fn in_the_middle(finished: &FinishedCell) -> (f64, f64) {
    let recording = &finished.recording;
    let span = recording.phase("follow").unwrap();
    let middle = 0.5 * (span.start + span.end);
    let at = recording.time().partition_point(|time| *time < middle);
    let value = |quantity| recording.channel(quantity).unwrap().values[at];
    (value(schema::PATH_LAG), value(schema::PATH_ERROR))
}

#[test]
fn drives_that_lag_make_a_lag_along_the_path_and_no_lateral_error() {
    // A critically damped second-order lag trails a ramp by twice its time constant.
    for (bandwidth, feed) in [(10.0, 0.02), (25.0, 0.04)] {
        let mut lagging = short();
        lagging.process.feed = feed;
        lagging.process.corner_feed = feed;
        lagging.process.acceleration = 5.0;
        lagging.process.jerk = 100.0;
        lagging.arm.servo.lag_bandwidth = bandwidth;
        let finished = run(lagging);
        let (lag, lateral) = in_the_middle(&finished);
        let expected = 2.0 * feed / (TAU * bandwidth);
        assert!((lag - expected).abs() < 0.01 * expected, "{lag} {expected}");
        assert!(lateral.abs() < 0.03 * expected, "{lateral} beside {lag}");
        let most = finished.summary.path_lag_max_um.unwrap();
        assert!(
            most > 1e6 * 0.99 * expected && most < 1e6 * 1.2 * expected,
            "{most}"
        );
    }
    let (lag, lateral) = in_the_middle(&run(short()));
    assert!(lag.abs() < 2e-5 && lateral.abs() < 2e-5, "{lag} {lateral}");
}

/// Largest torque of a joint from 1 [N m].
fn largest_torque(finished: &FinishedCell, joint: usize) -> f64 {
    let quantity = joint_quantity(joint, JointSignal::Torque);
    let torques = &finished.recording.channel(&quantity).unwrap().values;
    torques
        .iter()
        .fold(0.0, |most: f64, torque| most.max(torque.abs()))
}

#[test]
fn no_drive_gives_more_than_its_limit_and_a_run_at_it_says_so() {
    let free = run(short());
    let cell = Cell::new(short()).unwrap();
    let names: Vec<String> = cell
        .setup
        .arm
        .chain
        .joints
        .iter()
        .map(|j| j.name.clone())
        .collect();
    assert_eq!(free.summary.drives_saturated_s, Some(0.0));
    let mut cut = 0;
    for (joint, name) in names.iter().enumerate().take(3) {
        let needed = largest_torque(&free, joint + 1);
        for share in [0.999, 0.99, 0.97] {
            let mut limited = short();
            let effort = share * needed;
            limited.arm.limit_overrides.push(LimitOverride {
                joint: name.clone(),
                effort: Some(effort),
                velocity: None,
            });
            // The plan as such may need the torque.
            let Ok(cell) = Cell::new(limited) else {
                continue;
            };
            let finished = run_cell(&cell, &mut |_| ()).unwrap();
            let largest = largest_torque(&finished, joint + 1);
            assert!(largest <= effort);
            // A drive that is limited elsewhere has another arm to carry: it may stay just below.
            let reached = largest == effort;
            let summary = &finished.summary;
            assert_eq!(
                summary.drives_saturated_s.unwrap() > 0.0,
                reached,
                "{name} {share}"
            );
            assert_eq!(summary.joints[joint].saturated_from_s.is_some(), reached);
            cut += usize::from(reached);
        }
    }
    assert!(
        cut > 0,
        "no limit was below what a run takes and above what its plan does"
    );
}

#[test]
fn the_housing_hangs_on_the_flange_and_loads_every_joint_by_its_lever() {
    let torques = |housing: f64| {
        let mut loaded = short();
        loaded.nominal.mounting.housing_mass = housing;
        loaded.nominal.mounting.housing_centre_of_mass = 0.06;
        let cell = Cell::new(loaded).unwrap();
        let count = cell.setup.arm_with_slide.len();
        let mut position = cell.plan.reference(0.0).position;
        position[count - 1] = 0.02;
        let (still, mut torque) = ([0.0; MAX_JOINTS], [0.0; MAX_JOINTS]);
        let base = cell.setup.scenario.arm.world_from_base;
        let gravity = cell.setup.scenario.simulation.gravity;
        inverse_dynamics(
            &cell.setup.arm_with_slide,
            base.rotation,
            gravity,
            &position[..count],
            &still[..count],
            &still[..count],
            &mut torque[..count],
        );
        (cell, position, torque)
    };
    let (_, _, without) = torques(0.0);
    let (cell, position, with) = torques(2.5);
    let chain = &cell.setup.arm.chain;
    let mut links = [DPose3::IDENTITY; MAX_JOINTS];
    let base = cell.setup.scenario.arm.world_from_base;
    link_poses(
        chain,
        base,
        &position[..chain.len()],
        &mut links[..chain.len()],
    );
    let flange = links[chain.len() - 1] * chain.tip_from_last;
    let centre = flange.transform_point(DVec3::new(0.0, 0.0, 0.06));
    let weight = cell.setup.scenario.simulation.gravity * 2.5;
    for (joint, link) in links.iter().enumerate().take(chain.len()) {
        let axis = link.rotation * chain.joints[joint].axis;
        let expected = -axis.dot((centre - link.translation).cross(weight));
        let found = with[joint] - without[joint];
        assert!(
            (found - expected).abs() < 1e-9,
            "joint {joint}: {found} {expected}"
        );
    }
    assert!((with[1] - without[1]).abs() > 5.0);
}

#[test]
fn a_device_heavier_than_the_arm_may_carry_is_refused_and_one_as_heavy_is_not() {
    let with = |payload| {
        let mut scenario = short();
        scenario.nominal.mounting.housing_mass = 2.0;
        scenario.nominal.device.moving_mass = 4.0;
        scenario.arm.payload = Some(payload);
        Cell::new(scenario)
    };
    let Err(refused) = with(5.9) else {
        panic!("5.9 kg carried 6 kg");
    };
    assert!(matches!(refused, CellError::Payload { .. }));
    let reported = refused.to_string();
    for part in [
        "carries 6 kg",
        "2 kg of housing",
        "4 kg of slide",
        "at most 5.9 kg (arm.payload_kg)",
    ] {
        assert!(reported.contains(part), "{part}: {reported}");
    }
    assert!(with(6.0).is_ok());
}

/// Largest force at the touch [N].
fn peak(stiffness: f64, step: f64) -> f64 {
    let mut stiff = short();
    stiff.nominal.contact.law = ContactLaw::Linear { stiffness };
    stiff.workpiece.edge.end = Some(stiff.workpiece.edge.start + 2e-3);
    stiff.process.settle_time = 0.02;
    stiff.simulation.step = step;
    run(stiff).summary.engagement_peak_n.unwrap()
}

#[test]
fn the_peak_at_the_touch_does_not_depend_on_the_step() {
    for stiffness in [2e5, 2e6, 1e8] {
        let fine = peak(stiffness, 1e-4);
        for step in [1e-3, 1e-2] {
            let found = peak(stiffness, step);
            assert!(
                (found / fine - 1.0).abs() < 0.05,
                "{stiffness} N/m, {step} s: {found} {fine}"
            );
        }
    }
}

#[test]
fn a_contact_that_no_step_follows_is_refused_with_what_would_do() {
    let mut hard = short();
    hard.nominal.device.moving_mass = 0.05;
    hard.nominal.contact.damping = 1e6;
    let Err(refused) = Cell::new(hard.clone()) else {
        panic!("a contact of 20 MHz was taken");
    };
    let CellError::Unresolved { most_damping, .. } = refused else {
        panic!("{refused}");
    };
    hard.nominal.contact.damping = 0.99 * most_damping;
    let taken = Cell::new(hard);
    assert!(!matches!(taken, Err(CellError::Unresolved { .. })));
}
