//! Belief of one filter: a mean and a covariance over state and considered parameters, and the two things done to them.
//!
//! A sample z = h s + noise of variance R:   c = P h,  S = h' P h + R,  K = c / S on the state and 0 on the parameters (Schmidt),
//!
//! ```text
//! s <- s + K (z - h s),   P <- P - K c' - c K' + S K K'  =  P - c c' / S but for the parameters' own block, which stays
//! ```
//!
//! An element replaced by a linear combination of all:   P <- T P T'.
//!
//! Samples come one number at a time, so no matrix is inverted and elements of very different units do not disturb each other.

/// Stroke [m].
pub(super) const STROKE: usize = 0;
/// Speed of extension [m/s].
pub(super) const SPEED: usize = 1;
/// Acceleration [m/s2].
pub(super) const ACCELERATION: usize = 2;
/// Bias of the accelerometer [m/s2].
pub(super) const ACCELERATION_BIAS: usize = 3;
/// Regulator's outlet, gauge [Pa].
pub(super) const OUTLET: usize = 4;
/// Target that the outlet lags behind, gauge [Pa].
pub(super) const TARGET: usize = 5;
/// Air in chambers 1 and 2 [kg].
pub(super) const MASSES: [usize; 2] = [6, 7];
/// Stroke of the last turning point of the seals, or of the way's end while it goes on [m].
pub(super) const TURNING_STROKE: usize = 8;
/// Deflection of the bristles there over the presliding displacement [1].
pub(super) const TURNING_DEFLECTION: usize = 9;
/// Number of elements that are corrected; those after are considered only.
pub(super) const STATES: usize = 10;
/// Bias of the outlet's sensor [Pa].
pub(super) const PRESSURE_BIAS: usize = 10;
/// Relative error of the supply orifice [1].
pub(super) const SUPPLY: usize = 11;
/// Relative error of the exhaust orifice [1].
pub(super) const EXHAUST: usize = 12;
/// Relative error of the dead volume [1].
pub(super) const DEAD_VOLUME: usize = 13;
/// Relative error of the presliding displacement [1].
pub(super) const PRESLIDING: usize = 14;
/// Relative error of the outlet's sensor [1].
pub(super) const PRESSURE_SCALE: usize = 15;
/// All elements.
pub(super) const SIZE: usize = 16;

/// A coefficient on each of some elements.
pub(super) type Term = (usize, f64);

/// Difference of a sample from its prediction, and the variance it should have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Innovation {
    pub(super) residual: f64,
    pub(super) variance: f64,
}

impl Innovation {
    /// Logarithm of its likelihood, but for a constant.
    pub(super) fn log_likelihood(&self) -> f64 {
        -0.5 * (self.residual * self.residual / self.variance + self.variance.ln())
    }
}

/// Mean and covariance.
#[derive(Debug, Clone)]
pub(super) struct Belief {
    pub(super) mean: [f64; SIZE],
    pub(super) covariance: [[f64; SIZE]; SIZE],
}

impl Belief {
    /// Uncorrelated elements with these standard deviations.
    pub(super) fn uncorrelated(mean: [f64; SIZE], deviations: [f64; SIZE]) -> Self {
        let mut covariance = [[0.0; SIZE]; SIZE];
        for (i, deviation) in deviations.into_iter().enumerate() {
            covariance[i][i] = deviation * deviation;
        }
        Self { mean, covariance }
    }

    /// Replaces the deviation of an element by a linear combination of the deviations of all, its own among them where it has a term.
    pub(super) fn combine(&mut self, element: usize, terms: &[Term]) {
        let mut row = [0.0; SIZE];
        for &(from, factor) in terms {
            for (sum, value) in row.iter_mut().zip(&self.covariance[from]) {
                *sum += factor * value;
            }
        }
        let own: f64 = terms.iter().map(|&(from, factor)| factor * row[from]).sum();
        row[element] = own.max(0.0);
        for (other, value) in row.into_iter().enumerate() {
            self.covariance[other][element] = value;
        }
        self.covariance[element] = row;
    }

