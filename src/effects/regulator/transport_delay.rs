//! The regulator answers a set pressure only after a dead time. A bus, a PWM filter, its own electronics.
//!
//! ```text
//! p_acted(t) = p_set(t - theta)
//! ```
//!
//! t time [s], p_set set pressure and p_acted that acted on [Pa gauge], theta dead time [s].
//! Source: Dead time of process control (Smith 1957).
//!
//! Signature: The outlet does nothing for theta after each change, then its response is nominal.
//!
//! Confused with:
//! - regulator_second_order: the outlet starts flat, but at once.
//! - channel_time_offset: the force alone is late.
//! - solenoid_switching_delay: what the valve does is late; the outlet is not.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("transport_delay.rs"),
    parameters: |_, _| vec![reported(REGULATOR_DEAD_TIME.named("delay_s"), Logarithmic, [5e-4, 2.0])],
    usual: |_, _| vec![0.05],
    starts: |_, _| each(&[0.01, 0.03, 0.1, 0.25]),
    ..effect("transport_delay", Subsystem::Regulator)
};
