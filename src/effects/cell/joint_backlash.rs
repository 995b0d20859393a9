//! A joint has play between its motor, where the encoder is, and its link.
//!
//!     theta_link = theta_motor - sign(T) p/2 - T/K,   T torque that goes through the teeth      (Nordin, Gutman, Automatica 38, 2002, sec. 2)
//!
//! Signature: the stroke jumps by the joint's lever times the play where the torque through the joint changes its sign, and stands off by half of that in
//! between; on a joint that gravity loads to one side all along, as an encoder that is off.
//! Confused with: joint_encoder_offset, where the torque never changes its sign; a soft joint, whose part grows with the force.

use super::*;
use Coordinate::Logarithmic;

/// Name in the vocabulary.
pub(super) const NAME: &str = "joint_backlash";

pub(super) const fn effect<const J: usize>() -> Effect {
    Effect {
        name: numbered(
            [
                "joint_backlash_1",
                "joint_backlash_2",
                "joint_backlash_3",
                "joint_backlash_4",
                "joint_backlash_5",
                "joint_backlash_6",
                "joint_backlash_7",
                "joint_backlash_8",
            ],
            J,
        ),
        subsystem: super::super::Subsystem::Arm,
        group: None,
        parameters: |_| {
            vec![
                reported(
                    Quantity {
                        name: "play_rad",
                        get: |p| p.cell.joint_play[J],
                        set: |p, v| p.cell.joint_play[J] = v,
                    },
                    Logarithmic,
                    [1e-6, 0.05],
                ),
                Parameter {
                    reported: false,
                    ..reported(
                        Quantity {
                            name: "teeth_stiffness_n_m_per_rad",
                            get: |p| p.cell.joint_stiffness[J],
                            set: |p, v| p.cell.joint_stiffness[J] = v,
                        },
                        Logarithmic,
                        [1e3, 1e8],
                    )
                },
            ]
        },
        usual: |p| vec![7e-4, p.cell.joint_stiffness[J].min(1e6)],
        starts: |clues: &Clues<'_>| {
            let teeth = clues.plant.cell.joint_stiffness[J].min(1e6);
            [2e-4, 1e-3, 4e-3]
                .iter()
                .map(|play| vec![*play, teeth])
                .collect()
        },
    }
}
