//! The chamber is still fed when the recording begins.
//!
//!     dp/dt = 0   for t < t_s
//!
//! p pressure [Pa], t_s time after the start of the recording at which it is shut [s].
//!
//! Signature: a level at the start, then the decay at once.
//! Confused with: chamber_cooling (a fast fall at the start).

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![reported(SHUT_TIME.named("shut_time_s"), Linear(1.0), [0.0, 1e3])],
    usual: |_, _| vec![0.5],
    starts: |_, _| each(&[0.5, 2.0, 5.0, 10.0, 30.0]),
    ..effect("chamber_shut_later", Subsystem::Chambers)
};
