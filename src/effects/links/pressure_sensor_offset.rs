//! The pressure sensor does not read zero at the atmosphere.
//!
//! ```text
//! p_m = p + b
//! ```
//!
//! p_m reading and p pressure [Pa gauge], b offset [Pa].
//! Source: ISA-37.
//!
//! Signature: The reading is off by the same at every pressure, at none too.
//!
//! Confused with:
//! - regulator_gain_error: grows with the pressure.
//! - a set value that is itself off: a recording of one sensor cannot tell.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("pressure_sensor_offset.rs"),
    parameters: |_, _| vec![reported(PRESSURE_OFFSET.named("offset_pa"), Linear(1000.0), [-2e5, 2e5])],
    usual: |_, _| vec![500.0],
    starts: |_, _| vec![vec![0.0]],
    ..effect("pressure_sensor_offset", Subsystem::Sensors)
};
