//! Faults held against the best explanation: what a zero leaves there is added to it, and a fault that the explanation denies is withdrawn.
//!
//! ```text
//! z = |size| / s,   s^2 = s_r^2 t (1 / n_1 + 1 / n_2)
//! ```
//!
//! z how sure a size is [1], s_r standard deviation of what the explanation leaves, t the samples that tell as much as one, n_1 and n_2 readings on either side.

use super::fault::{DataFault, Kind};
use crate::diagnosis::fit::autocorrelation::integrated_autocorrelation_time;
use crate::diagnosis::recordings::evidence::{Evidence, by_channel};
use crate::plant::Channel;
use crate::stats::{NORMAL_MAD, median};

/// Time on either side of a jump from which its size is taken [s].
const BESIDE: f64 = 0.8;
/// Readings on either side.
const LEAST: usize = 20;
/// Standard deviations below which a zero is doubted [1].
const SURE: f64 = 5.0;
/// Standard deviations of what is left beyond which it is added to the size [1].
const LEFT: f64 = 3.0;
/// Share of its size by which the explanation may change a zero before it is doubted [1].
const CHANGED: f64 = 0.5;
/// Probability of a fault that is doubted [1].
const DOUBTED: f64 = 0.3;
/// Times the sheet's noise that is left below which its noise is none of the sensor's [1].
const LOUD: f64 = 1.3;
/// Residual beyond which a reading is an impact or wild, in times the middle one [1].
const WILD: f64 = 5.0;

/// The faults as the best explanation's residuals have them. `sheet` is the noise of the sensors' sheets, `residuals` those of the best explanation in standard deviations of the evidence's noise.
#[must_use]
pub fn refined(
    faults: &[DataFault],
    evidence: &Evidence,
    sheet: &[f64; 4],
    residuals: &[f64],
) -> Vec<DataFault> {
    let refine = |fault: &DataFault| match (fault.kind, fault.channel) {
        (Kind::ZeroJump(size, at), Some(channel)) => {
            let sides = sides(fault, channel, evidence, residuals, at);
            resized(fault, size, sides, |size| Kind::ZeroJump(size, at))
        }
        (Kind::ZeroOffset(size), Some(channel)) if !fault.stays => {
            let all = pooled(fault, channel, evidence, residuals);
            resized(fault, size, [Vec::new(), all], Kind::ZeroOffset)
        }
        (Kind::Noise(_), Some(channel)) => {
            let all = pooled(fault, channel, evidence, residuals);
            let (_, deviation) = level(&all);
            let own = deviation < LOUD * sheet[channel as usize] && all.len() > LEAST;
            (!own).then(|| fault.clone())
        }
        _ => Some(fault.clone()),
    };
    faults.iter().filter_map(refine).collect()
}

/// Finite residuals of a channel in the recordings of a fault, in the channel's unit, with their times.
fn left<'a>(
    fault: &'a DataFault,
    channel: Channel,
    evidence: &'a Evidence,
    residuals: &'a [f64],
) -> impl Iterator<Item = (f64, f64)> + 'a {
    let noise = evidence.noise[channel as usize];
    by_channel(evidence, residuals)
        .filter(move |(recording, of, _)| {
            let name = &evidence.recordings[*recording].name;
            *of == channel && fault.recording.as_ref().is_none_or(|own| own == name)
        })
        .flat_map(move |(recording, _, residuals)| {
            let time = &evidence.recordings[recording].inputs.time;
            time.iter()
                .zip(residuals)
                .map(move |(t, r)| (*t, r * noise))
        })
        .filter(|(_, r)| r.is_finite())
}

fn pooled(fault: &DataFault, channel: Channel, evidence: &Evidence, residuals: &[f64]) -> Vec<f64> {
    left(fault, channel, evidence, residuals)
        .map(|(_, r)| r)
        .collect()
}

/// Residuals shortly before and after a time [s].
fn sides(
    fault: &DataFault,
    channel: Channel,
    evidence: &Evidence,
    residuals: &[f64],
    at: f64,
) -> [Vec<f64>; 2] {
    let near = left(fault, channel, evidence, residuals).filter(|(t, _)| (t - at).abs() < BESIDE);
    let (before, after): (Vec<_>, Vec<_>) = near.partition(|(t, _)| *t < at);
    [before, after].map(|side| side.into_iter().map(|(_, r)| r).collect())
}

/// Mean and standard deviation, wild ones set aside.
fn level(values: &[f64]) -> (f64, f64) {
    let middle = median(values.iter().copied()).unwrap_or(0.0);
    let sizes = values.iter().map(|v| (v - middle).abs());
    let usual = NORMAL_MAD * median(sizes).unwrap_or(0.0);
    let kept = values
        .iter()
        .filter(|v| (*v - middle).abs() <= WILD * usual);
    let kept: Vec<f64> = kept.copied().collect();
    let count = kept.len().max(1) as f64;
    let mean = kept.iter().sum::<f64>() / count;
    let variance = kept.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt())
}

/// A zero with what is left added to it; withdrawn where nothing of it remains, doubted where little does.
fn resized(
    fault: &DataFault,
    size: f64,
    [before, after]: [Vec<f64>; 2],
    kind: impl Fn(f64) -> Kind,
) -> Option<DataFault> {
    let is_step = matches!(fault.kind, Kind::ZeroJump(..));
    if after.len() < LEAST || (is_step && before.len() < LEAST) {
        return Some(fault.clone());
    }
    let (left_before, scatter_before) = level(&before);
    let (left_after, scatter_after) = level(&after);
    let alike = |values: &[f64]| integrated_autocorrelation_time(values);
    let variance = |scatter: f64, values: &[f64]| match values.is_empty() {
        true => 0.0,
        false => scatter.powi(2) * alike(values) / values.len() as f64,
    };
    let own = (variance(scatter_before, &before) + variance(scatter_after, &after)).sqrt();
    let change = left_after - left_before;
    let change = if change.abs() > LEFT * own {
        change
    } else {
        0.0
    };
    let value = size + change;
    let remains = value * size.signum() > (1.0 - CHANGED) * size.abs();
    if !remains && value.abs() < SURE * own {
        return None;
    }
    let doubted = !remains || value.abs() < SURE * own || change.abs() > CHANGED * size.abs();
    Some(DataFault {
        kind: kind(value),
        probability: match doubted {
            true => fault.probability.min(DOUBTED),
            false => fault.probability,
        },
        ..fault.clone()
    })
}
