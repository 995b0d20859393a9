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
use super::spline::Spline;
use crate::stats::median;

/// Motion of all joints over a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Sample times [s].
    pub time: Vec<f64>,
    /// Which of the recordings it is of, from 0.
    pub recording: usize,
    /// Positions by joint and sample [rad or m], through the low-pass.
    pub position: Vec<Vec<f64>>,
    /// Speeds by joint and sample [rad/s or m/s].
    pub speed: Vec<Vec<f64>>,
    /// Accelerations by joint and sample [rad/s2 or m/s2].
    pub acceleration: Vec<Vec<f64>>,
}

/// Median time between samples [s].
#[must_use]
pub fn sample_time(time: &[f64]) -> f64 {
    let steps = time.windows(2).map(|w| w[1] - w[0]);
    median(steps).unwrap_or(0.01)
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
            position: Vec::new(),
            speed: Vec::new(),
            acceleration: Vec::new(),
        };
        let step = sample_time(time);
        let first = time.first().copied().unwrap_or(0.0);
        let span = time.last().copied().unwrap_or(0.0) - first;
        let count = (span / step).round() as usize + 1;
        let grid: Vec<f64> = (0..count).map(|i| first + i as f64 * step).collect();
        let is_even = count == time.len()
            && grid
                .iter()
                .zip(time)
                .all(|(a, b)| (a - b).abs() < 1e-3 * step);
        for positions in measured {
            let even = if is_even {
                positions.clone()
            } else {
                let spline = Spline::through(time, positions);
                grid.iter().map(|t| spline.at(*t)).collect()
            };
            let smooth = low_pass(&even, 1.0 / step, cut_off);
            let [speed, acceleration] = derivatives(&smooth, step);
            let back = |values: Vec<f64>| {
                if is_even {
                    return values;
                }
                let spline = Spline::through(&grid, &values);
                time.iter().map(|t| spline.at(*t)).collect()
            };
            motion.position.push(back(smooth));
            motion.speed.push(back(speed));
            motion.acceleration.push(back(acceleration));
        }
        motion
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
        for i in 100..900 {
            let t = time[i];
            assert!((motion.speed[0][i] - 3.0 * (3.0 * t).cos()).abs() < 2e-4);
            assert!((motion.acceleration[0][i] + 9.0 * (3.0 * t).sin()).abs() < 2e-2);
        }
    }
}
