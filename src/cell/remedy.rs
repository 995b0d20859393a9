//! The search for what would make a refused job possible: where the part would have to lie, how the tool would have to stand.

use glam::DVec3;
use glamx::DPose3;
use rayon::prelude::*;

use super::advice::Advice;
use super::setup::{Setup, Stance};
use crate::path::{Obstacle, Plan, PlanError, ToolAxis};

/// Distances by which the part is moved, the shortest first [mm].
const DISTANCES: [f64; 20] = [
    1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 350.0, 500.0,
    700.0, 1000.0, 1400.0, 2000.0, 3000.0,
];
/// Changes of the tool's lean, the smallest first [deg].
const LEANS: [f64; 8] = [10.0, -10.0, 20.0, -20.0, 30.0, -30.0, 45.0, -45.0];
/// Largest lean of a scenario [rad].
const MOST_LEAN: f64 = std::f64::consts::FRAC_PI_3;

/// For a job that cannot be planned.
pub(super) fn for_plan(setup: &Setup, error: &PlanError) -> Advice {
    let PlanError::Waypoint { obstacle, .. } = error else {
        return Advice::default();
    };
    // A feed that is too fast wants another feed.
    if matches!(obstacle, Obstacle::Velocity { .. }) {
        return Advice::default();
    }
    let stance = setup.stance();
    let part = moved_part(setup, &stance);
    let lean = leaned(setup, &stance);
    let roll = stance.roll.and_then(|_| rolled(setup, &stance));
    Advice {
        nothing: part.is_none() && lean.is_none() && roll.is_none(),
        part,
        lean,
        roll,
    }
}

/// For a part that stands in something.
pub(super) fn for_standing(setup: &Setup) -> Advice {
    let part = moved_part(setup, &setup.stance());
    Advice {
        nothing: part.is_none(),
        part,
        ..Advice::default()
    }
}

/// The shortest way found of the part at the end of which the job can be done, and the part's position there.
fn moved_part(setup: &Setup, stance: &Stance) -> Option<(DVec3, DVec3)> {
    let directions = directions(setup, stance);
    let mut shorter = 0.0;
    for distance in DISTANCES {
        let found = directions.par_iter().find_map_first(|&direction| {
            let moved = moved(stance, direction, distance);
            setup.outline(&moved).is_ok().then_some(direction)
        });
        if let Some(direction) = found {
            let way = shortest(setup, stance, direction, [shorter, distance]);
            if setup.is_possible(&moved(stance, direction, way)) {
                let there = moved(stance, direction, way).world_from_part.translation;
                return Some((there - stance.world_from_part.translation, there));
            }
        }
        shorter = distance;
    }
    None
}

/// Ways that are tried: straight up and down, along the world's axes, to and from the robot's base.
fn directions(setup: &Setup, stance: &Stance) -> Vec<DVec3> {
    let base = setup.scenario.arm.world_from_base.translation;
    let middle = setup.part.edge.at(0.5 * setup.part.edge.length).point;
    let to_base = base - stance.world_from_part.transform_point(middle);
    let level = DVec3::new(to_base.x, to_base.y, 0.0).normalize_or_zero();
    let mut directions = vec![level, -level, DVec3::Z, -DVec3::Z];
    for axis in [DVec3::X, DVec3::Y] {
        for direction in [axis, -axis] {
            if directions.iter().all(|other| other.dot(direction) < 0.99) {
                directions.push(direction);
            }
        }
    }
    directions.retain(|direction| *direction != DVec3::ZERO);
    directions
}

/// The stance with the part a distance [mm] along a direction; its position to a tenth of a millimetre, so that what is told is what was tried.
fn moved(stance: &Stance, direction: DVec3, distance: f64) -> Stance {
    let place = stance.world_from_part.translation + 1e-3 * distance * direction;
    let rounded = (place * 1e4).round() / 1e4;
    Stance {
        world_from_part: DPose3::from_parts(rounded, stance.world_from_part.rotation),
        ..*stance
    }
}

/// The shortest distance [mm], whole or to a tenth below 10, between one at which it cannot and one at which it can be done.
fn shortest(setup: &Setup, stance: &Stance, direction: DVec3, [no, yes]: [f64; 2]) -> f64 {
    const STEPS: usize = 4;
    let (mut no, mut yes) = (no, yes);
    for _ in 0..STEPS {
        let middle = 0.5 * (no + yes);
        let middle = if middle < 10.0 {
            (middle * 10.0).round() / 10.0
        } else {
            middle.round()
        };
        if middle <= no || middle >= yes {
            break;
        }
        if setup.outline(&moved(stance, direction, middle)).is_ok() {
            yes = middle;
        } else {
            no = middle;
        }
    }
    yes
}

/// A lean near the scenario's at which the job can be done.
fn leaned(setup: &Setup, stance: &Stance) -> Option<f64> {
    let ToolAxis::Lean(lean) = stance.tool_axis else {
        return None;
    };
    // In whole degrees, as they are told.
    let leans = LEANS.map(|change| (lean.to_degrees() + change).round().to_radians());
    leans.into_par_iter().find_first(|&lean| {
        let leaned = Stance {
            tool_axis: ToolAxis::Lean(lean),
            ..*stance
        };
        lean.abs() <= MOST_LEAN && setup.is_possible(&leaned)
    })
}

/// A roll, in place of the one that is given, at which the job can be done.
fn rolled(setup: &Setup, stance: &Stance) -> Option<f64> {
    let free = Stance {
        roll: None,
        ..*stance
    };
    let tool_path = setup.tool_path(&free).ok()?;
    let plan = Plan::new(&setup.request(&free, &setup.collision, tool_path)).ok()?;
    Some(plan.roll)
}
