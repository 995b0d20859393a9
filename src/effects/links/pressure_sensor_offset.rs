//! The pressure sensor does not read zero at the atmosphere.
//!
//!     p_m = p + b
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
pub const EFFECT: Effect = Effect {
    name: "pressure_sensor_offset",
    text: include_str!("pressure_sensor_offset.rs"),
    which: Which::Only,
    subsystem: Subsystem::Sensors,
    group: None,
    parameters: |_, _| {
        vec![reported(
            quantity!("offset_pa", p => p.sensors.pressure_offset),
            Linear(1000.0),
            [-2e5, 2e5],
        )]
    },
    usual: |_, _| vec![500.0],
    starts: |_, _| vec![vec![0.0]],
};
