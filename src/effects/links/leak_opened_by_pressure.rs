//! The chamber leaks through something that pressure opens. A seam, a lip or a wall that gives way.
//!
//!     dp/dt = -r (1 + o g) g
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
pub const EFFECT: Effect = Effect {
    name: "leak_opened_by_pressure",
    text: include_str!("leak_opened_by_pressure.rs"),
    which: Which::Only,
    subsystem: Subsystem::Chambers,
    group: LEAK,
    parameters: |_, _| {
        vec![
            reported(
                quantity!("conductance_per_volume_1_per_s", p => p.links.leak.proportional),
                Logarithmic,
                [1e-8, 10.0],
            ),
            reported(
                quantity!("growth_per_pressure_1_per_pa", p => p.links.leak.opening),
                Linear(1e-6),
                [-1e-6, 1e-3],
            ),
        ]
    },
    usual: |_, _| vec![1e-3, 1e-6],
    starts: |_, _| {
        [1e-5, 1e-4, 1e-3, 1e-2, 3e-2, 1e-1]
            .into_iter()
            .flat_map(|rate| [vec![rate, 2e-6], vec![rate, 1e-5]])
            .collect()
    },
};
