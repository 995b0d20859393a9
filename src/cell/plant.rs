//! A cell's physics as one description, the same that a diagnosis compares with recordings: what its scenario says, and the effects put in.

use super::error::CellError;
use crate::arm::chain::KinematicChain;
use crate::effects::PresentEffect;
use crate::physics::joint_spring::JointSpring;
use crate::plant::{CellParameters, OwnLaw, Periodic, PlantParameters};
use crate::scenario::Scenario;

/// The description of a cell whose arm is `chain`.
///
/// # Errors
/// An effect that a running cell cannot have.
pub(super) fn of(
    scenario: &Scenario,
    chain: &KinematicChain,
) -> Result<PlantParameters, CellError> {
    let contact = &scenario.contact;
    let mut cell = CellParameters {
        servo_bandwidth: scenario.arm.servo.lag_bandwidth,
        friction: contact.friction,
        ..CellParameters::RIGID
    };
    for (axis, joint) in chain.joints.iter().enumerate() {
        cell.joint_friction[axis] = joint.friction;
        let mut drives = scenario.arm.drives.iter();
        if let Some(drive) = drives.find(|drive| drive.joint == joint.name) {
            cell.joint_stiffness[axis] = drive.stiffness;
            cell.joint_play[axis] = drive.backlash;
            if let Some(friction) = drive.friction {
                cell.joint_friction[axis] = friction;
            }
        }
    }
    let law = (contact.stiffness, contact.damping);
    let mut plant = PlantParameters::of_cell(scenario.device.parameters.clone(), law, cell);
    plant.contact.spindle_frequency = contact.spindle_frequency;
    // A ball that turns towards the part finds its surface nearer.
    plant.contact.runout = Periodic {
        sine: -contact.runout_amplitude,
        cosine: 0.0,
        frequency: contact.runout_frequency,
        ..Periodic::NONE
    };
    for effect in &scenario.effects {
        effect.put_into(&mut plant);
    }
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
                if plant.cell.joint_stiffness[joint - 1].is_infinite() =>
            {
                let reason = "its teeth_stiffness_n_m_per_rad must be finite";
                return Err(refuse(present, reason));
            }
            _ if is_delay && plant.sensors.force_delay < 0.0 => {
                let reason = "its offset_s is negative, and a cell that runs reads no force before it is there";
                return Err(refuse(present, reason));
            }
            _ => {}
        }
        let of_surface =
            |law: &OwnLaw| Some(&law.text) == present.law.as_ref() && law.uses_surface();
        if plant.own.iter().any(of_surface) {
            let reason = "its expression has x_s, and in a running cell the tool does not know where the surface is before it touches";
            return Err(refuse(present, reason));
        }
    }
    Ok(plant)
}

/// Transmission between motor and link of each joint; none where they are one.
pub(super) fn transmissions(
    scenario: &Scenario,
    chain: &KinematicChain,
    cell: &CellParameters,
) -> Vec<Option<JointSpring>> {
    let joints = chain.joints.iter().enumerate();
    let between = joints.map(|(axis, joint)| {
        let stiffness = cell.joint_stiffness[axis];
        let mut drives = scenario.arm.drives.iter();
        let drive = drives.find(|drive| drive.joint == joint.name && drive.stiffness.is_finite());
        stiffness.is_finite().then(|| JointSpring {
            stiffness,
            damping_time: drive.map_or(cell.joint_damping, |drive| drive.damping_time),
            play: cell.joint_play[axis],
        })
    });
    between.collect()
}
