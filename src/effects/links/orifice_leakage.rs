//! The chamber leaks as through a short hole.
//!
//! ```text
//! dp/dt = -(A C/V) sqrt(R T) p f(p_a/p)
//! ```
//!
//! p pressure and p_a that of the atmosphere [Pa absolute], A C/V equivalent area by volume [1/m], R specific gas constant [J/(kg K)], T temperature [K], f
//! the choked or subsonic flow function.
//! Source: The source paper's eqs. (9) to (11), an isentropic nozzle.
//!
//! Signature: A decay in proportion to the absolute pressure down to the critical ratio, then ever slower, to an end in finite time.
//!
//! Confused with:
//! - gap_leakage: alike while the pressure falls by a small share of itself; becomes exponential at low pressures.
//! - leak_in_proportion: alike while the pressure falls by a small share of itself; exponential throughout.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("orifice_leakage.rs"),
    group: LEAK,
    parameters: |_, _| vec![reported(ORIFICE_LEAK.named("orifice_area_per_volume_1_per_m"), Logarithmic, [1e-11, 1e-1])],
    usual: |_, _| vec![1e-5],
    starts: |_, _| each(&[5e-8, 5e-7, 5e-6, 5e-5, 5e-4]),
    ..effect("orifice_leakage", Subsystem::Chambers)
};
