//! A constant force acts along the axis, positive in extension. A weight that hangs on, a wrong tilt.
//!
//! ```text
//! F = F_0
//! ```
//!
//! F force along extension [N], F_0 its value [N].
//! Source: Statics.
//!
//! Signature: The pressure at which the piston leaves its stop, and the contact force at any pressure, are off by the same force.
//!
//! Confused with:
//! - force_sensor_bias_drift: shows with nothing touched, and the piston's motion is nominal.
//! - regulator_gain_error: grows with the pressure.
//! - moving_mass_error: its weight is such a force, but comes with inertia: distinguished while accelerating.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("axial_force_offset.rs"),
    parameters: |_, _| vec![reported(AXIAL_LOAD.named("force_n"), Linear(2.0), [-500.0, 500.0])],
    usual: |_, _| vec![12.0],
    starts: |_, _| each(&[0.0, 12.0]),
    ..effect("axial_force_offset", Subsystem::ForceBalance)
};
