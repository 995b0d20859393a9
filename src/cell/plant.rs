//! A cell's physics, the same that a diagnosis compares with recordings: what its scenario says, completed by its arm; what effects a running cell may have.

use super::error::CellError;
use crate::arm::chain::KinematicChain;
use crate::effects::PresentEffect;
use crate::plant::{Actual, Nominal, OwnLaw, PlantParameters};
use crate::scenario::{ArmScenario, Scenario};

/// Completes a description by what an arm's file and its scenario say of its joints.
pub fn complete(nominal: &mut Nominal<PlantParameters>, arm: &ArmScenario, chain: &KinematicChain) {
    let cell = &mut nominal.cell;
    cell.servo_bandwidth = arm.servo.lag_bandwidth;
    for (axis, joint) in chain.joints.iter().enumerate() {
        cell.joint_friction[axis] = joint.friction;
        let Some(drive) = arm.drives.iter().find(|drive| drive.joint == joint.name) else {
            continue;
        };
        cell.joint_stiffness[axis] = drive.stiffness;
        cell.joint_play[axis] = drive.backlash;
        if drive.stiffness.is_finite() {
            cell.joint_damping[axis] = drive.damping_time;
        }
        if let Some(friction) = drive.friction {
            cell.joint_friction[axis] = friction;
        }
    }
}

/// Refuses an effect that a running cell cannot have.
pub(super) fn check(
    scenario: &Scenario,
    chain: &KinematicChain,
    actual: &Actual<PlantParameters>,
) -> Result<(), CellError> {
    let refuse = |present: &PresentEffect, reason: &str| CellError::Effect {
        file: scenario.path.clone(),
        key: present.key.clone(),
        reason: format!("{}: {reason}", present.effect.vocabulary().0),
    };
    let joints = chain.joints.len();
    for present in &scenario.effects {
        let is_delay = present.effect.name == "channel_time_offset";
        match present.effect.vocabulary() {
            (_, Some(joint)) if joint > joints => {
                return Err(refuse(present, &format!("the arm has {joints} joints")));
            }
            ("joint_backlash", Some(joint))
                if actual.cell.joint_stiffness[joint - 1].is_infinite() =>
            {
                let reason = "its teeth_stiffness_n_m_per_rad must be finite";
                return Err(refuse(present, reason));
            }
            _ if is_delay && actual.sensors.force_delay < 0.0 => {
                let reason = "its offset_s is negative, and a cell that runs reads no force before it is there";
                return Err(refuse(present, reason));
            }
            _ => {}
        }
        let of_surface =
            |law: &OwnLaw| Some(&law.text) == present.law.as_ref() && law.uses_surface();
        if actual.own.iter().any(of_surface) {
            let reason = "its expression has x_s, and in a running cell the tool does not know where the surface is before it touches";
            return Err(refuse(present, reason));
        }
    }
    Ok(())
}
