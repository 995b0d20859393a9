//! The arm file that a cell may name: whether it is of the cell's arm.

use super::error::CellError;
use crate::arm::chain::KinematicChain;
use crate::scenario::ArmScenario;

/// Refuses the file of another arm, or drives in another order than the cell's columns have.
///
/// # Errors
/// Joints of the file's drives and those of the arm.
pub fn check(arm: &ArmScenario, chain: &KinematicChain) -> Result<(), CellError> {
    let Some(file) = &arm.recorded_arm else {
        return Ok(());
    };
    let found = file.joints_of_drives();
    let expected: Vec<&str> = chain.joints.iter().map(|j| j.name.as_str()).collect();
    if found == expected {
        return Ok(());
    }
    Err(CellError::OtherDrives {
        file: file.path.clone(),
        found: found.join(", "),
        expected: expected.join(", "),
    })
}

/// A note on effects of the file that a cell has of its own.
pub(super) fn note(arm: &ArmScenario) -> Option<String> {
    let file = arm.recorded_arm.as_ref()?;
    let mut drives = file.nominal.drives.iter();
    drives
        .any(|drive| drive.compliance != 0.0 || drive.encoder_offset != 0.0)
        .then(|| {
            format!(
                "{}: its compliant_joint and joint_encoder_offset do not act in the simulated cell, which has both in [[effect]] of the scenario",
                file.path.display()
            )
        })
}
