//! A cell's physics as one description, the same that a diagnosis compares with recordings: what its scenario says, and the effects put in.

use crate::arm::chain::Chain;
use crate::control::transmission::TransmissionParameters;
use crate::plant::{
    CellParameters, Chain as DeviceChain, ContactLaw, ContactParameters, LinkParameters, Periodic,
    PlantParameters, SensorErrors,
};
use crate::scenario::Scenario;

/// The description of a cell whose arm is `chain`.
pub(super) fn of(scenario: &Scenario, chain: &Chain) -> PlantParameters {
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
    PlantParameters {
        chain: DeviceChain::Whole,
        links: LinkParameters::NONE,
        device: scenario.device.parameters.clone(),
        // The arm says it, step by step.
        gravity_along_extension: 0.0,
        contact: ContactParameters {
            law: ContactLaw::Linear {
                stiffness: contact.stiffness,
            },
            damping: contact.damping,
            surface_offset: 0.0,
            // A ball that turns towards the part finds its surface nearer.
            runout: Periodic {
                sine: -contact.runout_amplitude,
                cosine: 0.0,
                frequency: contact.runout_frequency,
            },
            waviness: Periodic::NONE,
        },
        cell,
        sensors: SensorErrors::NONE,
        latent: None,
    }
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
