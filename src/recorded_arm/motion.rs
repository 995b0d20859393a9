//! Motion of a recording: positions as measured, speeds and accelerations made of them by a zero-phase low-pass and differences.
//!
//! ```text
//! q'  = (q[-2] - 8 q[-1] + 8 q[1] - q[2])/(12 h)
//! q'' = (-q[-2] + 16 q[-1] - 30 q[0] + 16 q[1] - q[2])/(12 h^2)
//! ```
//!
//! h time between samples of an even grid [s], on which stamps that are uneven are resampled by a spline. Source: Fornberg, Mathematics of Computation 51
//! (1988), 699.

use super::filter::low_pass;
use super::outside::Outside;
use super::spline::Spline;
use crate::stats::median;
use std::f64::consts::TAU;

/// Motion of all joints over a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Sample times [s].
    pub time: Vec<f64>,
    /// Which of the recordings it is of, from 0.
    pub recording: usize,
    /// Cut-off of the low-pass that positions went through [Hz].
    pub cut_off: f64,
    /// Positions by joint and sample [rad or m], through the low-pass.
    pub position: Vec<Vec<f64>>,
    /// Speeds by joint and sample [rad/s or m/s].
    pub speed: Vec<Vec<f64>>,
    /// Accelerations by joint and sample [rad/s2 or m/s2].
    pub acceleration: Vec<Vec<f64>>,
    /// What acts on the flange beside the bodies of the description, by sample; none where nothing does, or nobody knows.
    pub outside: Option<Outside>,
}

/// Median time between samples [s].
#[must_use]
pub fn sample_time(time: &[f64]) -> f64 {
    let steps = time.windows(2).map(|w| w[1] - w[0]);
    median(steps).unwrap_or(0.01)
}

/// Cut-off beyond which nothing is gained, and the least [Hz].
const CUT_OFF: [f64; 2] = [25.0, 4.0];
/// Noise of the accelerations that is borne, as a share of their own root mean square [1].
const BORNE: f64 = 0.02;

/// Share of the cut-off up to which accelerations are as they were [1].
const SLOW: f64 = 0.6;

/// Root mean square of accelerations below which their noise does not matter more [rad/s2].
const SMALL: f64 = 0.3;

/// Samples at uneven times on an even grid.
struct Grid {
    time: Vec<f64>,
    step: f64,
    is_even: bool,
}

impl Grid {
    fn of(time: &[f64]) -> Self {
        let step = sample_time(time);
        let first = time.first().copied().unwrap_or(0.0);
        let span = time.last().copied().unwrap_or(0.0) - first;
        let count = (span / step).round() as usize + 1;
        let grid: Vec<f64> = (0..count).map(|i| first + i as f64 * step).collect();
        let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-3 * step;
        let is_even = count == time.len() && grid.iter().zip(time).all(near);
        Self {
            time: grid,
            step,
            is_even,
        }
    }

    /// Values at the grid's times.
    fn there(&self, time: &[f64], values: &[f64]) -> Vec<f64> {
        if self.is_even {
            return values.to_vec();
        }
        let spline = Spline::through(time, values);
        self.time.iter().map(|t| spline.at(*t)).collect()
    }

    /// Values of the grid at other times.
    fn back(&self, time: &[f64], values: Vec<f64>) -> Vec<f64> {
        if self.is_even {
            return values;
        }
        let spline = Spline::through(&self.time, &values);
        time.iter().map(|t| spline.at(*t)).collect()
    }
}

/// Cut-off at which the noise of positions leaves accelerations usable [Hz]: of positions by joint and sample.
///
/// ```text
/// s_a = s_q (2 pi f)^2 sqrt(2 f/(5 r))
/// ```
///
/// s_q noise of the positions, by how far a sample lies from the cubic through its neighbours; r sample rate [Hz].
#[must_use]
pub fn cut_off_for(time: &[f64], measured: &[Vec<f64>]) -> f64 {
    let rate = 1.0 / sample_time(time);
    let mut lowest = CUT_OFF[0];
    for positions in measured {
        let noise = noise_of(time, positions);
        let slow = Motion::of_positions(0, time, std::slice::from_ref(positions), CUT_OFF[1]);
        let square = slow.acceleration[0].iter().map(|a| a * a).sum::<f64>();
        let size = (square / time.len().max(1) as f64).sqrt();
        // Accelerations of a joint that hardly moves cost nothing.
        let size = size.max(SMALL);
        let mut cut_off = CUT_OFF[0];
        while cut_off > CUT_OFF[1] {
            let angular = (TAU * cut_off).powi(2);
            if noise * angular * (2.0 * cut_off / (5.0 * rate)).sqrt() <= BORNE * size {
                break;
            }
            cut_off *= 0.9;
        }
        lowest = lowest.min(cut_off);
    }
    lowest
}

/// Noise of positions [rad], robust.
fn noise_of(time: &[f64], positions: &[f64]) -> f64 {
    let errors = (2..positions.len().saturating_sub(2)).map(|i| {
        let knots = [i - 2, i - 1, i + 1, i + 2];
        let mut guess = 0.0;
        for a in knots {
            let others = knots.iter().filter(|b| **b != a);
            let weight: f64 = others
                .map(|b| (time[i] - time[*b]) / (time[a] - time[*b]))
                .product();
            guess += weight * positions[a];
        }
        (guess - positions[i]).abs()
    });
    // Of four neighbours with weights -1/6, 2/3, 2/3, -1/6 and the sample itself.
    median(errors).unwrap_or(0.0) / (0.6745 * (1.0 + 34.0 / 36.0f64).sqrt())
}

