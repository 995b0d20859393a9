//! The load cell reads too much or too little in proportion. Wrong calibration, another bridge supply.
//!
//! ```text
//! F_m = g F
//! ```
//!
//! F_m reading and F contact force [N], g gain [1].
//! Source: Doebelin, Measurement Systems.
//!
//! Signature: The reading is off in proportion to the force, while outlet, stroke and acceleration are nominal.
//!
//! Confused with:
//! - regulator_gain_error: the outlet is off as well.
//! - pressure_dependent_friction: changes its sign with the direction of motion.
//! - contact_stiffness_error: the stroke is off as well.

use super::*;

/// The effect.
pub const EFFECT: Effect = Effect {
    text: include_str!("force_sensor_gain_error.rs"),
    parameters: |_, _| vec![reported(FORCE_GAIN.named("gain"), Linear(0.02), [0.2, 5.0])],
    usual: |_, _| vec![1.05],
    starts: |_, _| vec![vec![1.0]],
    ..effect("force_sensor_gain_error", Subsystem::Sensors)
};
