//! The regulator overshoots and swings: its diaphragm and pilot are an oscillator.
//!
//!     p'' + 2 zeta w p' + w^2 p = w^2 K p_set        in place of the first-order lag
//!
//! p outlet [Pa gauge], p_set set pressure [Pa gauge], K gain [1], w natural frequency [rad/s], zeta damping ratio [1]. Linear oscillator (Ogata,
//! Modern Control Engineering, 5.3).
//!
//! Signature: the outlet starts flat after a step, and for zeta below 0.7 overshoots it.
//! Confused with: transport_delay (the outlet starts at once after it), regulator_rate_limit (for large steps alone).

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![
        reported(NATURAL_FREQUENCY.named("natural_frequency_rad_per_s"), Logarithmic, [0.5, 500.0]),
        reported(DAMPING_RATIO.named("damping_ratio"), Logarithmic, [0.02, 5.0]),
    ],
    usual: |_, _| vec![25.0, 0.35],
    starts: |c, _| {
        let w = 1.0 / c.plant.device.regulator.time_constant;
        vec![vec![1.5 * w, 0.6], vec![1.5 * w, 0.3], vec![4.0 * w, 0.4]]
    },
    ..effect("regulator_second_order", Subsystem::Regulator)
};
