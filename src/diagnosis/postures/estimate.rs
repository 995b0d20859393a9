//! Numbers of a fit with their 95 % intervals.
//!
//! Each interval is the wider of two: by the scatter that is left, and by what each posture left out in turn changes (jackknife: Efron and Stein 1981, Annals of
//! Statistics 9, 586), since the six readings of a posture err together where its pose does.

use nalgebra::Vector3;

use super::Posture;
use super::fit::{Fit, refit};
use crate::stats::student_95;

/// Fewest postures that one can be left out of.
const LEFT_OUT_FROM: usize = 6;
/// Step of a derivative, in standard deviations [1].
const STEP: f64 = 1e-2;

/// Value and its 95 % interval.
pub type Interval = [f64; 3];

/// Numbers of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers {
    /// Weight [N].
    pub weight: Interval,
    /// Angle of the weight against gravity [rad].
    pub tilt: Interval,
    /// Angle by which the axes are turned, about z where they are about z [rad].
    pub turn: Interval,
    /// Reading of the force without any load, in the sensor's axes [N].
    pub zero: [Interval; 3],
    /// Reading of the torque without any load [N m].
    pub torque_zero: [Interval; 3],
    /// Centre of mass from the sensor's origin, in the axes of its link [m].
    pub centre: [Interval; 3],
}

/// Count of them.
const COUNT: usize = 12;

/// In one row.
fn values(fit: &Fit, gravity: Vector3<f64>) -> [f64; COUNT] {
    let weight = fit.weight();
    let [zero, torque_zero] = fit.zeros();
    let centre = fit.numbers[3];
    let angle = match fit.frame.turn.count() {
        // Readings are turned back by what the axes are turned by.
        1 => -fit.turn[(1, 0)].atan2(fit.turn[(0, 0)]),
        _ => (0.5 * (fit.turn.trace() - 1.0)).clamp(-1.0, 1.0).acos(),
    };
    let tilt = weight.angle(&gravity);
    [
        weight.norm(),
        tilt,
        angle,
        zero.x,
        zero.y,
        zero.z,
        torque_zero.x,
        torque_zero.y,
        torque_zero.z,
        centre.x,
        centre.y,
        centre.z,
    ]
}

/// Numbers of a fit, intervals by scatter and postures left out in turn.
#[must_use]
pub fn numbers(postures: &[Posture], fit: &Fit, gravity: Vector3<f64>, noise: [f64; 2]) -> Numbers {
    let found = values(fit, gravity);
    let by_scatter = student_95(fit.freedom);
    let mut half: [f64; COUNT] = by_delta(fit, gravity, &found).map(|e| by_scatter * e);
    if postures.len() >= LEFT_OUT_FROM {
        let errors = by_postures(postures, fit, gravity, noise, &found);
        let by_count = student_95((postures.len() - 1) as f64);
        half = std::array::from_fn(|i| half[i].max(by_count * errors[i]));
    }
    let of = |i: usize| [found[i], found[i] - half[i], found[i] + half[i]];
    let [tilt, low, high] = of(1);
    Numbers {
        weight: of(0),
        tilt: [tilt, low.max(0.0), high],
        turn: of(2),
        zero: std::array::from_fn(|i| of(3 + i)),
        torque_zero: std::array::from_fn(|i| of(6 + i)),
        centre: std::array::from_fn(|i| of(9 + i)),
    }
}

/// Standard errors from the covariance of the fit.
fn by_delta(fit: &Fit, gravity: Vector3<f64>, found: &[f64; COUNT]) -> [f64; COUNT] {
    let count = fit.covariance.nrows();
    let root = fit.covariance.clone().cholesky().map(|c| c.l());
    let Some(root) = root else {
        return [f64::NAN; COUNT];
    };
    let mut variances = [0.0; COUNT];
    for column in 0..count {
        let moved = values(&fit.stepped(&(root.column(column) * STEP)), gravity);
        for i in 0..COUNT {
            variances[i] += (difference(i, moved[i], found[i]) / STEP).powi(2);
        }
    }
    variances.map(f64::sqrt)
}

/// Standard errors from postures left out in turn.
fn by_postures(
    postures: &[Posture],
    fit: &Fit,
    gravity: Vector3<f64>,
    noise: [f64; 2],
    found: &[f64; COUNT],
) -> [f64; COUNT] {
    let without = (0..postures.len()).filter_map(|left_out| {
        let mut others = postures.to_vec();
        others.remove(left_out);
        let moved = values(&refit(&others, fit, noise)?, gravity);
        Some(std::array::from_fn(|i| difference(i, moved[i], found[i])))
    });
    let changes: Vec<[f64; COUNT]> = without.collect();
    let count = changes.len().max(1) as f64;
    std::array::from_fn(|i| {
        let mean = changes.iter().map(|c| c[i]).sum::<f64>() / count;
        let squares: f64 = changes.iter().map(|c| (c[i] - mean).powi(2)).sum();
        (squares * (count - 1.0) / count).sqrt()
    })
}

/// Of two values of a number; an angle goes round.
fn difference(index: usize, one: f64, other: f64) -> f64 {
    match index {
        2 => (one - other).sin().atan2((one - other).cos()),
        _ => one - other,
    }
}
