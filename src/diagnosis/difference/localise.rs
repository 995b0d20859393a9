//! Where recordings differ from a model: by recording and channel, and as intervals.

use super::mismatch::merged;
use crate::diagnosis::fit::robust_sum;
use crate::diagnosis::recordings::evidence::{Evidence, by_channel};
use crate::plant::Channel;

/// Chance that any interval is flagged where there is noise alone [1].
const FALSE_ALARM: f64 = 0.01;
/// Half the time over which residuals are taken together [s].
const HALF_WINDOW: f64 = 0.01;
/// Root mean square, in standard deviations, up to which a channel shows its noise: that is known no better [1].
pub const NOISE_ALONE: f64 = 1.15;

/// Departure of a channel of a recording from its prediction.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// Index of the recording.
    pub recording: usize,
    /// The channel.
    pub channel: Channel,
    /// Samples that count.
    pub samples: usize,
    /// Robust root mean square, in standard deviations of the noise [1].
    pub sigmas: f64,
    /// Root mean square, in the channel's unit.
    pub rms: f64,
}

/// A time in which a channel differs from a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Index of the recording.
    pub recording: usize,
    /// The channel.
    pub channel: Channel,
    /// Its start and end [s].
    pub span: [f64; 2],
}

/// Root mean square of what is finite; none where nothing is.
#[must_use]
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let (squares, count) = finite.fold((0.0, 0.0), |(sum, n), v| (sum + v * v, n + 1.0));
    (count > 0.0).then(|| f64::sqrt(squares / count))
}

/// Robust root mean square (Huber's loss, [`robust_sum`]) with the count of samples; none where nothing counts. Of residuals in standard deviations, and
/// meant for judging them: an impact that is met a sample late counts in proportion to its size and not to its square. It has no unit but one
/// standard deviation: a size in N or mm is [`root_mean_square`].
pub fn robust_rms(residuals: &[f64]) -> Option<(usize, f64)> {
    let samples = residuals.iter().filter(|r| r.is_finite()).count();
    (samples > 0).then(|| (samples, (robust_sum(residuals) / samples as f64).sqrt()))
}

/// Departure of each channel from a prediction; channels that were not measured are left out.
pub fn misfits(evidence: &Evidence, residuals: &[f64]) -> Vec<Misfit> {
    let channels = by_channel(evidence, residuals);
    channels
        .filter_map(|(recording, channel, residuals)| {
            let (samples, sigmas) = robust_rms(residuals)?;
            Some(Misfit {
                recording,
                channel,
                samples,
                sigmas,
                rms: evidence.noise[channel as usize]
                    * root_mean_square(residuals.iter().copied())?,
            })
        })
        .collect()
}

/// Where channels differ from a prediction: where means over a short time are larger than noise ever gives, or but once in a hundred such cases.
pub fn differences(evidence: &Evidence, residuals: &[f64]) -> Vec<Difference> {
    // Of N normal numbers, the chance that one exceeds z is below N exp(-z^2/2).
    let limit = (2.0 * (residuals.len() as f64 / FALSE_ALARM).ln()).sqrt();
    let mut found = Vec::new();
    for (recording, channel, residuals) in by_channel(evidence, residuals) {
        let time = &evidence.recordings[recording].inputs.time;
        let sums = running(residuals);
        let parts = |i: usize| {
            let from = time.partition_point(|t| *t < time[i] - HALF_WINDOW);
            let to = time.partition_point(|t| *t <= time[i] + HALF_WINDOW);
            let (sum, count) = (sums[to].0 - sums[from].0, sums[to].1 - sums[from].1);
            count > 0.0 && sum.abs() > limit * count.sqrt()
        };
        let spans = merged(time, parts);
        found.extend(spans.into_iter().map(|span| Difference {
            recording,
            channel,
            span,
        }));
    }
    found
}

/// Running sums and counts of what is finite.
fn running(values: &[f64]) -> Vec<(f64, f64)> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut at = (0.0, 0.0);
    sums.push(at);
    for value in values {
        if value.is_finite() {
            at = (at.0 + value, at.1 + 1.0);
        }
        sums.push(at);
    }
    sums
}
