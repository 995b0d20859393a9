//! The regulator overshoots and swings. Its diaphragm and pilot are an oscillator.
//!
//! ```text
//! p'' + 2 zeta w p' + w^2 p = w^2 K p_set        in place of the first-order lag
//! ```
//!
//! p outlet [Pa gauge], p_set set pressure [Pa gauge], K gain [1], w natural frequency [rad/s], zeta damping ratio [1].
//! Source: Linear oscillator (Ogata, Modern Control Engineering, 5.3).
//!
//! Signature: The outlet starts flat after a step, and for zeta well below 1 overshoots it and swings (by 5 % at 0.7, by 30 % at 0.35).
//!
//! Confused with:
//! - transport_delay: the outlet does nothing, then answers at once.
//! - regulator_rate_limit: shows at large steps alone.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("regulator_second_order.rs"),
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
