//! What a wrench sensor's readings in still postures say: the axes that they are given in, zero, weight and centre of what hangs on the sensor.
//!
//! Every way in which readings may be given (`frame`) is fitted by least squares (`fit`); each is worth
//!
//! ```text
//! ln L - (k/2) ln N + ln p(frame) + ln p(tilt)
//! ```
//!
//! L likelihood with the scatters integrated out, k numbers of the turn, N rows (Schwarz 1978, Annals of Statistics 6, 461), p(frame) what is to be expected
//! before any reading, p(tilt) how well the weight lies along gravity: zero and weight change places where the pose is the inverse, and the readings' fit is
//! then the same. Leaves out: gains, crosstalk and drift of the sensor; a pose that errs from posture to posture, but for its share in the intervals.

mod account;
mod answer;
pub mod diagnosed;
pub mod estimate;
pub mod fit;
pub mod found;
pub mod frame;
pub mod model;
pub mod nominal;
pub mod select;
#[cfg(test)]
mod tests;

use nalgebra::{Matrix3, Vector3};

/// A still posture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posture {
    /// Pose of the sensor's link as logged: vectors in its axes to vectors in the base's.
    pub base_from_sensor: Matrix3<f64>,
    /// Force as read [N].
    pub force: Vector3<f64>,
    /// Torque as read [N m]; of a recording either all have one or none.
    pub torque: Option<Vector3<f64>>,
}

/// Postures of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct StillRecording {
    /// Its name.
    pub name: String,
    /// Its postures, in the order of its rows.
    pub postures: Vec<Posture>,
}

/// Sine of the turn, root mean square, about the axis that postures turn the sensor about least [1]: 0 where all turn about one.
#[must_use]
pub fn least_turn(postures: &[Posture]) -> f64 {
    let sum = postures
        .iter()
        .map(|p| p.base_from_sensor)
        .sum::<Matrix3<f64>>();
    let mean = sum / postures.len().max(1) as f64;
    (1.0 - mean.singular_values().max().powi(2)).max(0.0).sqrt()
}
