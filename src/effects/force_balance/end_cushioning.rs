//! The piston is damped as it comes near an end of its stroke. A pneumatic cushion traps air that leaves through a needle valve.
//!
//! ```text
//! F = -c (1 - d / l) v     for d < l and towards the end,     0 otherwise
//! ```
//!
//! F force along extension [N], c damping at the very end [N s/m], l length [m], d distance from the end [m], v speed of extension [m/s].
//! Source: Cushioned cylinders of ISO 15552; the linear taper is the simplest that ends at l.
//!
//! Signature: Strokes to an end slow down over its last millimetres; leaving it is free.
//!
//! Confused with:
//! - exhaust_restriction: brakes all along the stroke.
//! - coulomb_viscous_friction: brakes all along the stroke, and both ways.
//! - end stops of another damping: act within micrometres of the end.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("end_cushioning.rs"),
    parameters: |_, _| vec![
        reported(CUSHION_DAMPING.named("damping_n_s_per_m"), Logarithmic, [5.0, 1e5]),
        reported(CUSHION_LENGTH.named("length_m"), Logarithmic, [2e-4, 0.025]),
    ],
    usual: |_, _| vec![800.0, 8e-3],
    starts: |_, _| vec![vec![300.0, 0.004], vec![300.0, 0.01], vec![1500.0, 0.004], vec![1500.0, 0.01]],
    ..effect("end_cushioning", Subsystem::ForceBalance)
};
