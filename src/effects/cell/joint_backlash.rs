//! A joint has play between its motor, where the encoder is, and its link.
//!
//!     theta_link = theta_motor - sign(T) p/2 - T/K,   T torque that goes through the teeth      (Nordin, Gutman, Automatica 38, 2002, sec. 2)
//!
//! Signature: the stroke jumps by the joint's lever times the play where the torque through the joint changes its sign, and stands off by half of that in
//! between; on a joint that gravity loads to one side all along, as an encoder that is off.
//! Confused with: joint_encoder_offset, where the torque never changes its sign; a soft joint, whose part grows with the force.

use super::*;

/// Of which joint is to be said.
#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
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
