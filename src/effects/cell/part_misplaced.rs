//! The part does not lie where the cell believes: it stands out by a shift along the bisector, and by a slope along the edge.
//!
//!     l(s) = shift + tilt (s - L/2)          along a straight edge
//!
//! Small displacements of a rigid body, about the middle of the edge (Siciliano et al., Robotics, 2009, sec. 2.4): round a corner the shift has another share
//! along the bisector (`plant/cell_course.rs`). Turns about the edge and its bisector, and shifts across, are not looked for.
//!
//! Signature: the stroke is off by l/c all along the ride, whatever the force and the speed; the tool touches earlier or later.
//! Confused with: an encoder that is off (which moves the ball by a lever that changes along the path and with the lean), a soft joint (whose part grows
//! with the force), a position sensor's gain (which is off where nothing touches, too).

use super::*;

#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    parameters: |_, _| vec![
        reported(PART_SHIFT.named("shift_m"), Linear(2e-4), [-0.02, 0.02]),
        reported(PART_TILT.named("tilt_m_per_m"), Linear(2e-3), [-0.2, 0.2]),
    ],
    usual: |_, _| vec![8e-4, 4e-3],
    starts: |_, _| vec![vec![0.0, 0.0], vec![1e-3, 0.0], vec![-1e-3, 0.0]],
    ..effect("part_misplaced", Subsystem::Workpiece)
};
