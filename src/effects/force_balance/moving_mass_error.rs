//! The moving mass is off its nominal value. Another tool, a part left off, a hose that hangs on.
//!
//! ```text
//! m a = F
//! ```
//!
//! m moving mass [kg], a acceleration along extension [m/s2], F sum of the forces, weight included [N].
//! Source: Newton's second law.
//!
//! Signature: Accelerations are off in proportion, and where the axis is not level the weight is too.
//!
//! Confused with:
//! - inertial_crosstalk: the load cell alone sees it; the motion is nominal.
//! - axial_force_offset: a force without inertia: accelerations in free motion are off by the same, not in proportion.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("moving_mass_error.rs"),
    parameters: |p, _| {
        let m = p.device.moving_mass;
        vec![reported(MOVING_MASS.named("mass_kg"), Logarithmic, [0.2 * m, 5.0 * m])]
    },
    usual: |p, _| vec![1.2 * p.device.moving_mass],
    starts: |c, _| shares(&[0.6, 0.8, 0.92, 1.08, 1.25, 1.7], c.plant.device.moving_mass),
    ..effect("moving_mass_error", Subsystem::ForceBalance)
};
