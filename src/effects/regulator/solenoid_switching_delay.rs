//! The 5/2 valve switches some time after it is told to: its coil builds up its field, its pilot fills.
//!
//!     position(t) = command(t - theta)
//!
//! theta switching delay [s], the same either way. ISO 12238 for how makers state it: 10 to 30 ms for a pilot-operated valve of this size.
//!
//! Signature: extending and retracting start late by the same time, whatever the regulator does in between.
//! Confused with: transport_delay (of the set pressure, and in the outlet), hose_volume (delays pressure, not the valve).

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![reported(SWITCHING_DELAY.named("delay_s"), Logarithmic, [1e-3, 1.0])],
    usual: |_, _| vec![0.03],
    starts: |_, _| each(&[0.01, 0.03, 0.08]),
    ..effect("solenoid_switching_delay", Subsystem::Regulator)
};
