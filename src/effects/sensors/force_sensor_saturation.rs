//! The load cell's signal ends at a limit: its amplifier or its converter is at its end.
//!
//!     F_m = min(max(F, -l), l)
//!
//! F_m reading and F contact force [N], l limit [N].
//!
//! Signature: peaks are cut flat at the same reading, and everything below it is right.
//! Confused with: supply_droop (the outlet and the stroke show it), force_sensor_gain_error (small forces too).

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![reported(FORCE_LIMIT.named("limit_n"), Linear(2.0), [5.0, 5000.0])],
    usual: |_, _| vec![120.0],
    starts: |c, _| vec![vec![c.largest_force]],
    ..effect("force_sensor_saturation", Subsystem::Sensors)
};