    /// Variance of a linear combination.
    pub(super) fn variance(&self, terms: &[Term]) -> f64 {
        let mut sum = 0.0;
        for &(i, a) in terms {
            for &(j, b) in terms {
                sum += a * b * self.covariance[i][j];
            }
        }
        sum.max(0.0)
    }

    /// Adds process noise between two elements.
    pub(super) fn add_noise(&mut self, i: usize, j: usize, covariance: f64) {
        self.covariance[i][j] += covariance;
        if i != j {
            self.covariance[j][i] += covariance;
        }
    }

    /// Takes a sample of a linear combination with noise of a variance in.
    pub(super) fn observe(&mut self, terms: &[Term], sample: f64, noise: f64) -> Innovation {
        let predicted: f64 = terms.iter().map(|&(i, a)| a * self.mean[i]).sum();
        let innovation = Innovation {
            residual: sample - predicted,
            variance: self.variance(terms) + noise,
        };
        let mut spread = [0.0; SIZE];
        for &(from, factor) in terms {
            for (sum, value) in spread.iter_mut().zip(&self.covariance[from]) {
                *sum += factor * value;
            }
        }
        let mut gain = [0.0; SIZE];
        for i in 0..STATES {
            gain[i] = spread[i] / innovation.variance;
            self.mean[i] += gain[i] * innovation.residual;
        }
        let (states, parameters) = self.covariance.split_at_mut(STATES);
        for (row, gain) in states.iter_mut().zip(gain) {
            for (value, spread) in row.iter_mut().zip(&spread) {
                *value -= gain * spread;
            }
        }
        for (row, spread) in parameters.iter_mut().zip(&spread[STATES..]) {
            for (value, gain) in row.iter_mut().zip(&gain) {
                *value -= spread * gain;
            }
        }
        innovation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn correlated() -> Belief {
        let mut deviations = [0.0; SIZE];
        deviations[OUTLET] = 3e4;
        deviations[PRESSURE_BIAS] = 800.0;
        Belief::uncorrelated([0.0; SIZE], deviations)
    }

    #[test]
    fn a_considered_bias_stays_however_many_samples_come() {
        // n samples of outlet + bias: variance -> bias^2 + noise^2/n, covariance with the bias -> -bias^2.
        let mut belief = correlated();
        let terms = [(OUTLET, 1.0), (PRESSURE_BIAS, 1.0)];
        for _ in 0..1000 {
            belief.observe(&terms, 2e5, 600.0 * 600.0);
        }
        let bias = 800.0 * 800.0;
        let variance = belief.covariance[OUTLET][OUTLET];
        assert!((variance / (bias + 360.0) - 1.0).abs() < 1e-3, "{variance}");
        assert!((belief.covariance[OUTLET][PRESSURE_BIAS] / -bias - 1.0).abs() < 1e-2);
        assert_eq!(belief.covariance[PRESSURE_BIAS][PRESSURE_BIAS], bias);
        assert_eq!(belief.mean[PRESSURE_BIAS], 0.0);
        assert!((belief.mean[OUTLET] / 2e5 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_combination_is_the_dense_product() {
        let mut belief = Belief::uncorrelated([0.0; SIZE], [1.0; SIZE]);
        belief.combine(STROKE, &[(STROKE, 1.0), (SPEED, 0.5)]);
        belief.combine(SPEED, &[(SPEED, 0.9), (ACCELERATION, 0.1)]);
        let p = &belief.covariance;
        assert!((p[STROKE][STROKE] - 1.25).abs() < 1e-15);
        assert!((p[STROKE][SPEED] - 0.45).abs() < 1e-15);
        assert!((p[SPEED][SPEED] - 0.82).abs() < 1e-15);
        assert!((p[ACCELERATION][SPEED] - 0.1).abs() < 1e-15);
    }
}
