//! Several hypotheses side by side: mixed before a step, weighed by how well they foresaw the samples.
//!
//! ```text
//! mixing:    w_ij = T_ij q_i / sum_i T_ij q_i,   s_j = sum_i w_ij s_i,   P_j = sum_i w_ij (P_i + (s_i - s_j)(s_i - s_j)')
//! weighing:  q_j <- q_j L_j / sum                                               (Blom and Bar-Shalom 1988)
//! ```
//!
//! q probability of a hypothesis, T chance to change from i to j within a period, L likelihood of the samples.

use super::ProcessModel;
use super::belief::{Belief, SIZE};

/// Least probability, so that no hypothesis is lost for good.
const LEAST: f64 = 1e-6;

/// Beliefs under each hypothesis with their probabilities.
#[derive(Debug, Clone)]
pub(super) struct Models {
    pub(super) beliefs: Vec<Belief>,
    pub(super) probabilities: Vec<f64>,
    /// Chance to change from the first index to the second within a period.
    chances: Vec<Vec<f64>>,
    mixed: Vec<Belief>,
}

impl Models {
    pub(super) fn new(models: &[ProcessModel], belief: &Belief, period: f64) -> Self {
        let count = models.len();
        let mut chances = vec![vec![0.0; count]; count];
        for (i, model) in models.iter().enumerate() {
            let leave = if count > 1 {
                1.0 - (-period / model.dwell).exp()
            } else {
                0.0
            };
            for (j, chance) in chances[i].iter_mut().enumerate() {
                *chance = if i == j {
                    1.0 - leave
                } else {
                    leave / (count - 1) as f64
                };
            }
        }
        Self {
            beliefs: vec![belief.clone(); count],
            probabilities: vec![1.0 / count as f64; count],
            chances,
            mixed: vec![belief.clone(); count],
        }
    }

    /// Mixes the beliefs for the coming period.
    pub(super) fn mix(&mut self) {
        let count = self.beliefs.len();
        if count == 1 {
            return;
        }
        let mut foreseen = vec![0.0; count];
        for (j, mixed) in self.mixed.iter_mut().enumerate() {
            let share = |i: usize| self.chances[i][j] * self.probabilities[i];
            foreseen[j] = (0..count).map(share).sum();
            mixed.mean = [0.0; SIZE];
            for (i, belief) in self.beliefs.iter().enumerate() {
                let weight = share(i) / foreseen[j];
                for (sum, value) in mixed.mean.iter_mut().zip(&belief.mean) {
                    *sum += weight * value;
                }
            }
            mixed.covariance = [[0.0; SIZE]; SIZE];
            for (i, belief) in self.beliefs.iter().enumerate() {
                add_spread(mixed, belief, share(i) / foreseen[j]);
            }
        }
        self.probabilities = foreseen;
        std::mem::swap(&mut self.beliefs, &mut self.mixed);
    }

    /// Weighs the hypotheses by the logarithms of their likelihoods.
    pub(super) fn weigh(&mut self, log_likelihoods: &[f64]) {
        let best = log_likelihoods.iter().fold(f64::MIN, |a, &b| a.max(b));
        let mut sum = 0.0;
        for (probability, log) in self.probabilities.iter_mut().zip(log_likelihoods) {
            *probability = (*probability * (log - best).exp()).max(LEAST);
            sum += *probability;
        }
        for probability in &mut self.probabilities {
            *probability /= sum;
        }
    }

    /// Index of the likeliest hypothesis.
    pub(super) fn likeliest(&self) -> usize {
        let mut best = 0;
        for (i, probability) in self.probabilities.iter().enumerate() {
            if *probability > self.probabilities[best] {
                best = i;
            }
        }
        best
    }

    /// Mean and variance over all hypotheses of a quantity that each gives as mean and variance.
    pub(super) fn overall(&self, of: impl Fn(&Belief) -> (f64, f64)) -> (f64, f64) {
        let (mut mean, mut square) = (0.0, 0.0);
        let mut first = 0.0;
        for (i, (belief, weight)) in self.beliefs.iter().zip(&self.probabilities).enumerate() {
            let (value, variance) = of(belief);
            // Differences from the first value: the square of a mean of 1e5 would swallow the variance.
            if i == 0 {
                first = value;
            }
            let difference = value - first;
            mean += weight * difference;
            square += weight * (variance + difference * difference);
        }
        (first + mean, (square - mean * mean).max(0.0))
    }
}

/// Adds a belief to a mixture whose mean is complete.
fn add_spread(mixed: &mut Belief, belief: &Belief, weight: f64) {
    let mut difference = [0.0; SIZE];
    for (d, (a, b)) in difference
        .iter_mut()
        .zip(belief.mean.iter().zip(&mixed.mean))
    {
        *d = a - b;
    }
    for (i, row) in mixed.covariance.iter_mut().enumerate() {
        let own = weight * difference[i];
        for ((sum, value), d) in row.iter_mut().zip(&belief.covariance[i]).zip(&difference) {
            *sum += weight * value + own * d;
        }
    }
}
