//! The plan's motion against the bodies that must not meet.

use super::error::{Obstacle, PlanError};
use super::poses::Coarse;
use super::request::{Leg, PlanRequest, waypoint_error};
use crate::arm::chain::MAX_JOINTS;
use crate::collision::{CollisionModel, JointMotion, Positions};

/// Whether widely spaced poses are free; what lies between them is for the whole motion to find.
pub(super) fn passable(request: &PlanRequest, coarse: &Coarse, angles: &[Vec<f64>]) -> bool {
    let free = |model: &CollisionModel| {
        let mut positions = coarse.positions(request, angles);
        positions.all(|there| model.meeting_at(&there).is_none())
    };
    request.collision.is_none_or(free)
}

/// The first widely spaced pose that is not free, and what is in its way, as deep as it gets.
pub(super) fn blockade(
    request: &PlanRequest,
    coarse: &Coarse,
    angles: &[Vec<f64>],
) -> Option<(usize, Obstacle)> {
    let model = request.collision?;
    let mut positions = coarse.positions(request, angles).enumerate();
    let (index, first) =
        positions.find_map(|(index, there)| Some((index, model.meeting_at(&there)?)))?;
    let same = positions.filter_map(|(_, there)| model.meeting_at(&there));
    let names = first.names.clone();
    let same = same.filter(|meeting| meeting.names == names);
    let deepest = same.fold(first, |deepest, meeting| {
        if meeting.depth > deepest.depth {
            meeting
        } else {
            deepest
        }
    });
    Some((index, Obstacle::Collision(Box::new(deepest))))
}

/// The motion over all legs, a knot for each of their knots; neighbouring legs share one.
pub(super) fn motion(request: &PlanRequest, legs: &[Leg]) -> JointMotion {
    let count = request.arm.len();
    let mut motion = JointMotion::default();
    for leg in legs {
        let knots = leg.spline.knots();
        let at = |index: usize| {
            let back = leg.way.backed_off(knots[index]);
            request.with_stroke(&leg.spline.values()[index], back)
        };
        if motion.is_empty() {
            motion.line_to(at(0));
        }
        for index in 1..knots.len() {
            let (from, to) = (at(index - 1), at(index));
            let slopes = [index - 1, index].map(|knot| {
                let (mut value, mut slope, mut bend) =
                    ([0.0; MAX_JOINTS], [0.0; MAX_JOINTS], [0.0; MAX_JOINTS]);
                leg.spline.at(
                    knots[knot],
                    &mut value[..count],
                    &mut slope[..count],
                    &mut bend[..count],
                );
                let mut change: Positions = [0.0; MAX_JOINTS];
                for (change, slope) in change.iter_mut().zip(slope).take(count) {
                    *change = slope * (knots[index] - knots[index - 1]);
                }
                change[count] = to[count] - from[count];
                change
            });
            motion.cubic_to(to, slopes);
        }
    }
    motion
}

/// Checks the whole motion.
pub(super) fn check(
    request: &PlanRequest,
    motion: &JointMotion,
    legs: &[Leg],
) -> Result<(), PlanError> {
    let Some(model) = request.collision else {
        return Ok(());
    };
    if model.is_free(motion) {
        return Ok(());
    }
    let Some(meeting) = model.first_meeting(motion) else {
        return Ok(());
    };
    let mut first = meeting.first.knot;
    let last = legs.len() - 1;
    for (index, leg) in legs.iter().enumerate() {
        let knots = leg.spline.knots();
        if first < knots.len() - 1 || index == last {
            let place = leg.way.place(knots[first], request.tool_path.length());
            return Err(waypoint_error(
                &request.tool_path,
                leg.phase,
                first,
                knots.len(),
                place,
                Obstacle::Collision(Box::new(meeting)),
            ));
        }
        first -= knots.len() - 1;
    }
    Ok(())
}
