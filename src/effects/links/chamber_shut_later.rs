//! The chamber is still fed when the recording begins.
//!
//!     dp/dt = 0   for t < t_s
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
pub const EFFECT: Effect = Effect {
    name: "chamber_shut_later",
    text: include_str!("chamber_shut_later.rs"),
    which: Which::Only,
    subsystem: Subsystem::Chambers,
    group: None,
    parameters: |_, _| {
        vec![reported(
            quantity!("shut_time_s", p => p.links.shut_time),
            Linear(1.0),
            [0.0, 1e3],
        )]
    },
    usual: |_, _| vec![0.5],
    starts: |_, _| each(&[0.5, 2.0, 5.0, 10.0, 30.0]),
};
