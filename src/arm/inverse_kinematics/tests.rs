use super::*;
use crate::arm::kinematics::tip_pose;
use crate::arm::test_chains::{arm10, random_positions, seven_axes};
use glam::{DQuat, DVec3};
use std::f64::consts::PI;

const HERE: DPose3 = DPose3::IDENTITY;

/// Distance [m] and angle [rad] between two poses, by other means than the solver's.
fn apart(a: &DPose3, b: &DPose3) -> (f64, f64) {
    let turn = a.rotation.inverse() * b.rotation;
    let imaginary = DVec3::new(turn.x, turn.y, turn.z);
    (
        (a.translation - b.translation).length(),
        2.0 * imaginary.length().asin(),
    )
}

fn spread(seed: u64, count: usize, width: f64) -> Vec<f64> {
    random_positions(seed, count)
        .iter()
        .map(|x| x * width)
        .collect()
}

#[test]
fn a_start_near_the_answer_leads_to_it_at_once() {
    for chain in [arm10(), seven_axes()] {
        for seed in 0..100 {
            // Elbow and wrist bent: away from singular postures.
            let mut q = spread(seed, chain.len(), 0.6);
            q[2] += 1.2;
            q[3] -= 1.3;
            q[4] += 1.3;
            q[5] += 1.2;
            let base = DPose3::from_parts(DVec3::new(1.0, 2.0, 0.5), DQuat::from_rotation_z(0.7));
            let target = tip_pose(&chain, base, &q);
            let nudge = spread(seed + 500, chain.len(), 0.05);
            let start: Vec<_> = q.iter().zip(&nudge).map(|(q, n)| q + n).collect();
            let solution = solve(&chain, base, &target, &start, &IkOptions::default());
            let solution = solution.expect("the answer is near");
            let (distance, angle) = apart(&tip_pose(&chain, base, &solution.q), &target);
            assert!(
                distance < 1.1e-9 && angle < 1.1e-9,
                "{distance} m, {angle} rad"
            );
            assert_eq!(solution.random_starts_used, 0);
            assert!(solution.iterations <= 8, "{} steps", solution.iterations);
            if chain.len() == 6 {
                let mut pairs = solution.q.iter().zip(&q);
                assert!(pairs.all(|(found, planted)| (found - planted).abs() < 1e-6));
            }
        }
    }
}

#[test]
fn random_starts_find_what_a_far_start_misses() {
    for chain in [arm10(), seven_axes()] {
        let mut restarts = 0;
        for seed in 0..100 {
            let q = spread(seed, chain.len(), 2.0);
            let target = tip_pose(&chain, HERE, &q);
            let start = spread(seed + 900, chain.len(), 2.0);
            let options = IkOptions::default();
            let solution = solve(&chain, HERE, &target, &start, &options).expect("reachable");
            let (distance, angle) = apart(&tip_pose(&chain, HERE, &solution.q), &target);
            assert!(distance < 1.1e-9 && angle < 1.1e-9);
            restarts += solution.random_starts_used;
            for (joint, position) in chain.joints.iter().zip(&solution.q) {
                assert!((joint.lower..=joint.upper).contains(position));
            }
            let again = solve(&chain, HERE, &target, &start, &options);
            assert_eq!(again.expect("as before"), solution);
        }
        println!("{} axes: {restarts} restarts for 100 poses", chain.len());
    }
}

#[test]
fn turning_about_the_tip_is_free_if_asked_for() {
    let options = IkOptions {
        orientation: TipOrientation::FreeAboutZ,
        ..IkOptions::default()
    };
    let mut chain = arm10();
    let q = [0.3, -1.2, 1.4, -1.7, 1.3, 0.8];
    let target = tip_pose(&chain, HERE, &q);
    // With the last axis frozen the full pose is out of reach, the symmetric one is not.
    (chain.joints[5].lower, chain.joints[5].upper) = (-0.01, 0.01);
    let full = solve(&chain, HERE, &target, &q, &IkOptions::default());
    assert_eq!(
        full.expect_err("frozen").axis.expect("named").name,
        "wrist_3"
    );
    let solution = solve(&chain, HERE, &target, &q, &options).expect("symmetric tool");
    let reached = tip_pose(&chain, HERE, &solution.q);
    assert!((reached.translation - target.translation).length() < 1.1e-9);
    let (here, there) = (reached.rotation * DVec3::Z, target.rotation * DVec3::Z);
    assert!(here.cross(there).length() < 1.1e-9 && here.dot(there) > 0.0);
    assert!(apart(&reached, &target).1 > 0.1);
}

