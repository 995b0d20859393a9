//! A leak whose flow grows with the gauge pressure: pores, permeation, a long narrow gap at a small pressure.
//!
//!     dp/dt = -r g
//!
//! p pressure, g its excess over the atmosphere [Pa], r conductance by volume, one over the time constant [1/s]. Darcy 1856.
//!
//! Signature: an exponential decay.
//! Confused with: the other laws of a leak, while the pressure falls by a small share of itself; a drift of the sensor.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    group: LEAK,
    parameters: |_, _| vec![reported(PROPORTIONAL_LEAK.named("conductance_per_volume_1_per_s"), Logarithmic, [1e-8, 10.0])],
    usual: |_, _| vec![1e-3],
    starts: |_, _| each(&[1e-5, 1e-4, 1e-3, 1e-2, 0.1]),
    ..effect("leak_in_proportion", Subsystem::Chambers)
};
