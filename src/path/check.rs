//! The plan against the arm's limits, before anything moves: singularities at every knot, speeds and torques over time.

use super::error::{Obstacle, PlanError};
use super::plan::Plan;
use super::posture::{SINGULAR_LIMIT, Standing};
use super::request::{PlanRequest, waypoint_error};
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
    let torques = torques::needed(request, plan, time);
    for (joint, axis) in request.arm.joints.iter().enumerate() {
        let needed = torques[joint];
        let obstacle = if reference.velocity[joint].abs() > axis.velocity {
            let value = reference.velocity[joint];
            Obstacle::Velocity {
                axis: axis.name.clone(),
                value,
                limit: axis.velocity,
            }
        } else if needed.abs() > axis.effort {
            Obstacle::Effort {
                axis: axis.name.clone(),
                value: needed,
                limit: axis.effort,
            }
        } else {
            continue;
        };
        let leg = plan
            .legs
            .iter()
            .rev()
            .find(|leg| leg.start_time <= time)
            .unwrap_or(&plan.legs[0]);
        let along = leg.profile.at(time - leg.start_time).position;
        let index = leg
            .spline
            .knots()
            .partition_point(|&knot| knot <= along)
            .saturating_sub(1);
        let place = leg.way.place(along, plan.tool_path.length());
        return Err(waypoint_error(
            &plan.tool_path,
            leg.phase,
            index,
            leg.spline.knots().len(),
            place,
            obstacle,
        ));
    }
    Ok(())
}
