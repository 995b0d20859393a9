//! Model error: what an explanation leaves beyond noise, by which the evidence for and against others is weighed.
//!
//! ```text
//! cost = sum over channels of sum rho(r / sqrt v),   v = s^2 tau,   s^2 = max(1, mean rho(r)),   tau = 1 + 2 sum of rho_k
//! ```
//!
//! r residuals in standard deviations of the sensor's noise, rho Huber's loss, tau the integrated autocorrelation time in samples (Sokal 1997), rho_k the
//! autocorrelation at k samples while it is above 0.05. Where a law is a little wrong its residuals are larger than noise and neighbours have the same
//! sign: tau of them tell as much as one, and each is worth one over s^2 of a sample with noise alone. Counted as independent, they would make anything
//! certain that follows them (the likelihood is tempered: Grunwald and van Ommen, Bayesian Analysis 12, 2017).

use super::autocorrelation::integrated_autocorrelation_time;
use super::{Fit, loss, robust_sum};
use crate::diagnosis::recordings::evidence::{Evidence, Prediction, by_channel};
use crate::diagnosis::recordings::subject::Subject;
use crate::diagnosis::settings::HUBER;

/// Multiple of the noise's variance up to which a channel's residuals count as noise [1].
const NOISE_ALONE: f64 = 1.3;

/// Standard deviations of an autocorrelation time of noise that are chance [1].
const CHANCE: f64 = 3.0;
/// Samples that the sum of autocorrelations reaches over, of noise [1].
const WINDOW: f64 = 5.0;

/// The same of a channel of so many samples, of which few say little of their autocorrelation time: its relative variance is 2 (2 M + 1) / N over a window of M
/// samples (Sokal 1997).
fn noise_alone(samples: f64) -> f64 {
    let deviation = (2.0 * (2.0 * WINDOW + 1.0) / samples.max(1.0)).sqrt();
    NOISE_ALONE.max(1.0 + CHANCE * deviation)
}

/// Variance of a channel's residuals in units of the noise's, times the samples that tell as much as one [1].
#[derive(Debug, Clone, PartialEq)]
pub struct ModelError {
    /// By channel; empty where each has noise alone.
    variance: Vec<f64>,
}

impl ModelError {
    /// Noise alone.
    pub const NONE: Self = Self {
        variance: Vec::new(),
    };

    /// What a prediction leaves.
    pub fn of<S: Subject>(evidence: &Evidence<S>, prediction: &Prediction<S>) -> Self {
        let mut sums = vec![[0.0; 3]; S::CHANNELS.len()];
        for (_, channel, residuals) in by_channel(evidence, &prediction.residuals) {
            let left: Vec<f64> = (residuals.iter().filter(|r| r.is_finite()))
                .map(|r| r.signum() * loss(*r, HUBER).sqrt())
                .collect();
            let count = left.len() as f64;
            let Some(at) = place::<S>(channel) else {
                continue;
            };
            let [squares, times, samples] = &mut sums[at];
            *squares += left.iter().map(|r| r * r).sum::<f64>();
            *times += count * integrated_autocorrelation_time(&left);
            *samples += count;
        }
        let variance = sums.into_iter().map(|[squares, times, samples]| {
            let [size, time] = [squares, times].map(|sum| (sum / samples.max(1.0)).max(1.0));
            if size * time < noise_alone(samples) {
                1.0
            } else {
                size * time
            }
        });
        let variance: Vec<f64> = variance.collect();
        match variance.iter().all(|v| *v == 1.0) {
            true => Self::NONE,
            false => Self { variance },
        }
    }

    /// Whether there is noise alone.
    pub fn is_none(&self) -> bool {
        self.variance.is_empty()
    }

    /// Cost that a fit leaves beyond noise; nothing where there is noise alone [1].
    pub fn left<S: Subject>(&self, evidence: &Evidence<S>, fit: &Fit<S>) -> f64 {
        match self.is_none() {
            true => 0.0,
            false => (fit.cost() - evidence.count() as f64).max(0.0),
        }
    }