#[test]
fn the_obstructing_axis_is_named() {
    let mut chain = arm10();
    let q = [0.3, -1.2, 2.2, -1.7, 1.3, 0.8];
    let target = tip_pose(&chain, HERE, &q);
    (chain.joints[2].lower, chain.joints[2].upper) = (-0.5, 0.5);
    let failure = solve(&chain, HERE, &target, &q, &IkOptions::default()).expect_err("too bent");
    assert!(failure.reachable_without_limits && failure.position_error > 1e-3);
    let axis = failure.axis.expect("named");
    assert_eq!((axis.joint, axis.name.as_str()), (2, "elbow"));
    assert!(axis.position.abs() > 0.5 && axis.limit.abs() == 0.5);
    assert!(
        axis.position * axis.limit > 0.0,
        "the limit on the side it is over"
    );
}

#[test]
fn a_pose_out_of_reach_is_distinguished_from_a_limit() {
    let chain = arm10();
    let target = DPose3::from_translation(DVec3::new(3.0, 0.0, 0.5));
    let start = [0.1, -1.2, 1.4, -1.7, 1.3, 0.8];
    let failure = solve(&chain, HERE, &target, &start, &IkOptions::default());
    let failure = failure.expect_err("3 m away");
    assert!(!failure.reachable_without_limits);
    assert!(failure.position_error > 3.0 - chain.reach() - 0.2);
    let nowhere = DPose3::from_translation(DVec3::NAN);
    assert!(solve(&chain, HERE, &nowhere, &start, &IkOptions::default()).is_err());
}

#[test]
fn a_limit_a_whole_turn_away_is_no_obstacle() {
    let mut chain = arm10();
    let q = [0.3, -1.2, 1.4, -1.7, 1.3, 0.8];
    let target = tip_pose(&chain, HERE, &q);
    (chain.joints[5].lower, chain.joints[5].upper) = (0.8 + 1.5 * PI, 0.8 + 2.5 * PI);
    let solution = solve(&chain, HERE, &target, &q, &IkOptions::default()).expect("a turn on");
    let reached = tip_pose(&chain, HERE, &solution.q);
    assert!(apart(&reached, &target).0 < 1.1e-9);
    assert!(solution.q[5] > chain.joints[5].lower && solution.q[5] < chain.joints[5].upper);
}

#[test]
fn an_answer_behind_a_limit_is_found_a_turn_on() {
    // The shorter way from the start is down through the lower limit; a turn on, the answer is allowed.
    let mut chain = arm10();
    let q = [0.3, -1.2, 1.4, -1.7, 1.3, 0.8];
    let target = tip_pose(&chain, HERE, &q);
    (chain.joints[5].lower, chain.joints[5].upper) = (0.8 + PI - 0.2, 0.8 + 2.0 * PI + 0.1);
    // No other posture of shoulder or wrist.
    (chain.joints[0].lower, chain.joints[0].upper) = (-0.5, 1.0);
    (chain.joints[4].lower, chain.joints[4].upper) = (0.1, 2.5);
    let options = IkOptions {
        random_starts: 0,
        ..IkOptions::default()
    };
    let solution = solve(&chain, HERE, &target, &q, &options).expect("a turn on");
    assert!((solution.q[5] - 0.8 - 2.0 * PI).abs() < 1e-6);
    assert_eq!(solution.random_starts_used, 1);
}

#[test]
fn spare_freedom_drifts_towards_mid_range() {
    let chain = seven_axes();
    let mut q = vec![0.2, 0.7, 1.5, -1.4, -1.2, 0.9, 1.3];
    let start = tip_pose(&chain, HERE, &q);
    let off_middle = |q: &[f64]| -> f64 {
        let joints = chain.joints.iter().zip(q);
        joints.map(|(joint, q)| (q / joint.upper).powi(2)).sum()
    };
    let before = off_middle(&q);
    for step in 1..=400 {
        // Back and forth over 50 mm, ending where it began.
        let along = 0.05 * (PI * f64::from(step) / 50.0).sin();
        let mut target = start;
        target.translation.y += along;
        q = solve(&chain, HERE, &target, &q, &IkOptions::default())
            .expect("near")
            .q;
    }
    assert!(apart(&tip_pose(&chain, HERE, &q), &start).0 < 1.1e-9);
    assert!(
        off_middle(&q) < 0.9 * before,
        "{before} to {}",
        off_middle(&q)
    );
}

#[test]
fn a_six_axis_arm_has_its_eight_postures() {
    // Elbow, shoulder and wrist flips, within one turn of each axis.
    let mut chain = arm10();
    for joint in &mut chain.joints {
        (joint.lower, joint.upper) = (-PI, PI);
    }
    let q = [0.3, -1.2, 1.4, -1.7, 1.3, 0.8];
    let target = tip_pose(&chain, HERE, &q);
    let options = IkOptions::default();
    let found = distinct_solutions(&chain, HERE, &target, 300, &options);
    assert_eq!(found.len(), 8);
}
