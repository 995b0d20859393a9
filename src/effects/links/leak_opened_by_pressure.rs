//! A leak that pressure opens: a seam, a lip or a wall that gives way.
//!
//!     dp/dt = -r (1 + o g) g
//!
//! p pressure, g its excess over the atmosphere [Pa], r conductance by volume at no pressure [1/s], o its growth [1/Pa]. First order of a gap's width in the
//! pressure. At o = 1/(2 p_a) it is a narrow gap's law (gap_leakage), beyond it the walls give way as well, or the flow is not laminar throughout.
//!
//! Signature: a decay far faster than exponential at high pressures that becomes exponential.
//! Confused with: orifice and gap, while the pressure falls by a small share of itself.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    group: LEAK,
    parameters: |_, _| vec![
        reported(PROPORTIONAL_LEAK.named("conductance_per_volume_1_per_s"), Logarithmic, [1e-8, 10.0]),
        reported(LEAK_OPENING.named("growth_per_pressure_1_per_pa"), Linear(1e-6), [-1e-6, 1e-3]),
    ],
    usual: |_, _| vec![1e-3, 1e-6],
    starts: |_, _| [1e-5, 1e-4, 1e-3, 1e-2, 3e-2, 1e-1].into_iter().flat_map(|rate| [vec![rate, 2e-6], vec![rate, 1e-5]]).collect(),
    ..effect("leak_opened_by_pressure", Subsystem::Chambers)
};
