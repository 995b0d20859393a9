//! A line that holds air and resists its flow stands before the valve. Between regulator and valve.
//!
//! ```text
//! p_i V / n = m_i R T,   dm_i/dt = n (p_(i-1) - p_i) / R_h - n (p_i - p_(i+1)) / R_h      in n segments
//! ```
//!
//! V volume of the line [m3], R_h its resistance, pressure drop over mass flow [Pa s/kg], p_i and m_i pressure [Pa absolute] and air [kg] of a segment, R
//! specific gas constant [J/(kg K)], T temperature [K], n segments: as many as fit best, up to four, or eight with the last one halved, which are a line of
//! evenly spread resistance.
//! Source: Lumped line of Richer and Hurmuzlu 2000.
//!
//! Signature: The chamber follows the outlet in second order, with a dead time of its own where the line is long; a valve that switches empties the line
//! into the chamber first.
//!
//! Confused with:
//! - extra_dead_volume: behind the valve: of first order.
//! - supply_restriction: of first order: the chamber starts at once.
//! - transport_delay: moves the outlet itself.
//! - solenoid_switching_delay: delays what the valve does, not what the set pressure does.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("hose_volume.rs"),
    parameters: |_, _| vec![
        reported(HOSE_VOLUME.named("volume_m3"), Logarithmic, [1e-6, 2e-3]),
        reported(HOSE_RESISTANCE.named("resistance_pa_s_per_kg"), Logarithmic, [1e6, 5e9]),
        Parameter { choices: &[1.0, 2.0, 3.0, 4.0, 8.0], ..hidden(HOSE_SEGMENTS.named("segments"), Linear(1.0), [1.0, 8.0]) },
    ],
    usual: |_, _| vec![5e-5, 5e7, 1.0],
    starts: |_, _| vec![
        vec![2e-5, 3e7, 2.0],
        vec![5e-5, 5e7, 2.0],
        vec![5e-5, 3e8, 2.0],
        vec![1.5e-4, 5e7, 2.0],
        vec![1.5e-4, 3e8, 2.0],
        vec![4e-4, 1e8, 2.0],
    ],
    ..effect("hose_volume", Subsystem::Chambers)
};
