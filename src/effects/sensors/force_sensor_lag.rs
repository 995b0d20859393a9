//! The load cell's signal is smoothed, and late by it. Its amplifier's filter.
//!
//! ```text
//! T dF_m/dt + F_m = F
//! ```
//!
//! F_m reading and F contact force [N], T time constant [s].
//! Source: First-order low pass.
//!
//! Signature: Edges of the force are rounded and late by T, those of stroke and acceleration are not.
//!
//! Confused with:
//! - channel_time_offset: late but not rounded.
//! - inertial_crosstalk: follows the acceleration, in the air too.
//! - hose_volume: the piston is late too.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("force_sensor_lag.rs"),
    parameters: |_, _| vec![reported(FORCE_LAG.named("time_constant_s"), Logarithmic, [1e-4, 2.0])],
    usual: |_, _| vec![0.02],
    starts: |_, _| each(&[3e-3, 0.01, 0.03, 0.1]),
    ..effect("force_sensor_lag", Subsystem::Sensors)
};
