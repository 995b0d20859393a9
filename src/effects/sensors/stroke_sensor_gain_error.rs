//! The position sensor reads too much or too little in proportion. Wrong scale, a magnet that stands off.
//!
//! ```text
//! x_m = g x
//! ```
//!
//! x_m reading and x stroke [m], g gain [1].
//! Source: Doebelin, Measurement Systems.
//!
//! Signature: The reading is off in proportion to the stroke, at the far stop most, while force and accelerations are nominal.
//!
//! Confused with:
//! - surface_offset: in contact alone, and the same at every stroke.
//! - contact_stiffness_error: in proportion to the force, in contact alone.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("stroke_sensor_gain_error.rs"),
    parameters: |_, _| vec![reported(STROKE_GAIN.named("gain"), Linear(0.01), [0.2, 5.0])],
    usual: |_, _| vec![1.02],
    starts: |_, _| vec![vec![1.0]],
    ..effect("stroke_sensor_gain_error", Subsystem::Sensors)
};
