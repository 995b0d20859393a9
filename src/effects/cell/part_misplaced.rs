//! The part stands out, or back, along the bisector of its edge, and slopes along it.
//!
//! ```text
//! l(s) = shift + tilt (s - L/2)          along a straight edge
//! ```
//!
//! l how far the part stands out along the bisector of its edge, positive towards the tool [m], s place along the edge and L its length [m], shift [m] and
//! tilt [m/m]. Round a corner the shift has another share along the bisector. Turns about the edge and its bisector, and shifts across, are not looked for.
//! Source: Small displacements of a rigid body, about the middle of the edge (Siciliano et al., Robotics, 2009, sec. 2.4).
//!
//! Signature: The stroke is off by l/c all along the ride, c cosine between bisector and slide, whatever the force and the speed; the tool touches earlier
//! or later.
//!
//! Confused with:
//! - joint_encoder_offset: moves the ball by a lever that changes along the path and with the lean.
//! - compliant_joint: its part grows with the force.
//! - stroke_sensor_gain_error: off where nothing touches, too.

use super::*;

#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    text: include_str!("part_misplaced.rs"),
    parameters: |_, _| vec![
        reported(PART_SHIFT.named("shift_m"), Linear(2e-4), [-0.02, 0.02]),
        reported(PART_TILT.named("tilt_m_per_m"), Linear(2e-3), [-0.2, 0.2]),
    ],
    usual: |_, _| vec![8e-4, 4e-3],
    starts: |_, _| vec![vec![0.0, 0.0], vec![1e-3, 0.0], vec![-1e-3, 0.0]],
    ..effect("part_misplaced", Subsystem::Workpiece)
};
