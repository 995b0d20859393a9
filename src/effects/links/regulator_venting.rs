//! The regulator vents at another pace than it fills. Exhaust and inlet are valves of their own.
//!
//! ```text
//! dp/dt = (K p_set - p)/T_v   while it falls
//! ```
//!
//! p outlet [Pa gauge], p_set set pressure [Pa gauge], K gain [1], T_v time constant of venting [s].
//! Source: Zorlu, Ozsoy and Kuzucu 2003: inlet and exhaust of a proportional regulator's own valve differ, and the exhaust works against the atmosphere.
//!
//! Signature: After a step down another time constant than after a step up.
//!
//! Confused with:
//! - regulator_rate_limit: ramps in place of exponentials.
//! - load_behind_line: a slow tail both ways.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("regulator_venting.rs"),
    parameters: |_, _| vec![reported(VENTING_TIME_CONSTANT.named("venting_time_constant_s"), Logarithmic, [1e-3, 30.0])],
    usual: |_, _| vec![0.1],
    starts: |c, _| shares(&[0.3, 1.5, 4.0], c.plant.device.regulator.time_constant),
    ..effect("regulator_venting", Subsystem::Regulator)
};
