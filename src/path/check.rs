//! The plan against the arm's limits, before anything moves: singularities at every knot, speeds and torques over time.

use super::error::{Obstacle, PlanError};
use super::plan::Plan;
use super::posture::{SINGULAR_LIMIT, Standing};
use super::request::{Leg, PlanRequest, waypoint_error};
use super::torques;

/// Interval at which speeds and torques are checked [s].
const INTERVAL: f64 = 4e-3;

/// Checks the whole plan.
pub(super) fn limits(
    request: &PlanRequest,
    standing: &Standing,
    plan: &Plan,
) -> Result<(), PlanError> {
    singularities(standing, plan)?;
    let count = (plan.duration() / INTERVAL).ceil() as usize;
    for i in 0..=count {
        drives(request, plan, i as f64 * INTERVAL)?;
    }
    Ok(())
}

fn singularities(standing: &Standing, plan: &Plan) -> Result<(), PlanError> {
    for leg in &plan.legs {
        let angles = leg.spline.values();
        for (index, q) in angles.iter().enumerate() {
            let value = standing.singularity(q);
            if value < SINGULAR_LIMIT {
                let axis = standing.weakest_axis(q);
                let obstacle = Obstacle::Singular {
                    value,
                    limit: SINGULAR_LIMIT,
                    axis,
                };
                let along = leg.spline.knots()[index];
                let place = leg.way.place(along, plan.tool_path.length());
                return Err(waypoint_error(
                    &plan.tool_path,
                    leg.phase,
                    index,
                    angles.len(),
                    place,
                    obstacle,
                ));
            }
        }
    }
    Ok(())
}

/// Speeds and torques at a time.
fn drives(request: &PlanRequest, plan: &Plan, time: f64) -> Result<(), PlanError> {
    let reference = plan.reference(time);
    let torques = torques::needed(request, &reference);
    for (joint, axis) in request.arm.joints.iter().enumerate() {
        if reference.velocity[joint].abs() > axis.velocity {
            return Err(too_fast(request, plan, time));
        }
        let needed = torques[joint];
        if needed.abs() > axis.effort {
            let obstacle = Obstacle::Effort {
                axis: axis.name.clone(),
                value: needed,
                limit: axis.effort,
            };
            return Err(at_time(plan, time, obstacle));
        }
    }
    Ok(())
}

/// The leg that runs at a time.
fn leg_at(plan: &Plan, time: f64) -> &Leg {
    let mut legs = plan.legs.iter().rev();
    let leg = legs.find(|leg| leg.start_time <= time);
    leg.unwrap_or(&plan.legs[0])
}

/// An obstacle at a time, told by its waypoint.
fn at_time(plan: &Plan, time: f64, obstacle: Obstacle) -> PlanError {
    let leg = leg_at(plan, time);
    let along = leg.profile.at(time - leg.start_time).position;
    let index = leg
        .spline
        .knots()
        .partition_point(|&knot| knot <= along)
        .saturating_sub(1);
    let place = leg.way.place(along, plan.tool_path.length());
    waypoint_error(
        &plan.tool_path,
        leg.phase,
        index,
        leg.spline.knots().len(),
        place,
        obstacle,
    )
}

/// The axis that is most too fast in the leg in which one is, from a time on: the speed that is told is the one that must come down.
fn too_fast(request: &PlanRequest, plan: &Plan, from: f64) -> PlanError {
    let leg = leg_at(plan, from);
    let end = leg.start_time + leg.duration;
    let mut worst = (0.0, from, 0);
    let count = ((end - from) / INTERVAL).ceil().max(1.0) as usize;
    for step in 0..=count {
        let time = (from + step as f64 * INTERVAL).min(end - 1e-9).max(from);
        let velocity = plan.reference(time).velocity;
        for (joint, axis) in request.arm.joints.iter().enumerate() {
            let share = velocity[joint].abs() / axis.velocity;
            if share > worst.0 {
                worst = (share, time, joint);
            }
        }
    }
    let (_, time, joint) = worst;
    let axis = &request.arm.joints[joint];
    let obstacle = Obstacle::Velocity {
        axis: axis.name.clone(),
        value: plan.reference(time).velocity[joint],
        limit: axis.velocity,
    };
    at_time(plan, time, obstacle)
}
