//! The surface is not where the robot has it, positive along extension.
//!
//!     x_s = x_robot + o
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
pub const EFFECT: Effect = Effect {
    name: "surface_offset",
    text: include_str!("surface_offset.rs"),
    which: Which::Only,
    subsystem: Subsystem::Contact,
    group: None,
    parameters: |_, _| {
        vec![reported(
            quantity!("offset_m", p => p.contact.surface_offset),
            Linear(5e-4),
            [-0.02, 0.02],
        )]
    },
    usual: |_, _| vec![5e-4],
    starts: |_, _| each(&[-2e-3, -6e-4, 6e-4, 2e-3]),
};
