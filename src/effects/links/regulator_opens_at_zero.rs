//! The regulator opens its exhaust wide where nothing is set. It is not metered then.
//!
//!     dp/dt = -p/T_0   while p_set = 0
//!
//! p outlet and p_set set pressure [Pa gauge], T_0 time constant of the open exhaust [s].
//! Source: Makers of proportional regulators state that below a least set value the supply valve shuts and the exhaust stands open.
//!
//! Signature: A step to zero falls otherwise than a step to any other low pressure.
//!
//! Confused with:
//! - regulator_venting: every step down alike: recordings with one low set pressure alone cannot tell.

use super::*;

/// The effect.
pub const EFFECT: Effect = Effect {
    name: "regulator_opens_at_zero",
    text: include_str!("regulator_opens_at_zero.rs"),
    which: Which::Only,
    subsystem: Subsystem::Regulator,
    group: None,
    parameters: |_, _| {
        vec![reported(
            Quantity {
                name: "open_time_constant_s",
                index: 0,
                get: |p, _| {
                    let links = &p.links;
                    let own = links.shut_time_constant.or(links.venting_time_constant);
                    own.unwrap_or(p.device.regulator.time_constant)
                },
                set: |p, _, v| p.links.shut_time_constant = Some(v),
            },
            Logarithmic,
            [1e-3, 30.0],
        )]
    },
    usual: |_, _| vec![0.05],
    starts: |c, _| shares(&[0.1, 0.4, 3.0], c.plant.device.regulator.time_constant),
};
