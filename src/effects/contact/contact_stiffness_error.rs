//! Tool, part or fixture is softer or stiffer than nominal.
//!
//! ```text
//! F = max(0, k d + c d')
//! ```
//!
//! F contact force [N], k stiffness [N/m], d penetration [m], d' its rate [m/s], c damping [N s/m].
//! Source: Spring and damper of Kelvin and Voigt.
//!
//! Signature: At a given force the piston stands deeper or less deep, in proportion to the force; contact rings at another frequency.
//!
//! Confused with:
//! - hertzian_contact: the stiffness grows with the force; recordings at one force alone cannot tell.
//! - surface_offset: the stroke is off by the same at every force.
//! - stroke_sensor_gain_error: off in the air too, in proportion to the stroke.

use super::*;

/// The effect.
pub const EFFECT: Effect = Effect {
    text: include_str!("contact_stiffness_error.rs"),
    group: Some("contact_law"),
    parameters: |p, _| {
        let k = STIFFNESS.get(p);
        vec![reported(STIFFNESS, Logarithmic, [0.01 * k, 50.0 * k])]
    },
    usual: |p, _| vec![0.6 * p.contact.stiffness_at(USUAL_FORCE)],
    starts: |c, _| {
        let k = STIFFNESS.get(c.plant);
        shares(&[0.1, 0.25, 0.5, 0.8, 1.25, 2.5], k)
    },
    ..effect("contact_stiffness_error", Subsystem::Contact)
};
