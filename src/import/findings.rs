//! Content of a log, channel by channel: rate, gaps, range, noise, steps of its converter, and what makes its unit doubtful.
//!
//! ```text
//! noise = 1.4826 median |x_{i+1} - 2 x_i + x_{i-1}| / sqrt 6          white noise on a smooth trajectory (Gasser, Sroka and Jennen-Steinmetz 1986)
//! ```

use serde::Serialize;

use super::assemble::{Imported, LogNote};
use super::doubts;
use super::log::Series;
use super::map::{ChannelMap, ImportMap};
use crate::stats::{NORMAL_MAD, median, median_step};

/// Median steps from which a step is a gap.
const GAP: f64 = 3.0;
/// Distinct values over samples below which a channel may be quantised, and share of its steps that must be whole.
const FEW: f64 = 0.5;
const WHOLE: f64 = 0.99;
/// Share of samples at an extreme value from which a channel is held to be cut off there.
const CUT: f64 = 0.005;
/// Share of rows that two logs must have in common to be the same data.
const SAME: f64 = 0.9;

/// Findings about a channel, as `idc import --json` has them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// The quantity.
    pub quantity: String,
    /// SI unit of the numbers here.
    pub unit: &'static str,
    /// Unit of the log.
    pub logged_in: &'static str,
    /// Samples, and those of them without a value.
    pub samples: usize,
    /// Samples without a value.
    pub missing: usize,
    /// Samples a second, in the median [Hz].
    #[serde(rename = "rate_hz")]
    pub rate: f64,
    /// Gaps, from when to when, the longest first [s].
    #[serde(rename = "gaps_s")]
    pub gaps: Vec<[f64; 2]>,
    /// Least value; infinite where there is none.
    pub least: f64,
    /// Largest value; infinite where there is none.
    pub most: f64,
    /// Standard deviation of its noise, if there are samples enough.
    pub noise: Option<f64>,
    /// Step of its converter, if it has one.
    #[serde(rename = "step")]
    pub quantum: Option<f64>,
    /// Values at which it is cut off.
    pub cut_off_at: Vec<f64>,
    /// Signs that make its unit, or its reading, doubtful.
    pub doubts: Vec<String>,
}

/// Findings of all channels.
#[must_use]
pub fn findings(imported: &Imported, map: &ImportMap) -> Vec<Finding> {
    let mut all = Vec::new();
    for (log, file) in imported.logs.iter().zip(&map.files) {
        for (series, channel) in log.series.iter().zip(&file.channels) {
            let mut found = finding(series, channel);
            found.doubts.extend(doubts::of_time(file, series));
            found
                .doubts
                .extend(doubts::of_command(&imported.recording, channel));
            if map.says_itself {
                found.doubts.clear();
                found.cut_off_at.clear();
            }
            all.push(found);
        }
    }
    all
}

/// Finding of one channel by itself.
pub(super) fn finding(series: &Series, channel: &ChannelMap) -> Finding {
    let there: Vec<f64> = series
        .values
        .iter()
        .copied()
        .filter(|v| v.is_finite())
        .collect();
    let range = there
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(*v), high.max(*v)]
        });
    let step = median_step(&series.time);
    let mut gaps: Vec<[f64; 2]> = series
        .time
        .windows(2)
        .filter(|pair| pair[1] - pair[0] > GAP * step)
        .map(|pair| [pair[0], pair[1]])
        .collect();
    gaps.sort_by(|a, b| (b[1] - b[0]).total_cmp(&(a[1] - a[0])));
    let (noise, quantum) = (noise(&there), quantum(&there));
    // A command has no noise, and stays at its value.
    let cut_off_at = match noise {
        Some(noise) if noise > 0.0 => cut_off_at(&there, range),
        _ => Vec::new(),
    };
    Finding {
        quantity: channel.quantity.clone(),
        unit: channel.unit.si.symbol(),
        logged_in: channel.unit.name,
        samples: series.time.len(),
        missing: series.values.len() - there.len(),
        rate: if step > 0.0 { 1.0 / step } else { 0.0 },
        gaps,
        least: range[0],
        most: range[1],
        noise,
        quantum,
        doubts: doubts::of_channel(channel, &there, range, quantum, &cut_off_at),
        cut_off_at,
    }
}

/// Standard deviation of white noise on a smooth trajectory.
#[must_use]
pub fn noise(values: &[f64]) -> Option<f64> {
    let bends = values.windows(3).map(|w| (w[2] - 2.0 * w[1] + w[0]).abs());
    if bends.len() < 20 {
        return None;
    }
    Some(NORMAL_MAD * median(bends)? / 6.0f64.sqrt())
}

