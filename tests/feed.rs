//! The feed along an edge that bends, by the closed form of an acceleration across the path.

use idc_cell::cell::Cell;
use idc_cell::path::{Phase, Reference};

use crate::common::scenario;

/// Time between two looks at a plan [s].
const STEP: f64 = 5e-3;

/// The references of a job while it follows the outline of the bracket, on arcs of 20 and 15 mm and round sharp corners.
fn followed(lateral_acceleration: f64) -> Vec<Reference> {
    let mut bracket = scenario("bracket_loop");
    bracket.process.lateral_acceleration = lateral_acceleration;
    let cell = Cell::new(bracket).unwrap();
    let count = (cell.plan.duration() / STEP) as usize;
    let all = (0..count).map(|i| cell.plan.reference(i as f64 * STEP));
    all.filter(|reference| reference.phase == Phase::Follow)
        .collect()
}

/// Accelerations across the path [m/s2], from the directions of travel.
fn across(references: &[Reference]) -> Vec<f64> {
    let pairs = references.windows(2);
    // At a corner the tool turns on the spot.
    let moving = pairs.filter(|pair| pair[1].edge_length > pair[0].edge_length + 1e-6);
    let turning = moving.map(|pair| {
        let turned = pair[0].tangent.angle_between(pair[1].tangent);
        0.5 * (pair[0].feed + pair[1].feed) * turned / STEP
    });
    turning.collect()
}

/// Length of edge that is passed at a feed to half a percent [m].
fn passed_at(references: &[Reference], feed: f64) -> f64 {
    let at_it = references
        .iter()
        .filter(|reference| (reference.feed / feed - 1.0).abs() < 5e-3);
    at_it.count() as f64 * STEP * feed
}

#[test]
fn an_arc_is_passed_at_the_root_of_acceleration_times_radius() {
    let acceleration = 0.01;
    let slowed = followed(acceleration);
    let across_it = across(&slowed);
    let most = across_it.iter().copied().fold(0.0, f64::max);
    assert!(
        most < 1.03 * acceleration && most > 0.97 * acceleration,
        "{most}"
    );
    // Three quarter arcs of 20 mm, one of 15 mm, less where the feed changes.
    for (radius, arcs) in [(0.020, 3.0), (0.015, 1.0)] {
        let feed = f64::sqrt(acceleration * radius);
        let length = passed_at(&slowed, feed);
        let arc = arcs * radius * std::f64::consts::FRAC_PI_2;
        assert!(
            (0.8..1.3).contains(&(length / arc)),
            "{radius} m: {length} of {arc}"
        );
        assert!(passed_at(&followed(f64::INFINITY), feed) < 0.05 * arc);
    }
    // What is straight is passed as asked for.
    assert!(passed_at(&slowed, 0.020) > 0.25);
}

#[test]
fn without_a_limit_the_plan_is_the_same_as_with_one_that_no_bend_reaches() {
    let [free, wide] = [f64::INFINITY, 1.0].map(followed);
    assert!(across(&free).iter().copied().fold(0.0, f64::max) > 0.025);
    let near = free
        .iter()
        .zip(&wide)
        .all(|(a, b)| (a.feed - b.feed).abs() < 1e-9);
    assert!(near && free.len() == wide.len());
}
