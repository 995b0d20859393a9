//! A cell's physics as one description, the same that a diagnosis compares with recordings: what its scenario says, and the effects put in.

use super::error::CellError;
use crate::arm::chain::Chain;
use crate::control::transmission::TransmissionParameters;
use crate::plant::{CellParameters, Periodic, PlantParameters};
use crate::scenario::Scenario;
use crate::scenario::recorded_cell::apply;

/// The description of a cell whose arm is `chain`.
///
/// # Errors
/// An effect that a running cell cannot have.
pub(super) fn of(scenario: &Scenario, chain: &Chain) -> Result<PlantParameters, CellError> {
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
    // A ball that turns towards the part finds its surface nearer.
    plant.contact.runout = Periodic {
        sine: -contact.runout_amplitude,
        cosine: 0.0,
        frequency: contact.runout_frequency,
    };
    apply(&scenario.effects, &mut plant);
    let refuse = |effect: &str, reason: String| CellError::Effect {
        file: scenario.path.clone(),
        effect: effect.to_owned(),
        reason,
    };
    let joints = chain.joints.len();
    for (effect, _) in &scenario.effects {
        match effect.vocabulary() {
            (_, Some(joint)) if joint > joints => {
                return Err(refuse(effect.name, format!("the arm has {joints} joints")));
            }
            ("joint_backlash", Some(joint))
                if plant.cell.joint_stiffness[joint - 1].is_infinite() =>
            {
                let reason = "its teeth_stiffness_n_m_per_rad must be finite";
                return Err(refuse(effect.name, reason.to_owned()));
            }
            _ => {}
        }
    }
    if plant.sensors.force_delay < 0.0 {
        let reason =
            "its offset_s is negative, and a cell that runs reads no force before it is there";
        return Err(refuse("channel_time_offset", reason.to_owned()));
    }
    Ok(plant)
}

/// What stands between motor and link of each joint; none where they are one.
pub(super) fn transmissions(
    scenario: &Scenario,
    chain: &Chain,
    cell: &CellParameters,
) -> Vec<Option<TransmissionParameters>> {
    let joints = chain.joints.iter().enumerate();
    let between = joints.map(|(axis, joint)| {
        let stiffness = cell.joint_stiffness[axis];
        let mut drives = scenario.arm.drives.iter();
        let drive = drives.find(|drive| drive.joint == joint.name && drive.stiffness.is_finite());
        stiffness.is_finite().then(|| TransmissionParameters {
            stiffness,
            damping_time: drive.map_or(cell.joint_damping, |drive| drive.damping_time),
            play: cell.joint_play[axis],
        })
    });
    between.collect()
}
