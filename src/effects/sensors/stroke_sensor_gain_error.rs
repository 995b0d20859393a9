//! The position sensor reads too much or too little in proportion. Wrong scale, a magnet that stands off.
//!
//!     x_m = g x
//!
//! x_m reading and x stroke [m], g gain [1].
//! Source: Doebelin, Measurement Systems.
//!
//! Signature: The reading is off in proportion to the stroke, at the far stop most, while force and accelerations are as believed.
//!
//! Confused with:
//! - surface_offset: in contact alone, and the same at every stroke.
//! - contact_stiffness_error: in proportion to the force, in contact alone.

use super::*;

/// The effect.
pub const EFFECT: Effect = Effect {
    name: "stroke_sensor_gain_error",
    text: include_str!("stroke_sensor_gain_error.rs"),
    which: Which::Only,
    subsystem: Subsystem::Sensors,
    group: None,
    parameters: |_, _| {
        vec![reported(
            quantity!("gain", p => p.sensors.stroke_gain),
            Linear(0.01),
            [0.2, 5.0],
        )]
    },
    usual: |_, _| vec![1.02],
    starts: |_, _| vec![vec![1.0]],
};
