//! The joints' servos follow their commands at a bandwidth off its nominal value. All of them alike.
//!
//! ```text
//! q'' = w^2 (u - q) - 2 w q',   w = 2 pi f
//! ```
//!
//! q angle of a joint and u its command [rad], q' and q'' speed [rad/s] and acceleration [rad/s2], w natural frequency [rad/s], f bandwidth [Hz].
//! Source: Critically damped servo of second order (Ogata, Modern Control Engineering, 5.3).
//!
//! Signature: The encoders trail their commands by 2 q'/w; tool and surface hardly show it.
//!
//! Confused with:
//! - nothing: it is seen in a link of its own, from the commands to the encoders, before the device is looked at.

use super::*;

/// The effect; it is fitted on the encoders alone.
#[rustfmt::skip] // A table: one number a line.
pub static SERVO_LAG: Effect = Effect {
    text: include_str!("servo_lag.rs"),
    parameters: |_, _| vec![reported(SERVO_BANDWIDTH.named("bandwidth_hz"), Logarithmic, [0.1, 1e3])],
    usual: |_, _| vec![25.0],
    starts: |clues: &Clues<'_>, _| vec![vec![clues.plant.cell.servo_bandwidth]],
    ..effect("servo_lag", Subsystem::Arm)
};
