//! A load behind a line fills and empties more slowly than the outlet moves. The outlet gives way until the load has filled.
//!
//! ```text
//! y = p - w (p - q),   dq/dt = (p - q)/T
//! ```
//!
//! y outlet [Pa gauge], p what the regulator alone would hold [Pa gauge], q the load's pressure [Pa gauge], w share [1], T time in which the load fills [s].
//! Source: Two volumes with a laminar line between them; Anderson 1967, chapter 4.
//!
//! Signature: After every step a slow tail, both ways, of the same share.
//!
//! Confused with:
//! - regulator_venting: down alone.
//! - regulator_second_order: swings, or starts flat, without a tail.
//! - a longer time constant: no fast part before the slow one.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("load_behind_line.rs"),
    parameters: |_, _| vec![
        reported(LOAD_SHARE.named("share_1"), Linear(0.1), [0.0, 0.95]),
        reported(LOAD_TIME.named("load_time_constant_s"), Logarithmic, [1e-2, 100.0]),
    ],
    usual: |_, _| vec![0.5, 0.1],
    starts: |_, _| vec![vec![0.2, 0.5], vec![0.2, 2.0]],
    ..effect("load_behind_line", Subsystem::Regulator)
};
