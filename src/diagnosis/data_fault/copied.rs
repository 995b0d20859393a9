//! Readings that stand in two places: a stretch that was copied, by a logger that repeats its buffer or by hand.
//!
//! ```text
//! x(i + k) = x'(j + k),   k = 0 .. n - 1
//! ```
//!
//! x and x' readings of a channel in one recording or two. Noise never repeats itself: a run of so many equal readings, most of them different from one another, is
//! a copy.

use std::collections::HashMap;

use super::fault::{DataFault, Kind};
use crate::diagnosis::recordings::input::DiagnosisInput;
use crate::plant::CHANNELS;

/// Readings by which a copy is known.
const WINDOW: usize = 12;
/// Readings of a copy at least.
const LEAST: usize = 25;
/// Different readings in it at least: a coarse converter repeats itself.
const DIFFERENT: usize = 12;

/// A place: recording and index.
type Place = (usize, usize);

/// Stretches of a channel that stand at an earlier place too.
pub(super) fn copies(case: &DiagnosisInput) -> Vec<DataFault> {
    let mut faults = Vec::new();
    for channel in CHANNELS {
        let values: Vec<&[f64]> = (case.recordings.iter())
            .map(|r| &r.recorded.readings[channel as usize][..])
            .collect();
        for ([first, from], length) in of_channel(&values) {
            let recording = &case.recordings[first.0];
            let time = &recording.recorded.inputs.time;
            let last = (first.1 + length).min(time.len() - 1);
            let source = case.recordings[from.0].recorded.inputs.time[from.1];
            faults.push(DataFault::of(
                Kind::Copied([time[first.1], time[last]], source),
                channel,
                Some(&recording.name),
                0.99,
            ));
        }
    }
    faults
}

/// Copies, each with the place it was copied from, and their lengths.
fn of_channel(values: &[&[f64]]) -> Vec<([Place; 2], usize)> {
    let mut seen: HashMap<Vec<u64>, Place> = HashMap::new();
    let mut found = Vec::new();
    for (recording, own) in values.iter().enumerate() {
        let mut i = 0;
        while i + WINDOW <= own.len() {
            let window = &own[i..i + WINDOW];
            let whole = window.iter().all(|v| v.is_finite()) && different(window) > WINDOW / 2;
            let key = || window.iter().map(|v| v.to_bits()).collect::<Vec<u64>>();
            if let Some(&(other, j)) = whole.then(|| seen.get(&key())).flatten() {
                let pairs = own[i..].iter().zip(&values[other][j..]);
                let length = pairs.take_while(|(a, b)| a == b).count();
                if length >= LEAST && different(&own[i..i + length]) >= DIFFERENT {
                    found.push(([(recording, i), (other, j)], length));
                    i += length;
                    continue;
                }
            }
            if whole {
                seen.entry(key()).or_insert((recording, i));
            }
            i += 1;
        }
    }
    found
}

fn different(values: &[f64]) -> usize {
    let mut bits: Vec<u64> = values.iter().map(|v| v.to_bits()).collect();
    bits.sort_unstable();
    bits.dedup();
    bits.len()
}
