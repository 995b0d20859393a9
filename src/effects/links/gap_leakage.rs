//! The chamber leaks as through a narrow gap, laminar while the air expands.
//!
//! ```text
//! dp/dt = -k (p^2 - p_a^2)
//! ```
//!
//! p pressure and p_a that of the atmosphere [Pa absolute], k conductance by volume [1/(Pa s)], g excess over the atmosphere [Pa].
//! Source: Poiseuille's law for a gas at constant temperature; Egli 1937.
//!
//! Signature: A decay faster than exponential at high pressures, exponential at low ones: by gauge pressure g, k (2 p_a g + g^2).
//!
//! Confused with:
//! - leak_in_proportion: alike while the pressure falls by a small share of itself; exponential throughout.
//! - orifice_leakage: alike while the pressure falls by a small share of itself; falls to an end in finite time.
//! - leak_opened_by_pressure: the same law at a growth of 1/(2 p_a); another growth is not a gap of fixed width.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("gap_leakage.rs"),
    group: LEAK,
    parameters: |_, _| vec![reported(GAP_LEAK.named("gap_conductance_per_volume_1_per_pa_s"), Logarithmic, [1e-15, 1e-3])],
    usual: |_, _| vec![1e-9],
    starts: |_, _| each(&[1e-11, 1e-10, 1e-9, 1e-8, 1e-7]),
    ..effect("gap_leakage", Subsystem::Chambers)
};
