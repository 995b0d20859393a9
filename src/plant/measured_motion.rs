//! A recorded motion with its speed and acceleration, as far as the recording's noise lets them be known.
//!
//!     d/dt [x v a] = [v a w],   w white of intensity q;   y = x + noise of variance r
//!
//! smoothed forward and back (Kalman 1960; Rauch, Tung and Striebel 1965) with the ratio q/r at which the readings are most likely (their innovations, r
//! eliminated): a motion that is rough against its sensor's noise is followed closely, a smooth one is smoothed. Samples may be at unlike distances.

use nalgebra::{Matrix3, RowVector3, Vector3};

/// Motion along extension, one value of each per sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredMotion {
    /// Stroke [m].
    pub stroke: Vec<f64>,
    /// Speed [m/s].
    pub speed: Vec<f64>,
    /// Acceleration [m/s2].
    pub acceleration: Vec<f64>,
}

/// Smoothing times looked at, as multiples of the usual step: first, last, and how many.
const TIMES: (f64, f64, usize) = (0.2, 300.0, 22);
/// Halvings of the interval about the best of them.
const REFINEMENTS: usize = 6;

impl MeasuredMotion {
    /// From readings of the stroke [m] at increasing times [s]; NaN where there is none.
    pub fn of(time: &[f64], stroke: &[f64]) -> Self {
        let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = steps.len() / 2;
        let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let (first, last, count) = TIMES;
        let ratio = (last / first).powf(1.0 / (count - 1) as f64);
        let at = |k: f64| usual * first * ratio.powf(k);
        let unlikely = |k: f64| Filter::new(at(k)).unlikelihood(time, stroke);
        let grid: Vec<f64> = (0..count).map(|k| unlikely(k as f64)).collect();
        let best = (0..count).min_by(|a, b| grid[*a].total_cmp(&grid[*b]));
        let mut best = best.unwrap_or(0) as f64;
        let mut least = unlikely(best);
        let mut step = 0.5;
        for _ in 0..REFINEMENTS {
            for side in [best - step, best + step] {
                let there = unlikely(side);
                if there < least {
                    (best, least) = (side, there);
                }
            }
            step *= 0.5;
        }
        Filter::new(at(best)).smoothed(time, stroke)
    }
}

/// The filter with r = 1 and q = T^-5.
struct Filter {
    intensity: f64,
}

type State = (Vector3<f64>, Matrix3<f64>);

impl Filter {
    fn new(smoothing_time: f64) -> Self {
        Self {
            intensity: smoothing_time.powi(-5),
        }
    }

    /// Before anything is known: at the first reading, at any speed.
    fn start(&self, time: &[f64], stroke: &[f64]) -> State {
        let first = stroke.iter().copied().find(|x| x.is_finite());
        let h = time[1] - time[0];
        let wide = Vector3::new(1e6, 1e6 / (h * h), 1e6 / h.powi(4));
        (
            Vector3::new(first.unwrap_or(0.0), 0.0, 0.0),
            Matrix3::from_diagonal(&wide),
        )
    }

    fn transition(h: f64) -> Matrix3<f64> {
        Matrix3::new(1.0, h, 0.5 * h * h, 0.0, 1.0, h, 0.0, 0.0, 1.0)
    }

    fn spread(&self, h: f64) -> Matrix3<f64> {
        let (h2, h3, h4, h5) = (h * h, h.powi(3), h.powi(4), h.powi(5));
        let own = Matrix3::new(
            h5 / 20.0,
            h4 / 8.0,
            h3 / 6.0,
            h4 / 8.0,
            h3 / 3.0,
            h2 / 2.0,
            h3 / 6.0,
            h2 / 2.0,
            h,
        );
        self.intensity * own
    }

    fn predicted(&self, (state, covariance): &State, h: f64) -> State {
        let f = Self::transition(h);
        (f * state, f * covariance * f.transpose() + self.spread(h))
    }

