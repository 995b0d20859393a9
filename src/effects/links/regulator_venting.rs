//! The regulator vents at another pace than it fills. Exhaust and inlet are valves of their own.
//!
//!     dp/dt = (K p_set - p)/T_v   while it falls
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
pub const EFFECT: Effect = Effect {
    name: "regulator_venting",
    text: include_str!("regulator_venting.rs"),
    which: Which::Only,
    subsystem: Subsystem::Regulator,
    group: None,
    parameters: |_, _| {
        vec![reported(
            Quantity {
                name: "venting_time_constant_s",
                index: 0,
                get: |p, _| {
                    let own = p.links.venting_time_constant;
                    own.unwrap_or(p.device.regulator.time_constant)
                },
                set: |p, _, v| p.links.venting_time_constant = Some(v),
            },
            Logarithmic,
            [1e-3, 30.0],
        )]
    },
    usual: |_, _| vec![0.1],
    starts: |c, _| shares(&[0.3, 1.5, 4.0], c.plant.device.regulator.time_constant),
};
