//! A leak through a narrow gap, laminar while the air expands on its way.
//!
//!     dp/dt = -k (p^2 - p_a^2)
//!
//! p pressure and p_a the atmosphere's [Pa absolute], k conductance by volume [1/(Pa s)]. Poiseuille's law for a gas at constant temperature; Egli 1937.
//!
//! Signature: a decay faster than exponential at high pressures, exponential at low ones: by gauge pressure g, k (2 p_a g + g^2).
//! Confused with: the other laws of a leak, while the pressure falls by a small share of itself.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    group: LEAK,
    parameters: |_, _| vec![reported(GAP_LEAK.named("gap_conductance_per_volume_1_per_pa_s"), Logarithmic, [1e-15, 1e-3])],
    usual: |_, _| vec![1e-9],
    starts: |_, _| each(&[1e-11, 1e-10, 1e-9, 1e-8, 1e-7]),
    ..effect("gap_leakage", Subsystem::Chambers)
};
