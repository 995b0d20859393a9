//! The chamber is still fed when the recording begins.
//!
//! ```text
//! dp/dt = 0   for t < t_s
//! ```
//!
//! p pressure [Pa], t time since the start of the recording and t_s that at which it is shut [s].
//! Source: Definition of the time of shutting.
//!
//! Signature: A level at the start, then the decay at once.
//!
//! Confused with:
//! - chamber_cooling: a fast fall at the start, in place of none.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("chamber_shut_later.rs"),
    parameters: |_, _| vec![reported(SHUT_TIME.named("shut_time_s"), Linear(1.0), [0.0, 1e3])],
    usual: |_, _| vec![0.5],
    starts: |_, _| each(&[0.5, 2.0, 5.0, 10.0, 30.0]),
    ..effect("chamber_shut_later", Subsystem::Chambers)
};
