//! A joint's encoder reads too much: the servo closes on it, so that the arm stands off by as much.
//!
//!     theta = theta_measured - offset
//!
//! (Mooring, Roth, Driels, Fundamentals of Manipulator Calibration, 1991, sec. 2: joint offsets.)
//!
//! Signature: the stroke is off by the joint's lever times the offset, which changes along the path and with the lean, whatever the force.
//! Confused with: a misplaced part (a straight line along the edge, the same in every lean), the other joints: two whose axes are parallel differ only
//! by their levers, and a joint whose axis passes the ball, or lies in the bisector, moves nothing.

use super::*;

/// Of which joint is to be said.
#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    parameters: |_, joint| vec![reported(ENCODER_OFFSET.named("offset_rad").of(joint), Linear(5e-4), [-0.1, 0.1])],
    usual: |_, _| vec![1e-3],
    starts: |_, _| vec![vec![0.0], vec![2e-3], vec![-2e-3]],
    ..effect("joint_encoder_offset", Subsystem::Arm)
};
