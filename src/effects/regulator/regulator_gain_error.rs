//! The regulator holds a share of its set pressure off the nominal one. Its set value's scale is off, or it droops.
//!
//! ```text
//! p = K p_set        at rest
//! ```
//!
//! p outlet and p_set set pressure [Pa gauge], K gain [1].
//! Source: Definition of a static gain.
//!
//! Signature: The outlet is off in proportion to the set pressure, at rest too.
//!
//! Confused with:
//! - force_sensor_gain_error: the outlet reads as set.
//! - regulator_hysteresis: the outlet is off to either side of the set pressure, by where it came from.
//! - axial_force_offset: the force is off by the same at every pressure.

use super::*;

/// The effect.
pub const EFFECT: Effect = Effect {
    text: include_str!("regulator_gain_error.rs"),
    parameters: |p, _| {
        let g = p.device.regulator.gain;
        vec![reported(
            REGULATOR_GAIN.named("gain"),
            Logarithmic,
            [0.3 * g, 3.0 * g],
        )]
    },
    usual: |p, _| vec![0.95 * p.device.regulator.gain],
    starts: |c, _| {
        let g = c.plant.device.regulator.gain;
        vec![vec![0.97 * g], vec![1.03 * g]]
    },
    ..effect("regulator_gain_error", Subsystem::Regulator)
};
