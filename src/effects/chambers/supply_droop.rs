//! The supply falls when much air is drawn: a small reservoir and compressor.
//!
//! ```text
//! V dp/dt = R T_0 (m_dot_c s(p) - m_dot_drawn),   outlet <= p
//! ```
//!
//! p absolute pressure of the reservoir and of the outlet [Pa], V volume of the reservoir [m3], m_dot_c flow of the compressor [kg/s], s 1 until the
//! reservoir is full and 0 then, m_dot_drawn what the regulator lets through [kg/s], R specific gas constant [J/(kg K)], T_0 temperature [K].
//! Source: Isothermal tank, source paper eq. (4).
//!
//! Signature: The outlet cannot hold high set pressures after much air was drawn, and comes back slowly.
//!
//! Confused with:
//! - regulator_rate_limit: the same rate at every pressure and after any history.
//! - regulator_gain_error: always, whatever was drawn before.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("supply_droop.rs"),
    parameters: |_, _| vec![
        reported(RESERVOIR_VOLUME.named("reservoir_volume_m3"), Logarithmic, [1e-5, 0.1]),
        reported(COMPRESSOR_FLOW.named("compressor_flow_kg_per_s"), Logarithmic, [1e-6, 0.1]),
    ],
    usual: |_, _| vec![1e-3, 5e-4],
    starts: |_, _| vec![vec![1e-4, 5e-5], vec![1e-4, 2e-4], vec![4e-4, 5e-5], vec![4e-4, 2e-4], vec![1.5e-3, 1e-4]],
    ..effect("supply_droop", Subsystem::Chambers)
};
