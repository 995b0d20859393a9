//! Air enters through an orifice off its nominal area. A pinched hose, a half open valve, another fitting.
//!
//! ```text
//! m_dot = A C p_u / sqrt(R T) f(p_d / p_u)
//! ```
//!
//! m_dot flow [kg/s], A area of the orifice [m2], C discharge coefficient [1], p_u and p_d upstream and downstream pressure [Pa absolute], R specific gas
//! constant [J/(kg K)], T temperature [K], f the choked or subsonic flow function.
//! Source: The source paper's eqs. (9) to (11), an isentropic nozzle.
//!
//! Signature: The force follows the regulator's outlet later or earlier, in both directions; nothing at rest.
//!
//! Confused with:
//! - extra_dead_volume: the product of both sets the time of filling: distinguished where a stroke changes the volume.
//! - hose_volume: of second order: the chamber starts flat after a step.
//! - heat_transfer: creeps after the filling.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("supply_restriction.rs"),
    parameters: |p, _| {
        let a = p.device.supply_orifice;
        vec![reported(SUPPLY_ORIFICE.named("orifice_area_m2"), Logarithmic, [0.05 * a, 20.0 * a])]
    },
    usual: |p, _| vec![0.5 * p.device.supply_orifice],
    starts: |c, _| shares(&[0.35, 0.55, 0.8, 1.25, 1.8, 3.0], c.plant.device.supply_orifice),
    ..effect("supply_restriction", Subsystem::Chambers)
};
