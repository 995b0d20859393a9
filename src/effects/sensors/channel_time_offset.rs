//! The load cell's samples are stamped late. Another clock, a buffer.
//!
//! ```text
//! F_m(t) = F(t - delta)
//! ```
//!
//! t time [s], F_m reading and F contact force [N], delta how late it is stamped [s].
//! Source: Definition of a delay.
//!
//! Signature: Every edge of the force comes late by the same time, undistorted, while stroke and acceleration are in time.
//!
//! Confused with:
//! - force_sensor_lag: rounds the edges.
//! - transport_delay: everything is late, the outlet first.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("channel_time_offset.rs"),
    parameters: |_, _| vec![reported(FORCE_DELAY.named("offset_s"), Linear(0.005), [-0.5, 0.5])],
    usual: |_, _| vec![0.015],
    starts: |_, _| each(&[4e-3, 0.015, 0.04, -0.01]),
    ..effect("channel_time_offset", Subsystem::Sensors)
};