    /// With a reading: the state after it, its innovation and the innovation's variance over r.
    fn updated((state, covariance): &State, reading: f64) -> (State, f64, f64) {
        let variance = covariance[(0, 0)] + 1.0;
        let gain = covariance.column(0) / variance;
        let innovation = reading - state[0];
        let h = RowVector3::new(1.0, 0.0, 0.0);
        let keep = Matrix3::identity() - gain * h;
        // Joseph's form stays positive.
        let after = keep * covariance * keep.transpose() + gain * gain.transpose();
        ((state + gain * innovation, after), innovation, variance)
    }

    /// Minus the logarithm of the readings' likelihood but for a constant, at the r that suits them best; the first readings find the start.
    fn unlikelihood(&self, time: &[f64], stroke: &[f64]) -> f64 {
        let mut state = self.start(time, stroke);
        let (mut squares, mut logarithms, mut count) = (0.0, 0.0, 0.0);
        for i in 0..time.len() {
            if i > 0 {
                state = self.predicted(&state, time[i] - time[i - 1]);
            }
            if stroke[i].is_finite() {
                let (after, innovation, variance) = Self::updated(&state, stroke[i]);
                state = after;
                if i >= 10 {
                    squares += innovation * innovation / variance;
                    logarithms += variance.ln();
                    count += 1.0;
                }
            }
        }
        if count == 0.0 {
            return f64::INFINITY;
        }
        count * (squares / count).max(f64::MIN_POSITIVE).ln() + logarithms
    }

    fn smoothed(&self, time: &[f64], stroke: &[f64]) -> MeasuredMotion {
        let count = time.len();
        let mut filtered: Vec<State> = Vec::with_capacity(count);
        let mut predicted: Vec<State> = Vec::with_capacity(count);
        let mut state = self.start(time, stroke);
        for i in 0..count {
            if i > 0 {
                state = self.predicted(&state, time[i] - time[i - 1]);
            }
            predicted.push(state);
            if stroke[i].is_finite() {
                state = Self::updated(&state, stroke[i]).0;
            }
            filtered.push(state);
        }
        let mut smooth: Vec<Vector3<f64>> = filtered.iter().map(|(x, _)| *x).collect();
        for i in (0..count - 1).rev() {
            let f = Self::transition(time[i + 1] - time[i]);
            let (x, p) = &filtered[i];
            let (ahead, spread) = &predicted[i + 1];
            if let Some(inverse) = spread.try_inverse() {
                smooth[i] = x + p * f.transpose() * inverse * (smooth[i + 1] - ahead);
            }
        }
        MeasuredMotion {
            stroke: smooth.iter().map(|s| s[0]).collect(),
            speed: smooth.iter().map(|s| s[1]).collect(),
            acceleration: smooth.iter().map(|s| s[2]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::MeasuredMotion;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn worst(found: &[f64], true_value: impl Fn(usize) -> f64) -> f64 {
        let inner = 40..found.len() - 40;
        inner
            .map(|i| (found[i] - true_value(i)).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_wave_comes_back_with_speed_and_acceleration_at_unlike_distances_of_samples() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut time = vec![0.0];
        for _ in 1..1500 {
            let last = time[time.len() - 1];
            time.push(last + random.random_range(0.5e-3..1.5e-3));
        }
        let (w, size, noise) = (20.0f64, 0.05, 1e-6);
        let readings: Vec<f64> = time
            .iter()
            .map(|t| size * (w * t).sin() + noise * random.random_range(-1.7..1.7))
            .collect();
        let motion = MeasuredMotion::of(&time, &readings);
        let speed = worst(&motion.speed, |i| size * w * (w * time[i]).cos());
        let acceleration = worst(&motion.acceleration, |i| {
            -size * w * w * (w * time[i]).sin()
        });
        assert!(speed < 2e-3 * size * w, "{speed}");
        assert!(acceleration < 2e-2 * size * w * w, "{acceleration}");
    }

    #[test]
    fn rest_is_rest_however_noisy() {
        let mut random = ChaCha8Rng::seed_from_u64(6);
        let time: Vec<f64> = (0..800).map(|i| 0.01 * f64::from(i)).collect();
        let readings: Vec<f64> = time
            .iter()
            .map(|_| 1e-5 * random.random_range(-1.7..1.7))
            .collect();
        let motion = MeasuredMotion::of(&time, &readings);
        assert!(worst(&motion.speed, |_| 0.0) < 2e-5);
    }
}
