//! A joint rubs more, or less, than believed: bearings and gears, dry.
//!
//!     tau = tau_frictionless + F sat(q'/v_0)      (Swevers et al., IEEE Control Systems 27(5), 2007)
//!
//! Signature: the torque of one drive has a part with the sign of its joint's speed, the same size whatever the load; tool and surface hardly show it.
//! Confused with: nothing, for it is seen in a link of its own, from the motion to the drives' torques, beside which the device is looked at.

use super::*;

/// Of which joint is to be said.
#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    parameters: |_, joint| vec![reported(DRIVE_FRICTION.named("friction_n_m").of(joint), Linear(1.0), [0.0, 1e4])],
    usual: |p, joint| vec![p.cell.joint_friction[joint] + 20.0],
    starts: |clues, joint| vec![vec![clues.plant.cell.joint_friction[joint]]],
    ..effect("joint_friction", Subsystem::Arm)
};
