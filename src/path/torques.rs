//! Torques that the drives need along the plan, and how far they are off where masses are.

use glamx::DPose3;

use super::reference::Reference;
use super::request::{Phase, PlanRequest};
use crate::arm::chain::{BodyInertia, KinematicChain, MAX_JOINTS};
use crate::arm::dynamics::inverse_dynamics;
use crate::arm::kinematics::{jacobian_at, link_poses};

/// The largest torque of a drive over the whole plan, with its range.
#[derive(Debug, Clone, PartialEq)]
pub struct TorqueRange {
    /// Joint.
    pub joint: String,
    /// Largest torque by the masses as they stand [N m].
    pub largest: f64,
    /// Least and greatest that it may be [N m].
    pub range: [f64; 2],
    /// The drive's limit [N m].
    pub limit: f64,
}

/// Torques at a time of the plan [N m], contact force and friction pressing while the tool is on the edge; joint losses included.
pub(super) fn needed(request: &PlanRequest, reference: &Reference) -> [f64; MAX_JOINTS] {
    let n = request.arm.len();
    let mut torque = of_bodies(request, request.arm_with_slide, reference);
    if reference.phase == Phase::Follow {
        let mut position = reference.position;
        position[n] = request.working_stroke;
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
        torque[joint] = moving + axis.friction.copysign(moving);
    }
    torque
}

/// Torques that weight and acceleration of a chain's bodies take at a time [N m].
fn of_bodies(
    request: &PlanRequest,
    chain: &KinematicChain,
    reference: &Reference,
) -> [f64; MAX_JOINTS] {
    let n = request.arm.len();
    let mut position = reference.position;
    position[n] = request.working_stroke;
    let mut torque = [0.0; MAX_JOINTS];
    inverse_dynamics(
        chain,
        request.world_from_base.rotation,
        request.gravity,
        &position[..=n],
        &reference.velocity[..=n],
        &reference.acceleration[..=n],
        &mut torque[..=n],
    );
    torque
}

/// Torques over a plan, at its references, if each of these bodies of the arm may be a share heavier or lighter, whatever the others are.
pub fn ranges(
    request: &PlanRequest,
    references: impl Iterator<Item = Reference>,
    uncertain: &[usize],
    share: f64,
) -> Vec<TorqueRange> {
    let alone: Vec<KinematicChain> = uncertain
        .iter()
        .map(|&body| {
            let mut chain = request.arm_with_slide.clone();
            for (index, joint) in chain.joints.iter_mut().enumerate() {
                if index != body {
                    joint.body = BodyInertia::ZERO;
                }
            }
            chain
        })
        .collect();
    let joint = |joint: &crate::arm::Joint| TorqueRange {
        joint: joint.name.clone(),
        largest: 0.0,
        range: [0.0; 2],
        limit: joint.effort,
    };
    let mut ranges: Vec<TorqueRange> = request.arm.joints.iter().map(joint).collect();
    for reference in references {
        let torques = needed(request, &reference);
        let parts: Vec<_> = alone
            .iter()
            .map(|chain| of_bodies(request, chain, &reference))
            .collect();
        for (joint, found) in ranges.iter_mut().enumerate() {
            let off: f64 = parts.iter().map(|part| share * part[joint].abs()).sum();
            let torque = torques[joint].abs();
            found.largest = found.largest.max(torque);
            let [least, greatest] = &mut found.range;
            *least = least.max(torque - off);
            *greatest = greatest.max(torque + off);
        }
    }
    ranges
}
