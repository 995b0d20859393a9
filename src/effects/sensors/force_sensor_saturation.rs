//! The load cell's signal ends at a limit. Its amplifier or its converter is at its end.
//!
//! ```text
//! F_m = min(max(F, -l), l)
//! ```
//!
//! F_m reading and F contact force [N], l limit [N].
//! Source: Limiter; Doebelin, Measurement Systems.
//!
//! Signature: Peaks are cut flat at the same reading, and everything below it is right.
//!
//! Confused with:
//! - supply_droop: outlet and stroke show it too.
//! - force_sensor_gain_error: small forces are off too.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("force_sensor_saturation.rs"),
    parameters: |_, _| vec![reported(FORCE_LIMIT.named("limit_n"), Linear(2.0), [5.0, 5000.0])],
    usual: |_, _| vec![120.0],
    starts: |c, _| vec![vec![c.largest_force]],
    ..effect("force_sensor_saturation", Subsystem::Sensors)
};
