//! How far the best explanation goes: its largest departure from the recordings, each predicted by a fit to the others too.

use super::cross_validation::CrossValidation;
use super::diagnose::Ranked;
use super::evidence::Evidence;
use super::localise::by_channel;
use crate::plant::{CHANNELS, Channel};

/// 90th percentile of a departure up to which it is near the noise, in standard deviations [1]: of noise alone it is 1.64.
pub(super) const NEAR_NOISE: f64 = 2.0;

/// A departure of an explanation from a channel of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// Index of the recording.
    pub recording: usize,
    /// The channel.
    pub channel: Channel,
    /// Whether it was predicted by a fit to the others.
    pub left_out: bool,
    /// 90th percentile of its size, in standard deviations of its prediction [1].
    pub p90: f64,
}

impl Largest {
    /// Of an explanation; none where nothing was measured.
    #[must_use]
    pub fn of(evidence: &Evidence, best: &Ranked) -> Option<Self> {
        let fit = &best.hypothesis.fit;
        let mut all = Vec::new();
        for (recording, channel, residuals) in by_channel(evidence, &fit.prediction.residuals) {
            let p90 = percentile_90(residuals.iter().copied());
            all.extend(p90.map(|p90| Self {
                recording,
                channel,
                left_out: false,
                p90,
            }));
        }
        let turns = CrossValidation::of(evidence);
        for (turns, left) in turns.iter().zip(&best.left_out) {
            for (recording, residuals) in left.residuals.iter().enumerate() {
                let deviations = turns.predictive(fit, recording);
                for channel in CHANNELS {
                    let index = channel as usize;
                    let counted = residuals[index].iter().enumerate().map(|(i, r)| {
                        let deviation = deviations.as_ref().map_or(1.0, |all| all[index][i]);
                        r / deviation
                    });
                    all.extend(percentile_90(counted).map(|p90| Self {
                        recording,
                        channel,
                        left_out: true,
                        p90,
                    }));
                }
            }
        }
        all.into_iter().max_by(|a, b| a.p90.total_cmp(&b.p90))
    }

    /// Whether it is near the noise.
    #[must_use]
    pub fn is_near_noise(&self) -> bool {
        self.p90 <= NEAR_NOISE
    }
}

/// 90th percentile of the size of what is finite; none where nothing is.
pub(super) fn percentile_90(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sizes: Vec<f64> = values.filter(|v| v.is_finite()).map(f64::abs).collect();
    if sizes.is_empty() {
        return None;
    }
    let place = (0.9 * (sizes.len() - 1) as f64) as usize;
    Some(*sizes.select_nth_unstable_by(place, f64::total_cmp).1)
}
