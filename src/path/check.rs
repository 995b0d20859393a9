//! The plan against the arm's limits, before anything moves: singularities at every knot, speeds and torques over time.

use glamx::DPose3;

use super::error::{Obstacle, PlanError};
use super::plan::Plan;
use super::posture::{SINGULAR_LIMIT, Standing};
use super::request::{Phase, PlanRequest, waypoint_error};
use crate::arm::chain::MAX_JOINTS;
use crate::arm::dynamics::inverse_dynamics;
use crate::arm::kinematics::{jacobian_at, link_poses};

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

/// Speeds and torques at a time, contact force and friction pressing while the tool is on the edge; joint losses included.
fn drives(request: &PlanRequest, plan: &Plan, time: f64) -> Result<(), PlanError> {
    let reference = plan.reference(time);
    let n = request.arm.len();
    let mut position = reference.position;
    position[n] = request.working_stroke;
    let mut torque = [0.0; MAX_JOINTS];
    inverse_dynamics(
        request.arm_with_slide,
        request.world_from_base.rotation,
        request.gravity,
        &position[..=n],
        &reference.velocity[..=n],
        &reference.acceleration[..=n],
        &mut torque[..=n],
    );
    if reference.phase == Phase::Follow {
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        link_poses(
            request.arm_with_slide,
            request.world_from_base,
            &position[..=n],
            &mut links[..=n],
        );
        let jacobian = jacobian_at(request.arm_with_slide, &links[..=n], reference.centre);
        let force = request
            .force_on_tool(reference.normal, reference.tangent)
            .to_array();
        for (joint, torque) in torque.iter_mut().enumerate().take(n) {
            *torque -= (0..3)
                .map(|row| jacobian[(row, joint)] * force[row])
                .sum::<f64>();
        }
    }
    for (joint, axis) in request.arm.joints.iter().enumerate() {
        // A joint's dry friction may load its drive either way, also at rest.
        let moving = torque[joint] + axis.damping * reference.velocity[joint];
        let needed = moving + axis.friction.copysign(moving);
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
