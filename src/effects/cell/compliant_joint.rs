//! A joint is softer than believed between its motor, where the encoder is, and its link.
//!
//!     theta_link = theta_motor + (J^T F - M(q) q'')/K      (Spong, J. Dyn. Syst. Meas. Control 109, 1987, quasi-static)
//!
//! Signature: the stroke is off by J^2 F/K, in proportion to the contact force, with the joint's lever along the path; nothing where nothing touches.
//! Confused with: contact stiffness (the same in every posture), the other joints (told apart by their levers: those of several leans and places).

use super::*;

/// What a joint that is believed rigid may be [N m/rad].
const RIGID: [f64; 2] = [1e3, 1e8];

/// Of which joint is to be said.
pub(super) const EFFECT: Effect = Effect {
    parameters: |p, joint| {
        let believed = p.cell.joint_stiffness[joint];
        vec![reported(
            JOINT_STIFFNESS.named("stiffness_n_m_per_rad").of(joint),
            Logarithmic,
            if believed.is_finite() {
                [1e-4 * believed, 100.0 * believed]
            } else {
                RIGID
            },
        )]
    },
    usual: |p, joint| vec![(0.1 * p.cell.joint_stiffness[joint]).min(1.5e5)],
    starts: |clues, joint| {
        let believed = clues.plant.cell.joint_stiffness[joint];
        if believed.is_infinite() {
            return vec![vec![1e7], vec![1e6], vec![1e5]];
        }
        let shares = [0.02, 0.1, 0.4].iter();
        shares.map(|share| vec![share * believed]).collect()
    },
    ..effect("compliant_joint", Subsystem::Arm)
};
