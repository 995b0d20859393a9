//! Median of the last samples.
//!
//! ```text
//! y_k = the middle one of u_k .. u_(k-n+1) in order of size,   delay = (n - 1) T / 2
//! noise factor^2 = integral of x^2 n! / (m!)^2 (P (1 - P))^m p dx,   m = (n - 1) / 2      (order statistics of the normal)
//! ```
//!
//! n length, odd, T sample period [s], p and P density and distribution of the standard normal.
//! It is not linear: the delay is that of whatever rises or falls throughout, and shorter turns are cut.

use std::collections::VecDeque;

/// The last samples, oldest first.
#[derive(Debug, Clone, PartialEq)]
pub struct MedianFilter {
    length: usize,
    window: VecDeque<f64>,
    sorted: Vec<f64>,
}

/// Delay of what rises or falls throughout [s].
pub fn delay(length: usize, sample_period: f64) -> f64 {
    0.5 * (length - 1) as f64 * sample_period
}

/// Standard deviation of the output over that of normal white noise at the input [1].
pub fn noise_factor(length: usize) -> f64 {
    const STEP: f64 = 1e-3;
    const REACH: f64 = 8.0;
    let half = (length - 1) / 2;
    // n! / (m!)^2 as a product, with (P (1 - P))^m taken in so that nothing overflows.
    let density_of_median = |density: f64, below: f64| {
        (1..=half).fold(density, |product, k| {
            product * below * (1.0 - below) * (half + k) as f64 / k as f64
        }) * length as f64
    };
    let normal = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let mut below = 0.0;
    let mut variance = 0.0;
    for k in 0..(2.0 * REACH / STEP) as usize {
        // Midpoints of the intervals, Simpson's rule for the distribution up to them.
        let left = -REACH + k as f64 * STEP;
        let middle = left + 0.5 * STEP;
        let area =
            |a: f64, b: f64| (b - a) / 6.0 * (normal(a) + 4.0 * normal(0.5 * (a + b)) + normal(b));
        let density = density_of_median(normal(middle), below + area(left, middle));
        variance += middle * middle * density * STEP;
        below += area(left, left + STEP);
    }
    variance.sqrt()
}

impl MedianFilter {
    /// Of a number of samples.
    pub fn new(length: usize) -> Self {
        Self {
            length,
            window: VecDeque::with_capacity(length),
            sorted: Vec::with_capacity(length),
        }
    }

    /// Takes a sample and returns the filtered value.
    pub fn apply(&mut self, sample: f64) -> f64 {
        if self.window.is_empty() {
            self.window.resize(self.length, sample);
        }
        self.window.pop_front();
        self.window.push_back(sample);
        self.sorted.clear();
        self.sorted.extend(&self.window);
        self.sorted.sort_unstable_by(f64::total_cmp);
        self.sorted[self.length / 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outliers_fewer_than_half_the_window_vanish() {
        let mut filter = MedianFilter::new(5);
        for k in 0..100 {
            let sample = if k % 5 < 2 { 1e6 } else { 3.0 };
            let output = filter.apply(sample);
            assert!(k < 4 || output == 3.0);
        }
    }

    #[test]
    fn the_noise_factor_is_that_of_the_tables() {
        // Variances of the median of 3, 5 and 7 normal numbers (Teichroew 1956, as in tables of order statistics).
        for (length, variance) in [(1, 1.0), (3, 0.448_67), (5, 0.286_83), (7, 0.210_45)] {
            assert!(
                (noise_factor(length).powi(2) - variance).abs() < 1e-5,
                "{length}"
            );
        }
        // Long windows: pi / (2 n).
        let long = noise_factor(99).powi(2) * 99.0 * 2.0 / std::f64::consts::PI;
        assert!((long - 1.0).abs() < 0.01);
    }
}
