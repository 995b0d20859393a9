//! The chambers' dead volume is off its nominal value. Fittings, ports and short lines behind the valve.
//!
//! ```text
//! V_1 = A_1 x + V_d,   V_2 = A_2 (L - x) + V_d
//! ```
//!
//! V_1 and V_2 volumes [m3], V_d dead volume of each [m3], A_1 and A_2 piston areas [m2], x stroke [m], L full stroke [m].
//! Source: Geometry; source paper eq. (4).
//!
//! Signature: Chambers fill and vent slower, most where they are smallest: chamber 1 near the retracted end, chamber 2 near the other; the trapped air is a
//! softer spring.
//!
//! Confused with:
//! - supply_restriction: the same at every stroke.
//! - hose_volume: before the valve: of second order, and of the side that is supplied.
//! - heat_transfer: creeps after the filling.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("extra_dead_volume.rs"),
    parameters: |p, _| {
        let a = p.device.dead_volume;
        vec![reported(DEAD_VOLUME.named("dead_volume_m3"), Logarithmic, [0.1 * a, 20.0 * a])]
    },
    usual: |p, _| vec![1.5 * p.device.dead_volume],
    starts: |c, _| shares(&[0.35, 0.55, 0.8, 1.25, 1.8, 3.0], c.plant.device.dead_volume),
    ..effect("extra_dead_volume", Subsystem::Chambers)
};
