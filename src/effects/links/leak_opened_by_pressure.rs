//! The chamber leaks through something that pressure opens. A seam, a lip or a wall that gives way.
//!
//! ```text
//! dp/dt = -r (1 + o g) g
//! ```
//!
//! p pressure [Pa], g its excess over the atmosphere [Pa], r conductance by volume at no pressure [1/s], o its growth [1/Pa].
//! Source: First order of a gap's width in the pressure.
//!
//! Signature: A decay far faster than exponential at high pressures that becomes exponential.
//!
//! Confused with:
//! - orifice_leakage: alike while the pressure falls by a small share of itself.
//! - gap_leakage: the same law at o = 1/(2 p_a), p_a the atmosphere; beyond it the walls give way as well, or the flow is not laminar throughout.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("leak_opened_by_pressure.rs"),
    group: LEAK,
    parameters: |_, _| vec![
        reported(PROPORTIONAL_LEAK.named("conductance_per_volume_1_per_s"), Logarithmic, [1e-8, 10.0]),
        reported(LEAK_OPENING.named("growth_per_pressure_1_per_pa"), Linear(1e-6), [-1e-6, 1e-3]),
    ],
    usual: |_, _| vec![1e-3, 1e-6],
    starts: |_, _| [1e-5, 1e-4, 1e-3, 1e-2, 3e-2, 1e-1].into_iter().flat_map(|rate| [vec![rate, 2e-6], vec![rate, 1e-5]]).collect(),
    ..effect("leak_opened_by_pressure", Subsystem::Chambers)
};
