//! `[program]` of a scenario file: what a robot's program says that its cell does not need.

use glam::DVec3;
use serde::Deserialize;

use crate::keys::check::Section;
use crate::keys::declaration::{Plain, keys};
use crate::keys::error::ScenarioError;

/// Maker of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RobotMaker {
    /// Universal Robots.
    UniversalRobots,
    /// KUKA.
    Kuka,
    /// ABB.
    Abb,
    /// FANUC.
    Fanuc,
}

impl Plain for RobotMaker {}

keys! {
    /// `[program]`: what `idc export program` writes beyond the planned path.
    pub struct ProgramScenario {
        /// maker of the robot, where its name in the URDF misleads
        maker: Option<RobotMaker> = "maker", shown "by the robot's name in the URDF";
        /// number or name of the analog output that sets the force
        force_output: Option<String> = "force_output", shown "`0` in URScript, `aoForce` in RAPID, `1` else";
        /// contact forces at which the output's value is known, increasing
        output_forces: Option<Vec<f64>> = "output_forces_n" in 0..=5000, shown "see docs/PROGRAMS.md";
        /// the output's values at these forces, as the controller takes them; straight lines between
        output_values: Option<Vec<f64>> = "output_values" in -1e6..=1e6, shown "see docs/PROGRAMS.md";
        /// the controller's base in the arm's base link
        base_position: Option<DVec3> = "base_position_mm" in -10_000..=10_000, shown "that of the URDF's link `base`, if it has one";
        /// roll, pitch, yaw of it
        base_rotation: Option<DVec3> = "base_rotation_deg" in -360..=360, shown "that of the URDF's link `base`, if it has one";
        /// what the controller's joint 3 has of joint 2 beyond the URDF's: 1, 0 or -1 (FANUC)
        joint_3_by_2: Option<f64> = "joint_3_by_2" in -1..=1;
    }
}

/// The table, checked.
pub(super) fn program(
    section: &Section<'_>,
    keys: ProgramScenario,
) -> Result<ProgramScenario, ScenarioError> {
    let (forces, values) = match (&keys.output_forces, &keys.output_values) {
        (None, None) => return Ok(keys),
        (Some(_), None) => {
            return Err(section.missing("output_values", "one value for each of output_forces_n"));
        }
        (None, Some(_)) => {
            return Err(section.missing("output_forces_n", "one force for each of output_values"));
        }
        (Some(forces), Some(values)) => (forces, values),
    };
    if forces.len() < 2 || !forces.is_sorted_by(|before, after| before < after) {
        let expected = "at least two forces, increasing".to_owned();
        return Err(section.refuse("output_forces_n", format!("{forces:?}"), expected));
    }
    if values.len() != forces.len() {
        let expected = format!("{} of them, as output_forces_n has", forces.len());
        return Err(section.refuse("output_values", format!("{values:?}"), expected));
    }
    Ok(keys)
}
