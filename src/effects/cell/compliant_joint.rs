//! A joint gives way between its motor and its link, more than nominal. The encoder sits on the motor.
//!
//! ```text
//! theta_link = theta_motor + (J^T F - M(q) q'')/K
//! ```
//!
//! theta_link and theta_motor angles of link and motor [rad], J Jacobian of the tool's ball [m/rad] and J^T its transpose, F contact force [N], M inertia
//! matrix of the arm [kg m2], q posture and q'' its acceleration [rad], [rad/s2], K stiffness of the joint [N m/rad].
//! Source: Spong, J. Dyn. Syst. Meas. Control 109, 1987, quasi-static; gravity is taken to be compensated.
//!
//! Signature: The stroke is off by J^2 F/K, in proportion to the contact force, with the joint's lever along the path; nothing where nothing touches.
//!
//! Confused with:
//! - contact_stiffness_error: the same in every posture.
//! - joint_encoder_offset: the same at every force, and where nothing touches.
//! - compliant_joint of another joint: distinguished by their levers, at several leans and positions.

use super::*;

/// Stiffness range of a joint that is nominal rigid [N m/rad].
const RIGID: [f64; 2] = [1e3, 1e8];

/// Of which joint is to be said.
pub(super) const EFFECT: Effect = Effect {
    text: include_str!("compliant_joint.rs"),
    parameters: |p, joint| {
        let nominal = p.cell.joint_stiffness[joint];
        vec![reported(
            JOINT_STIFFNESS.named("stiffness_n_m_per_rad").of(joint),
            Logarithmic,
            if nominal.is_finite() {
                [1e-4 * nominal, 100.0 * nominal]
            } else {
                RIGID
            },
        )]
    },
    usual: |p, joint| vec![(0.1 * p.cell.joint_stiffness[joint]).min(1.5e5)],
    starts: |clues, joint| {
        let nominal = clues.plant.cell.joint_stiffness[joint];
        if nominal.is_infinite() {
            return vec![vec![1e7], vec![1e6], vec![1e5]];
        }
        let shares = [0.02, 0.1, 0.4].iter();
        shares.map(|share| vec![share * nominal]).collect()
    },
    ..effect("compliant_joint", Subsystem::Arm)
};
