//! The load cell feels the mass in front of it being accelerated.
//!
//! ```text
//! F_m = F + m_x a
//! ```
//!
//! F_m reading and F contact force [N], m_x mass beyond the load cell [kg], a acceleration along extension [m/s2].
//! Source: Newton's second law.
//!
//! Signature: The reading in the air is a copy of the accelerometer's, m_x times it.
//!
//! Confused with:
//! - moving_mass_error: the motion itself is another one.
//! - force_sensor_lag: nothing in the air.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("inertial_crosstalk.rs"),
    parameters: |_, _| vec![reported(CROSSTALK_MASS.named("mass_kg"), Linear(0.1), [-20.0, 20.0])],
    usual: |_, _| vec![0.5],
    starts: |_, _| vec![vec![0.0]],
    ..effect("inertial_crosstalk", Subsystem::Sensors)
};
