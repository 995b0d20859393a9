//! The load cell does not read zero at no force, and drifts. Temperature, creep, a wrong tare.
//!
//! ```text
//! F_m = F + b + d t
//! ```
//!
//! F_m reading and F contact force [N], b bias at the start of each recording [N], d drift [N/s], t time since then [s].
//! Source: Doebelin, Measurement Systems.
//!
//! Signature: The reading in the air is not zero and moves with time, whatever stroke, pressures and motion do.
//!
//! Confused with:
//! - axial_force_offset: reads nothing in the air.
//! - force_sensor_gain_error: in proportion to the force.

use super::*;

/// Beyond any load cell here [N], [N/s].
const FAR: f64 = 1e3;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("force_sensor_bias_drift.rs"),
    parameters: |_, _| vec![
        reported(FORCE_BIAS.named("bias_n"), Linear(1.0), [-FAR, FAR]),
        reported(FORCE_DRIFT.named("drift_n_per_s"), Linear(0.1), [-FAR, FAR]),
    ],
    usual: |_, _| vec![3.0, 0.3],
    starts: |_, _| vec![vec![0.0, 0.0]],
    ..effect("force_sensor_bias_drift", Subsystem::Sensors)
};
