//! The tool turns off its axis and lifts and presses in turn.
//!
//! ```text
//! x_s = x_robot + s sin(2 pi f t) + c cos(2 pi f t)
//! ```
//!
//! x_s where the surface is met along the stroke and x_robot where the robot has it [m], s and c amplitudes of sine and cosine [m], f frequency of the
//! spindle [Hz], t time since the start of the recording [s].
//! Source: Kinematics of an eccentric.
//!
//! Signature: A line in the spectrum of force and acceleration while touching, at the spindle's turns where they are known, else above 11 Hz; nothing in
//! the air.
//!
//! Confused with:
//! - surface_waviness: the same at any other frequency where the spindle's turns are known, else below 11 Hz.
//! - a compressor's or regulator's pulses: in the outlet, touching or not.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("tool_runout.rs"),
    parameters: |p, _| vec![
        reported(RUNOUT_FREQUENCY.named("frequency_hz"), Linear(0.02), turns(p)),
        hidden(RUNOUT_SINE.named("sine_m"), Linear(2e-5), [-0.01, 0.01]),
        hidden(RUNOUT_COSINE.named("cosine_m"), Linear(2e-5), [-0.01, 0.01]),
    ],
    usual: |p, _| vec![known_turns(p).map_or(83.0, |_| p.contact.spindle_frequency), 5e-5, 0.0],
    starts: |c, _| waves(c, true),
    phase: Some(&RUNOUT_PHASE),
    ..effect("tool_runout", Subsystem::Contact)
};
