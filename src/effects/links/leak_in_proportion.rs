//! The chamber leaks in proportion to its gauge pressure, as through pores. Permeation, or a long narrow gap at a small pressure.
//!
//! ```text
//! dp/dt = -r g
//! ```
//!
//! p pressure [Pa], g its excess over the atmosphere [Pa], r conductance by volume, one over the time constant [1/s].
//! Source: Darcy 1856.
//!
//! Signature: An exponential decay.
//!
//! Confused with:
//! - orifice_leakage: alike while the pressure falls by a small share of itself; falls to an end in finite time.
//! - gap_leakage: alike while the pressure falls by a small share of itself; falls faster at high pressures.
//! - a drift of the sensor: goes on at no pressure.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("leak_in_proportion.rs"),
    group: LEAK,
    parameters: |_, _| vec![reported(PROPORTIONAL_LEAK.named("conductance_per_volume_1_per_s"), Logarithmic, [1e-8, 10.0])],
    usual: |_, _| vec![1e-3],
    starts: |_, _| each(&[1e-5, 1e-4, 1e-3, 1e-2, 0.1]),
    ..effect("leak_in_proportion", Subsystem::Chambers)
};