    /// Robust sum of squares of residuals, recording by recording and channel by channel [1].
    pub fn cost<S: Subject>(&self, evidence: &Evidence<S>, residuals: &[f64]) -> f64 {
        if self.is_none() {
            return robust_sum(residuals);
        }
        let channels = by_channel(evidence, residuals);
        let cost = |(_, channel, residuals)| Some(self.cost_of(place::<S>(channel)?, residuals));
        channels.filter_map(cost).sum()
    }

    /// That of one channel.
    pub fn cost_of(&self, channel: usize, residuals: &[f64]) -> f64 {
        let scale = self.variance.get(channel).copied().unwrap_or(1.0).sqrt();
        let counted = residuals.iter().filter(|r| !r.is_nan());
        counted.map(|r| loss(r / scale, HUBER)).sum()
    }
}

/// Place of a channel among those of its subject.
fn place<S: Subject>(channel: S::Channel) -> Option<usize> {
    S::CHANNELS.iter().position(|known| *known == channel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::{evidence, fit};
    use crate::plant::CHANNELS;
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;

    /// Model error of residuals x_k = memory x_(k-1) + e of a size, the same process in each of four channels of some recordings.
    fn planted(recordings: usize, memory: f64, size: f64) -> (Evidence, Vec<f64>, ModelError) {
        let evidence = evidence(recordings);
        let count = CHANNELS.len() * recordings * evidence.recordings[0].inputs.time.len();
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut last = 0.0;
        let residuals: Vec<f64> = (0..count)
            .map(|_| {
                let drawn: f64 = random.sample(StandardNormal);
                last = memory * last + (1.0f64 - memory * memory).sqrt() * drawn;
                size * last
            })
            .collect();
        let prediction = fit(residuals.clone(), vec![0.0; count], 0.0).prediction;
        let error = ModelError::of(&evidence, &prediction);
        (evidence, residuals, error)
    }

    #[test]
    fn noise_alone_is_no_model_error_and_costs_what_it_did() {
        let (evidence, residuals, error) = planted(40, 0.0, 1.0);
        assert!(error.is_none(), "{error:?}");
        assert_eq!(error.cost(&evidence, &residuals), robust_sum(&residuals));
        assert_eq!(error.left(&evidence, &fit(residuals, Vec::new(), 0.0)), 0.0);
    }

    /// Of half a second of noise, that its autocorrelation time is two samples rather than one was taken for a law that is wrong, and weighed all that was said of it.
    #[test]
    fn little_noise_is_no_model_error_either_and_what_is_wrong_is_one_still() {
        assert!(planted(1, 0.0, 1.0).2.is_none());
        assert!(planted(2, 0.0, 1.0).2.is_none());
        assert!(!planted(2, 0.9, 1.5).2.is_none());
    }

    /// Closed form of a process of first order: tau = (1 + memory) / (1 - memory), of which the sum down to 0.05 has 0.95 of what exceeds 1.
    #[test]
    fn residuals_that_are_large_and_alike_count_for_as_many_as_theory_says() {
        let (memory, size) = (0.8f64, 1.5);
        let (evidence, residuals, error) = planted(40, memory, size);
        let tau = 1.0 + 0.95 * 2.0 * memory / (1.0 - memory);
        let expected = size * size * tau;
        for variance in &error.variance {
            assert!(
                (variance / expected - 1.0).abs() < 0.25,
                "{variance}, {expected}"
            );
        }
        // Each sample is worth one over the variance, so that the cost is that of the few that are independent.
        let cost = error.cost(&evidence, &residuals);
        let independent = residuals.len() as f64 / tau;
        assert!(
            (cost / independent - 1.0).abs() < 0.25,
            "{cost}, {independent}"
        );
    }
}
