//! A joint has play between its motor and its link. The encoder sits on the motor.
//!
//!     theta_link = theta_motor - sign(T) p/2 - T/K
//!
//! theta_link and theta_motor angles of link and motor [rad], T torque that goes through the teeth [N m], p play from flank to flank [rad], K stiffness of
//! the teeth [N m/rad].
//! Source: Nordin, Gutman, Automatica 38, 2002, sec. 2.
//!
//! Signature: The stroke jumps by the joint's lever times the play where the torque through the joint changes its sign, and stands off by half of that in
//! between; on a joint that is loaded to one side all along, as an encoder that is off.
//!
//! Confused with:
//! - joint_encoder_offset: the same where the torque never changes its sign; otherwise it does not jump.
//! - compliant_joint: its part grows with the force.

use super::*;
use Coordinate::Logarithmic;

/// Of which joint is to be said.
pub(super) const EFFECT: Effect = Effect {
    name: "joint_backlash",
    text: include_str!("joint_backlash.rs"),
    which: Which::Only,
    subsystem: super::super::Subsystem::Arm,
    group: None,
    parameters: |_, joint| {
        vec![
            reported(
                Quantity {
                    name: "play_rad",
                    index: joint,
                    get: |p, joint| p.cell.joint_play[joint],
                    set: |p, joint, v| p.cell.joint_play[joint] = v,
                },
                Logarithmic,
                [1e-6, 0.05],
            ),
            Parameter {
                reported: false,
                ..reported(
                    Quantity {
                        name: "teeth_stiffness_n_m_per_rad",
                        index: joint,
                        get: |p, joint| p.cell.joint_stiffness[joint],
                        set: |p, joint, v| p.cell.joint_stiffness[joint] = v,
                    },
                    Logarithmic,
                    [1e3, 1e8],
                )
            },
        ]
    },
    usual: |p, joint| vec![7e-4, p.cell.joint_stiffness[joint].min(1e6)],
    starts: |clues, joint| {
        let teeth = clues.plant.cell.joint_stiffness[joint].min(1e6);
        [2e-4, 1e-3, 4e-3]
            .iter()
            .map(|play| vec![*play, teeth])
            .collect()
    },
};
