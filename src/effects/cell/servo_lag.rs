//! The joints' servos are slower, or faster, than believed, all of them alike.
//!
//!     q'' = w^2 (u - q) - 2 w q',   w = 2 pi f
//!
//! Signature: the encoders trail their commands by 2 q'/w; tool and surface hardly show it.
//! Confused with: nothing, for it is seen in a link of its own, from the commands to the encoders, before the device is looked at.

use super::*;

/// The effect; it is fitted on the encoders alone.
#[rustfmt::skip] // A table: one number a line.
pub static SERVO_LAG: Effect = Effect {
    parameters: |_, _| vec![reported(SERVO_BANDWIDTH.named("bandwidth_hz"), Logarithmic, [0.1, 1e3])],
    usual: |_, _| vec![25.0],
    starts: |clues: &Clues<'_>, _| vec![vec![clues.plant.cell.servo_bandwidth]],
    ..effect("servo_lag", Subsystem::Arm)
};
