//! Something elastic pulls the piston back, in proportion to its stroke. A return spring, a cable, a hose that is dragged along.
//!
//! ```text
//! F = -k x
//! ```
//!
//! F force along extension [N], k stiffness [N/m], x stroke from the retracted end, where the spring is relaxed [m].
//! Source: Hooke's law.
//!
//! Signature: A lack of force that grows with the stroke, standing still or moving.
//!
//! Confused with:
//! - axial_force_offset: the same at every stroke.
//! - stroke_sensor_gain_error: the stroke is off, the force is not.
//! - contact_stiffness_error: acts in contact alone.
//! - surface_offset: the stroke at which contact begins is off; the force at a pressure is not.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("return_spring_load.rs"),
    parameters: |_, _| vec![reported(RETURN_STIFFNESS.named("stiffness_n_per_m"), Linear(100.0), [-5e4, 5e4])],
    usual: |_, _| vec![400.0],
    starts: |_, _| each(&[0.0, 400.0]),
    ..effect("return_spring_load", Subsystem::ForceBalance)
};
