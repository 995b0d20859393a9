//! Numbers of a fit with their 95 % intervals.
//!
//! Each interval is the wider of two: by the scatter that is left, and by postures as clusters, since the six readings of a posture err together where its
//! pose does. The latter is that of postures left out in turn, with the freedom that its own estimate has: few postures carry most of what is known of a
//! number (Bell and McCaffrey 2002, Survey Methodology 28, 169).

use nalgebra::{DMatrix, DVector, Rotation3, Vector3};

use super::Posture;
use super::fit::Fit;
use super::nominal::Nominal;
use crate::stats::student_95;

/// Fewest postures that one can be left out of.
const LEFT_OUT_FROM: usize = 6;
/// Step of a derivative, in standard deviations [1].
const STEP: f64 = 1e-2;
/// Readings of a posture.
const READINGS: usize = 6;

/// Value and its 95 % interval.
pub type Interval = [f64; 3];

/// Numbers of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers {
    /// Weight [N].
    pub weight: Interval,
    /// Mass, by the size of gravity [kg].
    pub mass: Interval,
    /// Angle of the weight against gravity [rad].
    pub tilt: Interval,
    /// Roll and pitch of the base by which the weight lies so, where gravity points down in it [rad].
    pub lean: [Interval; 2],
    /// Angle by which the axes are turned, about z where they are about z [rad].
    pub turn: Interval,
    /// Reading of the force without any load, in the sensor's axes [N].
    pub zero: [Interval; 3],
    /// Reading of the torque without any load [N m].
    pub torque_zero: [Interval; 3],
    /// Centre of mass from the sensor's origin, in the axes of its link [m].
    pub centre: [Interval; 3],
}

/// Count of values.
const COUNT: usize = 14;
/// Place of the turn among them, which goes round.
const TURN: usize = 4;

/// In one row: weight, tilt, roll, pitch, turn, zeros, centre.
fn values(fit: &Fit, gravity: Vector3<f64>) -> [f64; COUNT] {
    let weight = fit.weight();
    let [zero, torque_zero] = fit.zeros();
    let centre = fit.numbers[3];
    let angle = match fit.frame.turn.count() {
        // Readings are turned back by what the axes are turned by.
        0 | 1 => -fit.turn[(1, 0)].atan2(fit.turn[(0, 0)]),
        _ => (0.5 * (fit.turn.trace() - 1.0)).clamp(-1.0, 1.0).acos(),
    };
    let down = Rotation3::rotation_between(&gravity, &-Vector3::z());
    let along = down.unwrap_or_else(Rotation3::identity) * weight.normalize();
    let mut row = [0.0; COUNT];
    row[0] = weight.norm();
    row[1] = weight.angle(&gravity);
    row[2] = (-along.y).atan2(-along.z);
    row[3] = along.x.clamp(-1.0, 1.0).asin();
    row[TURN] = angle;
    for (place, vector) in [zero, torque_zero, centre].iter().enumerate() {
        row[5 + 3 * place..8 + 3 * place].copy_from_slice(vector.as_slice());
    }
    row
}

/// Numbers of a fit with their intervals.
#[must_use]
pub fn numbers(postures: &[Posture], fit: &Fit, nominal: &Nominal) -> Numbers {
    let found = values(fit, nominal.gravity);
    let root = fit.covariance.clone().cholesky().map(|c| c.l());
    let half = match root {
        Some(root) => half_widths(postures.len(), fit, nominal.gravity, &root, &found),
        None => [f64::NAN; COUNT],
    };
    let of = |i: usize| [found[i], found[i] - half[i], found[i] + half[i]];
    let three = |first: usize| std::array::from_fn(|i| of(first + i));
    let weight = of(0);
    let [tilt, low, high] = of(1);
    Numbers {
        weight,
        mass: weight.map(|weight| weight / nominal.gravity.norm()),
        tilt: [tilt, low.max(0.0), high],
        lean: [of(2), of(3)],
        turn: of(TURN),
        zero: three(5),
        torque_zero: three(8),
        centre: three(11),
    }
}

/// Half the widths of the intervals; `root` times its transpose is the covariance.
fn half_widths(
    postures: usize,
    fit: &Fit,
    gravity: Vector3<f64>,
    root: &DMatrix<f64>,
    found: &[f64; COUNT],
) -> [f64; COUNT] {
    let count = root.ncols();
    // Derivatives of the values by numbers that are independent of one another, each of deviation 1.
    let mut slopes = DMatrix::zeros(count, COUNT);
    for column in 0..count {
        let moved = values(&fit.stepped(&(root.column(column) * STEP)), gravity);
        for i in 0..COUNT {
            slopes[(column, i)] = difference(i, moved[i], found[i]) / STEP;
        }
    }
    let by_scatter = student_95(fit.freedom);
    let clusters = (postures >= LEFT_OUT_FROM)
        .then(|| Clusters::of(postures, fit, root))
        .flatten();
    std::array::from_fn(|i| {
        let slope = slopes.column(i).into_owned();
        let own = by_scatter * slope.norm();
        clusters
            .as_ref()
            .map_or(own, |clusters| own.max(clusters.half_width(&slope)))
    })
}

/// Postures as clusters of readings.
struct Clusters {
    /// Of each posture: derivatives of its readings by numbers of deviation 1, these over what leaving it out magnifies, and what is left of it.
    all: Vec<[DMatrix<f64>; 2]>,
    left: Vec<DVector<f64>>,
}

impl Clusters {
    /// None where a posture alone determines a number.
    fn of(postures: usize, fit: &Fit, root: &DMatrix<f64>) -> Option<Self> {
        let slopes = &fit.slopes * root;
        let row_of = |posture: usize, reading: usize| {
            let half = slopes.nrows() / 2;
            half * (reading / 3) + 3 * posture + reading % 3
        };
        let mut all = Vec::with_capacity(postures);
        let mut left = Vec::with_capacity(postures);
        for posture in 0..postures {
            let own = DMatrix::from_fn(READINGS, slopes.ncols(), |reading, column| {
                slopes[(row_of(posture, reading), column)]
            });
            let kept = DMatrix::identity(READINGS, READINGS) - &own * own.transpose();
            let magnified = kept.try_inverse()? * &own;
            all.push([own, magnified]);
            left.push(DVector::from_fn(READINGS, |reading, _| {
                fit.left[row_of(posture, reading)]
            }));
        }
        Some(Self { all, left })
    }

    /// Half the width of the interval of a value with this slope: its square is estimated with the freedom of a sum of squares by Satterthwaite.
    fn half_width(&self, slope: &DVector<f64>) -> f64 {
        let count = slope.len();
        let mut variance = 0.0;
        let (mut trace, mut squares) = (0.0, 0.0);
        let mut shared = DMatrix::zeros(count, count);
        for ([own, magnified], left) in self.all.iter().zip(&self.left) {
            let weights = magnified * slope;
            variance += weights.dot(left).powi(2);
            let common = own.tr_mul(&weights);
            let (size, part) = (weights.norm_squared(), common.norm_squared());
            trace += size - part;
            squares += size * size - 2.0 * size * part;
            shared += &common * common.transpose();
        }
        squares += shared.norm_squared();
        student_95((trace * trace / squares).max(1.0)) * variance.sqrt()
    }
}

/// Of two values of a number; an angle goes round.
fn difference(index: usize, one: f64, other: f64) -> f64 {
    match index {
        TURN => (one - other).sin().atan2((one - other).cos()),
        _ => one - other,
    }
}
