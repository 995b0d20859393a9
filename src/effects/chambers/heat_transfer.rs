//! Air in the chambers warms up as it is compressed and cools as it expands, and exchanges heat with their walls.
//!
//!     dE/dt = sum(m_dot_in c_p T_in) - sum(m_dot_out c_p T) - p dV/dt + G (T_w - T),   p V = (k - 1) E
//!
//! E internal energy [J], T gas and T_w wall temperature [K], G conductance from gas to wall of each chamber [W/K], p pressure [Pa], V volume [m3],
//! c_p specific heat [J/(kg K)], k ratio of specific heats [1]. First law for an open volume; Carneiro and Gomes de Almeida 2006 for G in small cylinders.
//!
//! Signature: after a fast stroke the pressure overshoots and creeps back within m c_v / G; filling is faster, up to k times.
//! Confused with: extra_dead_volume and supply_restriction (change the filling time, no creep), hose_volume.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    parameters: |_, _| vec![reported(WALL_CONDUCTANCE.named("wall_conductance_w_per_k"), Logarithmic, [1e-3, 10.0])],
    usual: |_, _| vec![0.1],
    starts: |_, _| each(&[0.01, 0.05, 0.2, 0.8]),
    ..effect("heat_transfer", Subsystem::Chambers)
};
