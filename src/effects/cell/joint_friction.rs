//! A joint has more friction than nominal, or less. Bearings and gears, dry.
//!
//! ```text
//! tau = tau_frictionless + F sat(q'/v_0)
//! ```
//!
//! tau torque of the drive and tau_frictionless what the motion takes without friction [N m], F friction [N m], sat dry friction's sign of the speed,
//! rounded near rest, q' speed of the joint and v_0 that of the rounding [rad/s].
//! Source: Swevers et al., IEEE Control Systems 27(5), 2007.
//!
//! Signature: The torque of one drive has a part with the sign of its joint's speed, the same size whatever the load; tool and surface hardly show it.
//!
//! Confused with:
//! - nothing: it is seen in a link of its own, from the motion to the torques of the drives, beside which the device is looked at.

use super::*;

/// Of which joint is to be said.
#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    text: include_str!("joint_friction.rs"),
    parameters: |_, joint| vec![reported(DRIVE_FRICTION.named("friction_n_m").of(joint), Linear(1.0), [0.0, 1e4])],
    usual: |p, joint| vec![p.cell.joint_friction[joint] + 20.0],
    starts: |clues, joint| vec![vec![clues.plant.cell.joint_friction[joint]]],
    ..effect("joint_friction", Subsystem::Arm)
};
