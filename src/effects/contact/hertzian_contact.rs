//! Contact stiffens as it is pressed, as a ball on a flat does.
//!
//! ```text
//! F = max(0, k d^(3/2) + c d')
//! ```
//!
//! F contact force [N], k stiffness [N/m^1.5], d penetration [m], d' its rate [m/s], c damping [N s/m].
//! Source: Hertz 1882; Johnson, Contact Mechanics, 1985, eq. (4.23).
//!
//! Signature: Soft at first touch, stiffer under load: penetration goes with the 2/3 power of the force.
//!
//! Confused with:
//! - contact_stiffness_error: in proportion to the force; recordings at one force alone cannot tell.
//! - surface_offset: the stroke is off by the same at every force.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("hertzian_contact.rs"),
    group: Some("contact_law"),
    parameters: |_, _| vec![reported(HERTZ_STIFFNESS.named("stiffness_n_per_m15"), Logarithmic, [1e5, 1e10])],
    usual: |p, _| vec![p.contact.stiffness_at(USUAL_FORCE).powf(1.5) / USUAL_FORCE.sqrt()],
    starts: |c, _| {
        // As stiff as the nominal contact at a force that such a device is used at [N].
        let k = STIFFNESS.get(c.plant);
        let d = 120.0 / k;
        let a = 120.0 / d.powf(1.5);
        shares(&[0.2, 0.5, 1.0, 2.5], a)
    },
    ..effect("hertzian_contact", Subsystem::Contact)
};
