//! Air leaks from chamber 1 to the surroundings: a fitting, a rod seal.
//!
//!     m_dot = A C p_u / sqrt(R T) f(p_a / p_u)
//!
//! m_dot flow out of chamber 1 [kg/s], A equivalent area [m2], C discharge coefficient [1], p_u its pressure and p_a that of the atmosphere [Pa],
//! R specific gas constant [J/(kg K)], T temperature [K], f the choked or subsonic flow function: the source paper's eqs. (9) to (11).
//!
//! Signature: chamber 1 stands below the regulator while nothing moves, by the drop that the leak's flow makes in the supply orifice.
//! Confused with: cross_piston_leakage (chamber 2 rises too), regulator_gain_error (the outlet itself is off), supply_restriction.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![reported(EXTERNAL_LEAK.named("orifice_area_m2"), Logarithmic, [1e-10, 1e-4])],
    usual: |p, _| vec![0.02 * p.device.supply_orifice],
    starts: |c, _| shares(&[0.01, 0.05, 0.2], c.plant.device.supply_orifice),
    ..effect("external_leakage", Subsystem::Chambers)
};
