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
use Coordinate::Linear;

/// Name in the vocabulary.
pub(super) const NAME: &str = "joint_encoder_offset";

pub(super) const fn effect<const J: usize>() -> Effect {
    Effect {
        name: numbered(
            [
                "joint_encoder_offset_1",
                "joint_encoder_offset_2",
                "joint_encoder_offset_3",
                "joint_encoder_offset_4",
                "joint_encoder_offset_5",
                "joint_encoder_offset_6",
                "joint_encoder_offset_7",
                "joint_encoder_offset_8",
            ],
            J,
        ),
        subsystem: super::super::Subsystem::Arm,
        group: None,
        parameters: |_| {
            vec![reported(
                Quantity {
                    name: "offset_rad",
                    get: |p| p.cell.encoder_offset[J],
                    set: |p, v| p.cell.encoder_offset[J] = v,
                },
                Linear(5e-4),
                [-0.1, 0.1],
            )]
        },
        usual: |_| vec![1e-3],
        starts: |_| vec![vec![0.0], vec![2e-3], vec![-2e-3]],
    }
}
