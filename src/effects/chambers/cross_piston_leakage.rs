//! Air leaks past the piston from chamber to chamber. A worn seal, a scratched bore.
//!
//! ```text
//! m_dot = A C p_u / sqrt(R T) f(p_d / p_u)
//! ```
//!
//! m_dot flow from the higher to the lower pressure [kg/s], A equivalent area of the gap [m2], C discharge coefficient [1], p_u and p_d upstream and
//! downstream pressure [Pa absolute], R specific gas constant [J/(kg K)], T temperature [K], f the choked or subsonic flow function.
//! Source: The source paper's eqs. (9) to (11), an isentropic nozzle.
//!
//! Signature: While nothing moves chamber 1 stands below the regulator and chamber 2 above the atmosphere; the force sags, by more at a higher pressure.
//!
//! Confused with:
//! - external_leakage: chamber 1 alone falls; chamber 2 stays at the atmosphere.
//! - supply_restriction: a delay, and no loss at rest.
//! - regulator_gain_error: the outlet itself is off in proportion.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("cross_piston_leakage.rs"),
    parameters: |_, _| vec![reported(CROSS_PISTON_LEAK.named("orifice_area_m2"), Logarithmic, [1e-10, 1e-4])],
    usual: |p, _| vec![0.02 * p.device.supply_orifice],
    starts: |c, _| shares(&[0.01, 0.05, 0.2], c.plant.device.supply_orifice),
    ..effect("cross_piston_leakage", Subsystem::Chambers)
};
