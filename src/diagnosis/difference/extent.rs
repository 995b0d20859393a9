//! How far the best explanation goes: its largest departure from the recordings, each predicted by a fit to the others too.

use super::remaining::Remaining;
use crate::diagnosis::fit::cross_validation::predictive;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::diagnosis::recordings::evidence::by_channel;
use crate::diagnosis::search::ranking::Ranked;
use crate::plant::{CHANNELS, Channel};
use crate::stats::quantile;

/// 90th percentile of a departure up to which it is near the noise, in standard deviations [1]: of noise alone it is 1.64.
pub(in crate::diagnosis) const NEAR_NOISE: f64 = 2.0;

/// The same of a recording predicted by a fit to the others [1]: its deviation is linear in the numbers, an impact at the end of the stroke is not.
const NEAR_NOISE_LEFT_OUT: f64 = 2.5;

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
    /// Of an explanation; none where nothing was measured. `remaining` is what was taken as the noise of a part of the device.
    #[must_use]
    pub fn of(evidence: &Evidence, best: &Ranked, remaining: Option<&Remaining>) -> Option<Self> {
        let fit = &best.hypothesis.fit;
        let fitted = by_channel(evidence, &fit.prediction.residuals);
        let mut all: Vec<Self> = fitted
            .filter_map(|(recording, channel, residuals)| {
                let p90 = percentile_90(residuals.iter().copied())?;
                Some(Self {
                    recording,
                    channel,
                    left_out: false,
                    p90,
                })
            })
            .collect();
        for (recording, residuals) in best
            .left_out
            .iter()
            .flat_map(|left| left.residuals.iter().enumerate())
        {
            let deviations = predictive(evidence, fit, recording);
            for channel in CHANNELS {
                let index = channel as usize;
                let residuals = residuals[index].iter().enumerate();
                let counted = residuals
                    .map(|(i, r)| r / deviations.as_ref().map_or(1.0, |all| all[index][i]));
                all.extend(percentile_90(counted).map(|p90| Self {
                    recording,
                    channel,
                    left_out: true,
                    p90,
                }));
            }
        }
        let of_noise = |largest: Self| match remaining.filter(|r| r.channel == largest.channel) {
            Some(remaining) => Self {
                p90: largest.p90 * remaining.size.max(remaining.noise) / remaining.noise,
                ..largest
            },
            None => largest,
        };
        let all = all.into_iter().map(of_noise);
        // One beyond its bound comes before a larger one that is within its own.
        let order = |one: &Self| (!one.is_near_noise(), one.p90);
        all.max_by(|a, b| {
            let [(a, a_size), (b, b_size)] = [order(a), order(b)];
            a.cmp(&b).then(a_size.total_cmp(&b_size))
        })
    }

    /// Whether it is near the noise.
    #[must_use]
    pub fn is_near_noise(&self) -> bool {
        let near = match self.left_out {
            true => NEAR_NOISE_LEFT_OUT,
            false => NEAR_NOISE,
        };
        self.p90 <= near
    }
}

/// 90th percentile of the size of what is finite; none where nothing is.
pub(in crate::diagnosis) fn percentile_90(values: impl Iterator<Item = f64>) -> Option<f64> {
    quantile(values.filter(|v| v.is_finite()).map(f64::abs), 0.9)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::cross_validation::LeftOut;
    use crate::diagnosis::fit::hypothesis::Hypothesis;
    use crate::diagnosis::test_evidence::{evidence, fit};
    use crate::plant::CHANNELS;

    #[test]
    fn the_percentile_is_of_sizes_and_of_what_is_finite() {
        let values = (-5..=5).map(f64::from).chain([f64::NAN]);
        assert_eq!(percentile_90(values), Some(5.0));
        let one_far_off = (0..11).map(|i| if i == 3 { 1e9 } else { f64::from(i) });
        assert_eq!(percentile_90(one_far_off), Some(10.0));
        assert_eq!(percentile_90([f64::NAN].into_iter()), None);
    }

    /// The channel that was planted, in the recording that was left out, by the size that was planted over what the prediction's uncertainty makes of it.
    #[test]
    fn the_largest_departure_is_the_planted_one() {
        let evidence = evidence(2);
        let samples = evidence.recordings[0].inputs.time.len();
        let count = 2 * CHANNELS.len() * samples;
        let mut best = Ranked {
            hypothesis: Hypothesis {
                effects: Vec::new(),
                fit: fit(vec![1.0; count], vec![0.0; count], 0.0),
                depends_on: Vec::new(),
            },
            score: 0.0,
            odds: 1.0,
            probability: 1.0,
            left_out: Some(LeftOut {
                residuals: vec![vec![vec![1.0; samples]; CHANNELS.len()]; 2],
                values: vec![vec![0.0]; 2],
            }),
        };
        let near = Largest::of(&evidence, &best, None).unwrap();
        assert!(near.is_near_noise() && near.p90 == 1.0, "{near:?}");

        let left = best.left_out.as_mut().unwrap();
        left.residuals[1][Channel::Force as usize] = vec![-7.0; samples];
        let found = Largest::of(&evidence, &best, None).unwrap();
        let expected = Largest {
            recording: 1,
            channel: Channel::Force,
            left_out: true,
            p90: 7.0,
        };
        assert_eq!(found, expected);
        assert!(!found.is_near_noise());

        // A fit to all has less of an excuse than one to the others.
        let left = best.left_out.as_mut().unwrap();
        left.residuals[1][Channel::Force as usize] = vec![-2.4; samples];
        let found = Largest::of(&evidence, &best, None).unwrap();
        assert!(found.left_out && found.is_near_noise(), "{found:?}");
        best.hypothesis.fit = fit(vec![2.2; count], vec![0.0; count], 0.0);
        let found = Largest::of(&evidence, &best, None).unwrap();
        assert!(!found.left_out && !found.is_near_noise(), "{found:?}");
        best.hypothesis.fit = fit(vec![1.0; count], vec![0.0; count], 0.0);
        best.left_out.as_mut().unwrap().residuals[1][Channel::Force as usize] = vec![-7.0; samples];

        // What was taken as the noise of a part is none of its sensor's.
        let remaining = Remaining {
            channel: Channel::Force,
            size: 2.4,
            noise: 0.8,
            autocorrelation_samples: 1.0,
            time: 0.004,
        };
        let found = Largest::of(&evidence, &best, Some(&remaining)).unwrap();
        assert!((found.p90 - 21.0).abs() < 1e-9, "{found:?}");
    }
}
