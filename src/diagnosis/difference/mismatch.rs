//! Where the found effects act: where taking them out of the improved model, its other parameters kept, moves a channel by more than three standard
//! deviations of its sensor.

use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::with_values;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::plant::{CHANNELS, Channel, PlantParameters, simulate};
use serde::{Deserialize, Serialize};

/// Standard deviations of its sensor by which a channel must move [1].
const DEVIATIONS: f64 = 3.0;
/// Neighbours up to this far apart are one [s].
const MERGED: f64 = 0.04;
/// Time added at either end [s].
const ADDED: f64 = 0.02;

/// Where a recording differs from the model without the effects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mismatch {
    /// File name.
    pub recording: String,
    /// Column.
    pub channel: String,
    /// From [s].
    pub start_s: f64,
    /// Until [s].
    pub end_s: f64,
}

/// A time in which a channel of a recording shows the effects.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Index of the recording.
    pub recording: usize,
    /// The channel.
    pub channel: Channel,
    /// Its start [s].
    pub start: f64,
    /// Its end [s].
    pub end: f64,
}

/// The improved model without its effects, its other parameters kept.
pub fn without_effects(nominal: &PlantParameters, hypothesis: &Hypothesis) -> PlantParameters {
    let fit = &hypothesis.fit;
    let kept = hypothesis.tolerated(nominal);
    with_values(nominal, &fit.free[..kept], &fit.values[..kept])
}

/// The intervals, recording by recording, channel by channel.
pub fn intervals(
    evidence: &Evidence,
    nominal: &PlantParameters,
    hypothesis: &Hypothesis,
) -> Vec<Interval> {
    if hypothesis.finds_nothing() {
        return Vec::new();
    }
    let bare = without_effects(nominal, hypothesis);
    let mut found = Vec::new();
    for (recording, measured) in evidence.recordings.iter().enumerate() {
        let with = simulate(&hypothesis.fit.prediction.plant, &measured.inputs).readings;
        let without = simulate(&bare, &measured.inputs).readings;
        for (index, channel) in CHANNELS.into_iter().enumerate() {
            let limit = DEVIATIONS * evidence.noise[index];
            let moved = |i: usize| (with[index][i] - without[index][i]).abs() > limit;
            for [start, end] in merged(&measured.inputs.time, moved) {
                found.push(Interval {
                    recording,
                    channel,
                    start,
                    end,
                });
            }
        }
    }
    found
}

/// Runs of samples that moved, merged, widened, single samples dropped.
pub(in crate::diagnosis) fn merged(time: &[f64], moved: impl Fn(usize) -> bool) -> Vec<[f64; 2]> {
    let mut runs: Vec<([f64; 2], usize)> = Vec::new();
    for (i, t) in time.iter().enumerate() {
        if !moved(i) {
            continue;
        }
        match runs.last_mut() {
            Some((run, count)) if t - run[1] <= MERGED + 1e-9 => {
                run[1] = *t;
                *count += 1;
            }
            _ => runs.push(([*t; 2], 1)),
        }
    }
    runs.into_iter()
        .filter(|(_, count)| *count > 1)
        .map(|([start, end], _)| {
            // Nothing is said of times that were not recorded.
            [
                (start - ADDED).max(time[0]),
                (end + ADDED).min(time[time.len() - 1]),
            ]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_merged_widened_and_single_samples_dropped() {
        let time: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.004).collect();
        let moved = |i: usize| [50, 51, 60, 100, 150, 151].contains(&i);
        let found = merged(&time, moved);
        assert_eq!(found.len(), 2);
        assert!((found[0][0] - 0.18).abs() < 1e-9 && (found[0][1] - 0.26).abs() < 1e-9);
        assert!((found[1][0] - 0.58).abs() < 1e-9);
    }

    #[test]
    fn an_interval_ends_with_the_recording() {
        // A recording of 3.996 s was once said to differ until 4.02 s.
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.004).collect();
        let found = merged(&time, |i| !(3..=996).contains(&i));
        assert_eq!(found, [[0.0, 0.028], [3.968, 3.996]]);
    }
}
