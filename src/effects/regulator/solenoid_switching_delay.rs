//! The 5/2 valve switches later than commanded. Its coil builds up its field, its pilot fills.
//!
//! ```text
//! position(t) = command(t - theta)
//! ```
//!
//! t time [s], theta switching delay [s], the same either way.
//! Source: ISO 12238 for how makers state it: 10 to 30 ms for a pilot-operated valve of this size.
//!
//! Signature: Extending and retracting start late by the same time, whatever the regulator does in between.
//!
//! Confused with:
//! - transport_delay: the outlet is late after a set pressure; the valve is not.
//! - hose_volume: the pressure is late after a set pressure too; the valve is not.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("solenoid_switching_delay.rs"),
    parameters: |_, _| vec![reported(SWITCHING_DELAY.named("delay_s"), Logarithmic, [1e-3, 1.0])],
    usual: |_, _| vec![0.03],
    starts: |_, _| each(&[0.01, 0.03, 0.08]),
    ..effect("solenoid_switching_delay", Subsystem::Regulator)
};
