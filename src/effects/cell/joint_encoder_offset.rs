//! A joint's encoder reads too much, so that the arm stands off by it. The servo closes on what it reads, so that the arm stands off by as much.
//!
//!     theta = theta_measured - offset
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
use Coordinate::Linear;

/// Of which joint is to be said.
pub(super) const EFFECT: Effect = Effect {
    name: "joint_encoder_offset",
    text: include_str!("joint_encoder_offset.rs"),
    which: Which::Only,
    subsystem: super::super::Subsystem::Arm,
    group: None,
    parameters: |_, joint| {
        vec![reported(
            Quantity {
                name: "offset_rad",
                index: joint,
                get: |p, joint| p.cell.encoder_offset[joint],
                set: |p, joint, v| p.cell.encoder_offset[joint] = v,
            },
            Linear(5e-4),
            [-0.1, 0.1],
        )]
    },
    usual: |_, _| vec![1e-3],
    starts: |_, _| vec![vec![0.0], vec![2e-3], vec![-2e-3]],
};