impl Motion {
    /// Of measured positions by joint and sample [rad or m], through a low-pass of a cut-off [Hz].
    #[must_use]
    pub fn of_positions(
        recording: usize,
        time: &[f64],
        measured: &[Vec<f64>],
        cut_off: f64,
    ) -> Self {
        let mut motion = Self {
            time: time.to_vec(),
            recording,
            cut_off,
            position: Vec::new(),
            speed: Vec::new(),
            acceleration: Vec::new(),
            outside: None,
        };
        let grid = Grid::of(time);
        for positions in measured {
            let even = grid.there(time, positions);
            let smooth = low_pass(&even, 1.0 / grid.step, cut_off);
            let [speed, acceleration] = derivatives(&smooth, grid.step);
            motion.position.push(grid.back(time, smooth));
            motion.speed.push(grid.back(time, speed));
            motion.acceleration.push(grid.back(time, acceleration));
        }
        motion
    }

    /// A reading through the same low-pass as the positions, where that is lower than noise of its own would need.
    #[must_use]
    pub fn through_low_pass(&self, reading: &[f64]) -> Vec<f64> {
        if self.cut_off >= CUT_OFF[0] || reading.iter().any(|r| !r.is_finite()) {
            return reading.to_vec();
        }
        let grid = Grid::of(&self.time);
        let even = grid.there(&self.time, reading);
        grid.back(&self.time, low_pass(&even, 1.0 / grid.step, self.cut_off))
    }

    /// Share of a reading's noise that [`Self::through_low_pass`] leaves [1].
    #[must_use]
    pub fn noise_share(&self) -> f64 {
        if self.cut_off >= CUT_OFF[0] {
            return 1.0;
        }
        (2.0 * self.cut_off * sample_time(&self.time))
            .sqrt()
            .min(1.0)
    }

    /// Accelerations without what changes so fast that the low-pass of the positions may have smeared it, by joint and sample [rad/s2 or m/s2].
    #[must_use]
    pub fn slow_acceleration(&self) -> Vec<Vec<f64>> {
        if !self.cut_off.is_finite() {
            return self.acceleration.clone();
        }
        let grid = Grid::of(&self.time);
        let all = self.acceleration.iter();
        all.map(|own| {
            let even = grid.there(&self.time, own);
            let slow = low_pass(&even, 1.0 / grid.step, SLOW * self.cut_off);
            grid.back(&self.time, slow)
        })
        .collect()
    }

    /// Every so manyth of its samples.
    #[must_use]
    pub fn every(&self, apart: usize) -> Self {
        let of = |all: &[Vec<f64>]| -> Vec<Vec<f64>> {
            all.iter().map(|own| every(own, apart)).collect()
        };
        Self {
            time: every(&self.time, apart),
            recording: self.recording,
            cut_off: self.cut_off,
            position: of(&self.position),
            speed: of(&self.speed),
            acceleration: of(&self.acceleration),
            outside: self.outside.as_ref().map(|all| Outside {
                wrench: every(&all.wrench, apart),
                drag: every(&all.drag, apart),
            }),
        }
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether it has no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }
}

/// Every so manyth of all.
#[must_use]
pub fn every<T: Copy>(all: &[T], apart: usize) -> Vec<T> {
    all.iter().step_by(apart).copied().collect()
}

/// First and second derivatives of samples at an even step [s].
fn derivatives(values: &[f64], step: f64) -> [Vec<f64>; 2] {
    let count = values.len();
    // Beyond the ends as it was: turned about them.
    let at = |i: isize| {
        let last = count as isize - 1;
        if i < 0 {
            2.0 * values[0] - values[(-i).min(last) as usize]
        } else if i > last {
            2.0 * values[last as usize] - values[(2 * last - i).max(0) as usize]
        } else {
            values[i as usize]
        }
    };
    let pair = |i: isize| {
        let [a, b, c, d, e] = [-2, -1, 0, 1, 2].map(|k| at(i + k));
        [
            (a - 8.0 * b + 8.0 * d - e) / (12.0 * step),
            (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * step * step),
        ]
    };
    let all: Vec<[f64; 2]> = (0..count as isize).map(pair).collect();
    [0, 1].map(|k| all.iter().map(|p| p[k]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uneven_stamps_give_the_derivatives_of_the_motion() {
        let time: Vec<f64> = (0..1000)
            .map(|i| 0.01 * f64::from(i) + 0.001 * f64::from((i * 7) % 5))
            .collect();
        let positions = vec![time.iter().map(|t| (3.0 * t).sin()).collect()];
        let motion = Motion::of_positions(0, &time, &positions, 25.0);
        for (i, t) in time.iter().enumerate().take(900).skip(100) {
            assert!((motion.speed[0][i] - 3.0 * (3.0 * t).cos()).abs() < 2e-4);
            assert!((motion.acceleration[0][i] + 9.0 * (3.0 * t).sin()).abs() < 2e-2);
        }
    }
}
