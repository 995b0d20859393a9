//! The load cell reads too much or too little in proportion: wrong calibration, another bridge supply.
//!
//!     F_m = g F
//!
//! F_m reading and F contact force [N], g gain [1]. Doebelin, Measurement Systems.
//!
//! Signature: the reading is off in proportion to the force, while outlet, stroke and acceleration are as believed.
//! Confused with: regulator_gain_error (in the outlet), pressure_dependent_friction (turns with the motion), contact_stiffness_error (in the stroke).

use super::*;

/// The effect.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![reported(FORCE_GAIN.named("gain"), Linear(0.02), [0.2, 5.0])],
    usual: |_, _| vec![1.05],
    starts: |_, _| vec![vec![1.0]],
    ..effect("force_sensor_gain_error", Subsystem::Sensors)
};
