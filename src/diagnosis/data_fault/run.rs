//! Runs of equal readings: a channel that stands still for a while, and one that is sampled and held.

use super::fault::{DataFault, Kind};
use super::line::Line;
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording};
use crate::plant::CHANNELS;
use crate::stats::{median, median_step};

/// Time for which a channel must stand still to be frozen [s].
const LEAST_TIME: f64 = 0.1;
/// Readings of it.
const LEAST_RUN: usize = 15;
/// Times that a frozen stretch is as long as the usual run of equal readings [1]: a held channel and a coarse converter have runs of their own.
const LONGER: f64 = 4.0;
/// Share of readings elsewhere that are equal to the one before, beyond which a channel has little noise to stand still in [1].
const OFTEN: f64 = 0.2;
/// Frozen stretches of a channel in a recording at most.
const MOST: usize = 3;
/// Share of readings equal to the one before from which a channel is held [1].
const HELD_SHARE: f64 = 0.45;
/// Share of the changes that come at multiples of the period [1].
const AT_MULTIPLES: f64 = 0.97;
/// Changes below which nothing is said of a period.
const LEAST_CHANGES: usize = 20;

/// Stretches of equal finite readings: first and last index.
fn runs(values: &[f64]) -> Vec<[usize; 2]> {
    let mut found: Vec<[usize; 2]> = Vec::new();
    for (i, value) in values.iter().enumerate().filter(|(_, v)| v.is_finite()) {
        match found.last_mut() {
            Some([_, last]) if *last + 1 == i && values[*last] == *value => *last = i,
            _ => found.push([i, i]),
        }
    }
    found
}

/// Sets aside all readings of a run but the first.
pub(super) fn keep_firsts(values: &mut [f64]) {
    for [first, last] in runs(values) {
        values[first + 1..=last].fill(f64::NAN);
    }
}

/// Channels that stand still for a while. A reading at the end of its range is clipped, not frozen; one of a channel that hardly varies, or of a coarse converter,
/// stands still in many places.
pub(super) fn frozen(case: &DiagnosisInput) -> Vec<DataFault> {
    let mut faults = Vec::new();
    for recording in &case.recordings {
        let time = &recording.recorded.inputs.time;
        for (channel, values) in CHANNELS.into_iter().zip(&recording.recorded.readings) {
            let runs = runs(values);
            let usual =
                median(runs.iter().map(|[first, last]| (last - first + 1) as f64)).unwrap_or(0.0);
            let finite = || values.iter().copied().filter(|v| v.is_finite());
            let ends = [
                finite().fold(f64::INFINITY, f64::min),
                finite().fold(f64::NEG_INFINITY, f64::max),
            ];
            let long = |[first, last]: &[usize; 2]| {
                let count = last - first + 1;
                count >= LEAST_RUN.max((LONGER * usual) as usize)
                    && time[*last] - time[*first] >= LEAST_TIME
                    && !ends.contains(&values[*first])
            };
            let long: Vec<[usize; 2]> = runs.iter().copied().filter(long).collect();
            let within: usize = long.iter().map(|[first, last]| last - first).sum();
            let elsewhere = finite().count().saturating_sub(within).max(1);
            let equal = 1.0 - (runs.len() as f64 / elsewhere as f64).min(1.0);
            // A converter that stands still at rest does so in many places.
            let is_noisy = equal < OFTEN || period(time, values).is_some();
            if long.is_empty() || long.len() > MOST || !is_noisy {
                continue;
            }
            for [first, last] in long {
                let end = time.get(last + 1).unwrap_or(&time[last]);
                let span = [time[first], *end];
                let name = Some(recording.name.as_str());
                faults.push(DataFault::of(Kind::Frozen(span), channel, name, 0.99));
            }
        }
    }
    faults
}

/// Channels that are sampled and held, with the period of each recording.
pub(super) fn held(case: &DiagnosisInput) -> Vec<DataFault> {
    let mut faults = Vec::new();
    for channel in CHANNELS {
        let periods: Vec<(&NamedRecording, f64)> = (case.recordings.iter())
            .filter_map(|recording| {
                let inputs = &recording.recorded.inputs;
                let values = &recording.recorded.readings[channel as usize];
                Some((recording, period(&inputs.time, values)?))
            })
            .collect();
        let Some((_, first)) = periods.first() else {
            continue;
        };
        let alike = |period: f64| (period / first - 1.0).abs() < 0.02;
        let same = periods.iter().all(|(_, period)| alike(*period));
        if same && periods.len() == case.recordings.len() {
            let middle = periods[periods.len() / 2].1;
            faults.push(DataFault::of(Kind::Held(middle), channel, None, 0.99));
            continue;
        }
        for (recording, period) in periods {
            let name = Some(recording.name.as_str());
            faults.push(DataFault::of(Kind::Held(period), channel, name, 0.99));
        }
    }
    faults
}

/// Period with which a channel is sampled and held [s]; none where it is not.
fn period(time: &[f64], values: &[f64]) -> Option<f64> {
    let runs = runs(values);
    let finite = values.iter().filter(|v| v.is_finite()).count();
    if runs.len() < LEAST_CHANGES || (1.0 - runs.len() as f64 / finite as f64) < HELD_SHARE {
        return None;
    }
    let starts: Vec<f64> = runs.iter().map(|[first, _]| time[*first]).collect();
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let usual = median_step(&starts);
    // Counted on from change to change; now and then two samples are equal by chance, or frozen.
    let mut number = 0.0;
    let mut numbered = vec![(0.0, starts[0])];
    for pair in starts.windows(2) {
        number += ((pair[1] - pair[0]) / usual).round().max(1.0);
        numbered.push((number, pair[1]));
    }
    let line = Line::through(numbered.iter().copied())?;
    let period = line.slope;
    let on = numbered
        .iter()
        .filter(|(n, t)| (t - line.at(*n)).abs() <= 0.75 * step)
        .count();
    let count = numbered.len() as f64;
    (period > 1.5 * step && on as f64 >= AT_MULTIPLES * count).then_some(period)
}
