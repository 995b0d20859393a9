//! A joint's encoder reads too much, so that the arm stands off by it. The servo closes on what it reads, so that the arm stands off by as much.
//!
//! ```text
//! theta = theta_measured - offset
//! ```
//!
//! theta angle of the joint and theta_measured that which its encoder reads [rad], offset how much it reads too much [rad].
//! Source: Mooring, Roth, Driels, Fundamentals of Manipulator Calibration, 1991, sec. 2: joint offsets.
//!
//! Signature: The stroke is off by the joint's lever times the offset, which changes along the path and with the lean, whatever the force.
//!
//! Confused with:
//! - part_misplaced: a straight line along the edge, the same in every lean.
//! - joint_backlash: the sign changes with that of the torque.
//! - joint_encoder_offset of another joint: two whose axes are parallel differ only by their levers; a joint whose axis passes the ball, or lies in the
//!   bisector, moves nothing.

use super::*;

/// Of which joint is to be said.
#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    text: include_str!("joint_encoder_offset.rs"),
    parameters: |_, joint| vec![reported(ENCODER_OFFSET.named("offset_rad").of(joint), Linear(5e-4), [-0.1, 0.1])],
    usual: |_, _| vec![1e-3],
    starts: |_, _| vec![vec![0.0], vec![2e-3], vec![-2e-3]],
    ..effect("joint_encoder_offset", Subsystem::Arm)
};
