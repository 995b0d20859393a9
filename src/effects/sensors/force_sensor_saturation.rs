//! The load cell's signal ends at a limit. Its amplifier or its converter is at its end.
//!
//!     F_m = min(max(F, -l), l)
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
pub const EFFECT: Effect = Effect {
    name: "force_sensor_saturation",
    text: include_str!("force_sensor_saturation.rs"),
    which: Which::Only,
    subsystem: Subsystem::Sensors,
    group: None,
    parameters: |_, _| {
        vec![reported(
            quantity!("limit_n", p => p.sensors.force_limit),
            Linear(2.0),
            [5.0, 5000.0],
        )]
    },
    usual: |_, _| vec![120.0],
    starts: |c, _| vec![vec![c.largest_force]],
};
