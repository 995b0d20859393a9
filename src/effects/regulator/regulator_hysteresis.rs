//! The regulator has play: small changes of its set pressure do nothing. Friction of its pilot's spool.
//!
//! ```text
//! p_a = min(max(p_a, p_set - r), p_set + r)
//! ```
//!
//! p_a pressure acted on [Pa gauge], p_set set pressure [Pa gauge], r half the width of the play [Pa].
//! Source: Play operator, Krasnosel'skii and Pokrovskii 1989.
//!
//! Signature: Coming from below the outlet stands r short, from above r over; the first steps after a reversal do nothing.
//!
//! Confused with:
//! - regulator_gain_error: does not know where it came from.
//! - coulomb_viscous_friction: in the force, not in the outlet.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("regulator_hysteresis.rs"),
    parameters: |_, _| vec![reported(REGULATOR_HYSTERESIS.named("half_width_pa"), Logarithmic, [10.0, 2e5])],
    usual: |_, _| vec![3e3],
    starts: |_, _| each(&[2e3, 6e3, 15e3]),
    ..effect("regulator_hysteresis", Subsystem::Regulator)
};