/// The step of a converter: the least difference of distinct values, where the others are whole multiples of it.
fn quantum(values: &[f64]) -> Option<f64> {
    let mut distinct = values.to_vec();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    if distinct.len() < 3 || distinct.len() as f64 > FEW * values.len() as f64 {
        return None;
    }
    let span = distinct[distinct.len() - 1] - distinct[0];
    // What is less is the rounding of a decimal number.
    let steps: Vec<f64> = distinct
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|step| *step > 1e-9 * span)
        .collect();
    let least = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let whole = |step: &&f64| {
        let multiple = **step / least;
        (multiple - multiple.round()).abs() < 0.05 * multiple.sqrt().min(5.0)
    };
    let share = steps.iter().filter(whole).count() as f64 / steps.len() as f64;
    (share > WHOLE).then_some(least)
}

/// Extreme values at which a channel stays.
fn cut_off_at(values: &[f64], [low, high]: [f64; 2]) -> Vec<f64> {
    if low >= high {
        return Vec::new();
    }
    let stays = |end: &f64| {
        // A converter's lowest step is often zero, and a thing at rest stays where it is.
        let runs = values
            .windows(5)
            .filter(|w| w.iter().all(|v| v == end))
            .count();
        *end != 0.0 && runs as f64 > CUT * values.len() as f64
    };
    [low, high].into_iter().filter(stays).collect()
}

/// Share of the rows of two logs that are the same, values for values, if it is most of them: one is a copy of the other.
#[must_use]
pub fn same_data(one: &LogNote, other: &LogNote) -> Option<f64> {
    let rows = |log: &LogNote| -> std::collections::BTreeSet<Vec<u64>> {
        let count = log.series.first().map_or(0, |s| s.values.len());
        let even = log.series.iter().all(|s| s.values.len() == count);
        let count = if even { count } else { 0 };
        (0..count)
            .map(|i| log.series.iter().map(|s| s.values[i].to_bits()).collect())
            .collect()
    };
    if one.quantities != other.quantities {
        return None;
    }
    let (a, b) = (rows(one), rows(other));
    let least = a.len().min(b.len());
    if least < 10 {
        return None;
    }
    let share = a.intersection(&b).count() as f64 / least as f64;
    (share > SAME).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(of: impl Fn(f64) -> f64) -> Series {
        let time: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
        let values = time.iter().map(|t| of(*t)).collect();
        Series { time, values }
    }

    /// Noise of a standard deviation of 1, the same every time.
    fn rough(t: f64) -> f64 {
        let mut state = (t * 1e6) as u64 ^ 0x9e37_79b9_7f4a_7c15;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        uniform();
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    #[test]
    fn noise_and_rate_come_back() {
        let smooth = series(|t| 40.0 * (0.7 * t).sin() + 0.5 * rough(t));
        let found = finding(&smooth, &ChannelMap::unconverted("force", "N"));
        assert!((found.noise.unwrap() / 0.5 - 1.0).abs() < 0.1, "{found:?}");
        assert!((found.rate - 100.0).abs() < 1e-6);
        assert!(found.gaps.is_empty() && found.quantum.is_none() && found.doubts.is_empty());
        assert!(found.cut_off_at.is_empty());
    }

    #[test]
    fn steps_of_a_converter_are_seen() {
        let stepped = series(|t| 0.0025 * (400.0 * (3.0 * t).sin()).round());
        let found = finding(&stepped, &ChannelMap::unconverted("stroke", "m"));
        assert!(
            (found.quantum.unwrap() / 0.0025 - 1.0).abs() < 1e-6,
            "{found:?}"
        );
    }

    #[test]
    fn a_channel_that_is_cut_off_is_seen() {
        let cut = series(|t| (30.0 * t.sin() + rough(t)).min(20.0));
        assert_eq!(
            finding(&cut, &ChannelMap::unconverted("force", "N")).cut_off_at,
            [20.0]
        );
    }

    #[test]
    fn gaps_are_listed_the_longest_first() {
        let mut gapped = series(|t| t);
        gapped.time[500..].iter_mut().for_each(|t| *t += 1.0);
        gapped.time[900..].iter_mut().for_each(|t| *t += 3.0);
        let gaps = finding(&gapped, &ChannelMap::unconverted("force", "N")).gaps;
        assert_eq!(gaps.len(), 2);
        assert!((gaps[0][1] - gaps[0][0] - 3.01).abs() < 1e-9);
    }
}
