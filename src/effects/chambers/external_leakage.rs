//! Air leaks from chamber 1 to the surroundings. A fitting, a rod seal.
//!
//! ```text
//! m_dot = A C p_u / sqrt(R T) f(p_a / p_u)
//! ```
//!
//! m_dot flow out of chamber 1 [kg/s], A equivalent area of the leak [m2], C discharge coefficient [1], p_u pressure of the chamber and p_a that of the
//! atmosphere [Pa absolute], R specific gas constant [J/(kg K)], T temperature [K], f the choked or subsonic flow function.
//! Source: The source paper's eqs. (9) to (11), an isentropic nozzle.
//!
//! Signature: While nothing moves chamber 1 stands below the regulator, by the drop that the leak's flow makes in the supply orifice.
//!
//! Confused with:
//! - cross_piston_leakage: chamber 2 rises too.
//! - regulator_gain_error: the outlet itself is off; here it holds its set pressure.
//! - supply_restriction: a delay, and no loss at rest.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("external_leakage.rs"),
    parameters: |_, _| vec![reported(EXTERNAL_LEAK.named("orifice_area_m2"), Logarithmic, [1e-10, 1e-4])],
    usual: |p, _| vec![0.02 * p.device.supply_orifice],
    starts: |c, _| shares(&[0.01, 0.05, 0.2], c.plant.device.supply_orifice),
    ..effect("external_leakage", Subsystem::Chambers)
};
