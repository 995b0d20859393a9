//! The regulator's outlet cannot rise or fall faster than so much. Its own valve is small.
//!
//! ```text
//! dp/dt = min(max((K p_set - p) / tau, -fall), rise)
//! ```
//!
//! p outlet [Pa gauge], p_set set pressure [Pa gauge], K gain [1], tau time constant [s], rise and fall the largest rates [Pa/s].
//! Source: Slew limit; Zorlu, Ozsoy and Kuzucu 2003 for the flow of a proportional regulator's own valve.
//!
//! Signature: Large steps of the set pressure become ramps, small ones do not.
//!
//! Confused with:
//! - a longer time constant: slows small steps too.
//! - supply_droop: depends on what was drawn before.
//! - regulator_second_order: starts flat and overshoots, at steps of any size.

use super::*;
use crate::plant::DeviceParts;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("regulator_rate_limit.rs"),
    parameters: |_, _| vec![
        reported(RISE_LIMIT.named("rise_pa_per_s"), Logarithmic, [1e3, 1e8]),
        reported(FALL_LIMIT.named("fall_pa_per_s"), Logarithmic, [1e3, 1e8]),
    ],
    // A small valve on a large load is far slower than one on a device.
    usual: |_, _| vec![1.5e5, 1.5e5],
    starts: |c, _| match c.plant.parts {
        DeviceParts::Regulator => [3e4, 1e5, 3e5]
            .into_iter()
            .flat_map(|rate| [vec![rate, 1e7], vec![rate, rate], vec![1e7, rate]])
            .collect(),
        _ => vec![vec![4e5, 4e5], vec![1.2e6, 4e5], vec![4e5, 1.2e6]],
    },
    ..effect("regulator_rate_limit", Subsystem::Regulator)
};
