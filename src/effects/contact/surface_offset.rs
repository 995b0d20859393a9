//! The surface is not where the robot has it, positive along extension.
//!
//! ```text
//! x_s = x_robot + o
//! ```
//!
//! x_s where the surface is met along the stroke and x_robot where the robot has it [m], o offset, positive along extension [m].
//! Source: Kinematics.
//!
//! Signature: Contact begins early or late, and the stroke is off by the same length wherever it touches.
//!
//! Confused with:
//! - stroke_sensor_gain_error: in proportion to the stroke, in the air too.
//! - contact_stiffness_error: in proportion to the force.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("surface_offset.rs"),
    parameters: |_, _| vec![reported(SURFACE_OFFSET.named("offset_m"), Linear(5e-4), [-0.02, 0.02])],
    usual: |_, _| vec![5e-4],
    starts: |_, _| each(&[-2e-3, -6e-4, 6e-4, 2e-3]),
    ..effect("surface_offset", Subsystem::Contact)
};
