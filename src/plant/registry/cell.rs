//! Arm and part of a cell.

use std::f64::consts::PI;

use super::{ANY, Number, numbers};
use crate::plant::cell_parameters::DAMPING_TIME;

#[rustfmt::skip] // A table: one number a line.
numbers! { CELL:
    /// bandwidth of the joints' servos, critically damped
    SERVO_BANDWIDTH = "joints.servo_bandwidth_hz", [0.1, f64::INFINITY], (p => p.cell.servo_bandwidth), f64::INFINITY;
    /// spring between motor and link
    JOINT_STIFFNESS = "joints.stiffness_n_m_per_rad", [100.0, f64::INFINITY], (p, joint => p.cell.joint_stiffness[joint]), f64::INFINITY;
    /// damping of that spring over its stiffness
    JOINT_DAMPING = "joints.damping_time_s", [1e-4, 0.05], (|p, _| p.cell.joint_damping[0], |p, _, v| p.cell.joint_damping.fill(v)), DAMPING_TIME;
    /// play between motor and link, from flank to flank
    JOINT_PLAY = "joints.play_rad", [0.0, PI / 36.0], (p, joint => p.cell.joint_play[joint]), 0.0;
    /// dry friction of the joint
    DRIVE_FRICTION = "joints.friction_n_m", [0.0, 1e4], (p, joint => p.cell.joint_friction[joint]);
    /// what a joint's encoder reads beyond the truth
    ENCODER_OFFSET = "joints.encoder_offset_rad", ANY, (p, joint => p.cell.encoder_offset[joint]);
    /// Coulomb friction
    EDGE_FRICTION = "contact.friction_coefficient", [0.0, 2.0], (p => p.cell.friction), 0.15;
    /// stroke at which a recording starts
    START_STROKE = "slide.start_stroke_m", ANY, (p => p.cell.start_stroke);
    /// how far the part stands out along the bisector at the middle of its edge
    PART_SHIFT = "part.shift_m", ANY, (p => p.cell.part_shift);
    /// slope of that along the edge
    PART_TILT = "part.tilt_m_per_m", ANY, (p => p.cell.part_tilt);
    /// middle of a burr, from the start of the edge
    BURR_POSITION = "burr.position_m", ANY, (p => p.cell.burr.position);
    /// its height along the bisector
    BURR_HEIGHT = "burr.height_m", ANY, (p => p.cell.burr.height);
    /// its standard width
    BURR_WIDTH = "burr.width_m", ANY, (p => p.cell.burr.width);
}
