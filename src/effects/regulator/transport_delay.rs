//! The regulator answers its set pressure only after a dead time: a bus, a PWM filter, its own electronics.
//!
//!     p_acted(t) = p_set(t - theta)
//!
//! p_set set pressure, p_acted that acted on [Pa gauge], theta dead time [s]. Dead time of process control (Smith 1957).
//!
//! Signature: the outlet does nothing for theta after each change, then answers as believed.
//! Confused with: regulator_second_order (starts flat, but at once), channel_time_offset (of the force alone), solenoid_switching_delay.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![reported(REGULATOR_DEAD_TIME.named("delay_s"), Logarithmic, [5e-4, 2.0])],
    usual: |_, _| vec![0.05],
    starts: |_, _| each(&[0.01, 0.03, 0.1, 0.25]),
    ..effect("transport_delay", Subsystem::Regulator)
};
