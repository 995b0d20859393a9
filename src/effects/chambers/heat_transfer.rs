//! Air in the chambers warms up and cools down, and exchanges heat with their walls. Compression warms it, expansion cools it.
//!
//! ```text
//! dE/dt = sum(m_dot_in c_p T_in) - sum(m_dot_out c_p T) - p dV/dt + G (T_w - T),   p V = (k - 1) E
//! ```
//!
//! E internal energy [J], T gas and T_w wall temperature [K], T_in that of what flows in [K], m_dot flows [kg/s], G conductance from gas to wall of each
//! chamber [W/K], p pressure [Pa absolute], V volume [m3], c_p specific heat at constant pressure [J/(kg K)], k ratio of specific heats [1].
//! Source: First law for an open volume; Carneiro and Gomes de Almeida 2006 for G in small cylinders.
//!
//! Signature: Filling and venting take another time, up to a factor k; after a fast stroke or filling the pressure overshoots and creeps back within m c_v /
//! G, m mass of the air and c_v its specific heat at constant volume.
//!
//! Confused with:
//! - extra_dead_volume: changes the time of filling, without a creep after it.
//! - supply_restriction: changes the time of filling, without a creep after it.
//! - hose_volume: delays the chamber against the outlet, without an overshoot.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("heat_transfer.rs"),
    parameters: |_, _| vec![reported(WALL_CONDUCTANCE.named("wall_conductance_w_per_k"), Logarithmic, [1e-3, 10.0])],
    usual: |_, _| vec![0.1],
    starts: |_, _| each(&[0.01, 0.05, 0.2, 0.8]),
    ..effect("heat_transfer", Subsystem::Chambers)
};
