//! A recorded motion with its speed and acceleration, as far as the recording's noise lets them be known.
//!
//! ```text
//! minimise  sum K((t_i - t)/W) (x_i - c_0 - c_1 (t_i - t) - c_2 (t_i - t)^2 - c_3 (t_i - t)^3)^2,   x = c_0, v = c_1, a = 2 c_2
//! ```
//!
//! K tricube weights (Cleveland 1979), W half-width [s]: the largest that predicts a reading from the others about as well as the best one does, because
//! derivatives need more smoothing than the readings themselves. Samples may be at unlike distances.

use crate::stats::median;
use nalgebra::{Matrix4, Vector4};

/// Motion along extension, one value of each per sample; NaN where too few readings are near.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredMotion {
    /// Stroke [m].
    pub stroke: Vec<f64>,
    /// Speed [m/s].
    pub speed: Vec<f64>,
    /// Acceleration [m/s2].
    pub acceleration: Vec<f64>,
}

/// The narrowest half-width, in usual steps: three readings on either side count.
const NARROWEST: f64 = 3.5;
/// The widest, likewise.
const WIDEST: f64 = 400.0;
/// Each half-width over the one before.
const WIDER: f64 = 1.2;
/// Largest factor over the best that a half-width may predict with [1].
const ABOUT_AS_WELL: f64 = 1.03;
/// Factor over the best that ends the search [1].
const FAR_WORSE: f64 = 2.0;
/// Readings that a cubic needs at least.
const LEAST: usize = 6;
/// Share of the readings, away from the ends, that are predicted to choose a half-width: one in so many, for the long recordings.
const CHECKED_SAMPLES: usize = 4000;

impl MeasuredMotion {
    /// From readings of the stroke [m] at increasing times [s]; NaN where there is none.
    pub fn of(time: &[f64], stroke: &[f64]) -> Self {
        let known: Vec<(f64, f64)> = (time.iter().zip(stroke))
            .filter(|(_, x)| x.is_finite())
            .map(|(t, x)| (*t, *x))
            .collect();
        let Some(usual) = median(known.windows(2).map(|pair| pair[1].0 - pair[0].0)) else {
            let nothing = vec![f64::NAN; time.len()];
            return Self {
                stroke: nothing.clone(),
                speed: nothing.clone(),
                acceleration: nothing,
            };
        };
        let width = best_width(&known, usual);
        let fitted = time.iter().map(|t| Cubic::at(&known, *t, width));
        let fitted: Vec<[f64; 3]> = fitted
            .map(|cubic| cubic.map_or([f64::NAN; 3], |cubic| cubic.motion))
            .collect();
        Self {
            stroke: fitted.iter().map(|m| m[0]).collect(),
            speed: fitted.iter().map(|m| m[1]).collect(),
            acceleration: fitted.iter().map(|m| m[2]).collect(),
        }
    }
}

impl MeasuredMotion {
    /// Puts the straight line between what is known in place of what is not, and tells where.
    pub fn bridged(&mut self, time: &[f64]) -> Vec<usize> {
        let lost: Vec<usize> = (0..time.len())
            .filter(|i| !self.stroke[*i].is_finite())
            .collect();
        for values in [&mut self.stroke, &mut self.speed, &mut self.acceleration] {
            let known: Vec<(f64, f64)> = (time.iter().zip(values.iter()))
                .filter(|(_, x)| x.is_finite())
                .map(|(t, x)| (*t, *x))
                .collect();
            for &i in &lost {
                let after = known.partition_point(|(t, _)| *t < time[i]);
                let ends = (
                    after.checked_sub(1).and_then(|k| known.get(k)),
                    known.get(after),
                );
                values[i] = match ends {
                    (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (time[i] - a.0) / (b.0 - a.0),
                    (Some(one), None) | (None, Some(one)) => one.1,
                    (None, None) => 0.0,
                };
            }
        }
        lost
    }
}

/// The largest half-width [s] that predicts readings from the others about as well as the best.
fn best_width(known: &[(f64, f64)], usual: f64) -> f64 {
    let every = known.len().div_ceil(CHECKED_SAMPLES);
    let mut tried: Vec<(f64, f64)> = Vec::new();
    let mut least = f64::INFINITY;
    let mut width = NARROWEST * usual;
    while width <= WIDEST * usual {
        let error = prediction_error(known, width, every);
        if error.is_finite() {
            least = least.min(error);
            tried.push((width, error));
            if error > FAR_WORSE * least {
                break;
            }
        }
        width *= WIDER;
    }
    let good = tried
        .iter()
        .rev()
        .find(|(_, e)| *e <= ABOUT_AS_WELL * least);
    good.map_or(NARROWEST * usual, |(width, _)| *width)
}

/// Root mean square error with which readings are predicted from the others about them; the largest hundredth, such as of jolts, does not count.
fn prediction_error(known: &[(f64, f64)], width: f64, every: usize) -> f64 {
    let mut squares: Vec<f64> = (known.iter().step_by(every))
        .filter_map(|(t, x)| {
            let cubic = Cubic::at(known, *t, width)?;
            Some(((x - cubic.motion[0]) / (1.0 - cubic.leverage)).powi(2))
        })
        .filter(|square| square.is_finite())
        .collect();
    squares.sort_by(f64::total_cmp);
    squares.truncate(squares.len() * 99 / 100);
    if squares.is_empty() {
        return f64::INFINITY;
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// A cubic fitted about a time.
struct Cubic {
    /// Place [m], speed [m/s] and acceleration [m/s2].
    motion: [f64; 3],
    /// Weight of a reading at that time for the place [1].
    leverage: f64,
}

impl Cubic {
    fn at(known: &[(f64, f64)], time: f64, width: f64) -> Option<Self> {
        let from = known.partition_point(|(t, _)| *t <= time - width);
        let to = known.partition_point(|(t, _)| *t < time + width);
        if to - from < LEAST {
            return None;
        }
        let mut normal = Matrix4::zeros();
        let mut right = Vector4::zeros();
        // About a reading, so that small departures keep their figures.
        let origin = known[usize::midpoint(from, to)].1;
        for (t, x) in &known[from..to] {
            let u = (t - time) / width;
            let weight = (1.0 - u.abs().powi(3)).powi(3);
            let powers = Vector4::new(1.0, u, u * u, u * u * u);
            normal += weight * powers * powers.transpose();
            right += weight * (x - origin) * powers;
        }
        let inverse = normal.cholesky()?.inverse();
        let c = inverse * right;
        Some(Self {
            motion: [origin + c[0], c[1] / width, 2.0 * c[2] / (width * width)],
            leverage: inverse[(0, 0)],
        })
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
