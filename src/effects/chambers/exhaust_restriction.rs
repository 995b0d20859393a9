//! Air leaves through an orifice off its nominal area. A clogged or missing silencer.
//!
//! ```text
//! m_dot = A C p_u / sqrt(R T) f(p_d / p_u)
//! ```
//!
//! m_dot flow [kg/s], A area of the orifice [m2], C discharge coefficient [1], p_u and p_d upstream and downstream pressure [Pa absolute], R specific gas
//! constant [J/(kg K)], T temperature [K], f the choked or subsonic flow function.
//! Source: The source paper's eqs. (9) to (11), an isentropic nozzle.
//!
//! Signature: The vented chamber stays under pressure while the piston moves, and brakes it or lets it run; nothing at rest.
//!
//! Confused with:
//! - coulomb_viscous_friction: brakes with no pressure behind it.
//! - extra_dead_volume: slows the chambers on either side of the piston, filling and venting.
//! - supply_restriction: of the other way: filling, not venting.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("exhaust_restriction.rs"),
    parameters: |p, _| {
        let a = p.device.exhaust_orifice;
        vec![reported(EXHAUST_ORIFICE.named("orifice_area_m2"), Logarithmic, [0.05 * a, 20.0 * a])]
    },
    usual: |p, _| vec![0.5 * p.device.exhaust_orifice],
    starts: |c, _| shares(&[0.35, 0.55, 0.8, 1.25, 1.8, 3.0], c.plant.device.exhaust_orifice),
    ..effect("exhaust_restriction", Subsystem::Chambers)
};
