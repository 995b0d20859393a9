//! The surface goes up and down about where the robot has it. Slower than a tool turns.
//!
//! ```text
//! x_s = x_robot + s sin(2 pi f t) + c cos(2 pi f t)
//! ```
//!
//! x_s where the surface is met along the stroke and x_robot where the robot has it [m], s and c amplitudes of sine and cosine [m], f frequency [Hz], t time
//! since the start of the recording [s].
//! Source: Kinematics: a sine of the way at a steady feed.
//!
//! Signature: Stroke and force go up and down together while touching, at another frequency than the spindle's turns where they are known, else below
//! 11 Hz; nothing in the air.
//!
//! Confused with:
//! - tool_runout: the same at the spindle's turns where they are known, else above 11 Hz.
//! - a regulator's or supply's pulses: in the outlet, touching or not.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("surface_waviness.rs"),
    parameters: |p, _| vec![
        reported(WAVINESS_FREQUENCY.named("frequency_hz"), Linear(0.02), waves_from_to(p)),
        hidden(WAVINESS_SINE.named("sine_m"), Linear(2e-5), [-0.02, 0.02]),
        hidden(WAVINESS_COSINE.named("cosine_m"), Linear(2e-5), [-0.02, 0.02]),
    ],
    usual: |_, _| vec![2.0, 2e-4, 0.0],
    starts: |c, _| waves(c, false),
    phase: Some(&WAVINESS_PHASE),
    ..effect("surface_waviness", Subsystem::Contact)
};
