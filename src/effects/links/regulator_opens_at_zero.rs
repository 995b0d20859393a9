//! The regulator opens its exhaust wide where nothing is set. It is not metered then.
//!
//! ```text
//! dp/dt = -p/T_0   while p_set = 0
//! ```
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
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("regulator_opens_at_zero.rs"),
    parameters: |_, _| vec![reported(SHUT_TIME_CONSTANT.named("open_time_constant_s"), Logarithmic, [1e-3, 30.0])],
    usual: |_, _| vec![0.05],
    starts: |c, _| shares(&[0.1, 0.4, 3.0], c.plant.device.regulator.time_constant),
    ..effect("regulator_opens_at_zero", Subsystem::Regulator)
};
