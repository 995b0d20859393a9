//! A joint has play between its motor and its link. The encoder sits on the motor.
//!
//! ```text
//! theta_link = theta_motor - sign(T) p/2 - T/K
//! ```
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

/// Of which joint is to be said.
#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    text: include_str!("joint_backlash.rs"),
    parameters: |_, joint| vec![
        reported(JOINT_PLAY.named("play_rad").of(joint), Logarithmic, [1e-6, 0.05]),
        hidden(JOINT_STIFFNESS.named("teeth_stiffness_n_m_per_rad").of(joint), Logarithmic, [1e3, 1e8]),
    ],
    usual: |p, joint| vec![7e-4, p.cell.joint_stiffness[joint].min(1e6)],
    starts: |clues, joint| {
        let teeth = clues.plant.cell.joint_stiffness[joint].min(1e6);
        [2e-4, 1e-3, 4e-3]
            .iter()
            .map(|play| vec![*play, teeth])
            .collect()
    },
    ..effect("joint_backlash", Subsystem::Arm)
};
