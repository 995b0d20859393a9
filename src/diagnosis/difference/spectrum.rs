//! Periodic parts of what is left in the force while the tool touches.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use rayon::prelude::*;

use crate::diagnosis::recordings::evidence::{Evidence, Prediction};
use crate::effects::{known_turns, tool_turns_at};
use crate::plant::{Channel, PHASES};

/// Samples below which nothing is said [1].
const LEAST_SAMPLES: usize = 50;
/// Distance of the frequencies looked at [Hz].
const SPACING: f64 = 0.025;
/// Those looked at, in that distance, beside those at which the tool is known to turn.
const INDICES: Range<usize> = 20..4000;

/// Gain in a sum of squares by phases of their own beyond which the recordings' phases differ: far beyond what noise gains by one phase a recording [1].
const GAIN_OF_PHASES: f64 = 50.0;
/// Power with phases of their own over that with one, beyond which they differ [1]; below it they are alike within 20 degrees or so.
const RATIO_OF_PHASES: f64 = 1.05;
/// Power beside the strongest below which a recording has no phase that is worth its number [1].
const NO_PHASE: f64 = 1e-3;

/// A periodic part of what is left.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Frequency [Hz].
    pub frequency: f64,
    /// Where the recordings' phases differ, those of the recordings after the first that has it, ahead of it [rad], by their place.
    pub phases: Vec<(usize, f64)>,
}

/// The strongest periodic parts of the force while touching, the strongest first, at most two at which the tool may turn and two others, by least squares of
/// a sine over all recordings; with the same phase in all, but for one of either kind that is much stronger with phases of their own.
pub fn strongest(evidence: &Evidence, prediction: &Prediction) -> Vec<Line> {
    let of_tool = |frequency: f64| tool_turns_at(&prediction.plant, frequency);
    let left = Left::of(evidence, prediction, Channel::Force as usize);
    let own: Vec<Line> = left.with_phases(of_tool);
    let peaks = left.peaks(coherent);
    let lines = peaks.into_iter().map(|frequency| Line {
        frequency,
        phases: Vec::new(),
    });
    let (low, high): (Vec<Line>, Vec<Line>) = own
        .into_iter()
        .chain(lines)
        .partition(|line| !of_tool(line.frequency));
    low.into_iter()
        .take(2)
        .chain(high.into_iter().take(2))
        .collect()
}

/// Frequencies [Hz] of the periodic parts of what is left in a channel, strongest first; of the force while touching alone.
pub fn strongest_in(evidence: &Evidence, prediction: &Prediction, channel: usize) -> Vec<f64> {
    Left::of(evidence, prediction, channel).peaks(coherent)
}

/// What is left in a channel, of the force while touching alone, by recording: time [s] and value, outliers clipped [standard deviations].
struct Left {
    recordings: Vec<Vec<[f64; 2]>>,
    mean: f64,
    count: usize,
    /// Frequencies at which the tool may turn [Hz]; zero where they are not known.
    turns: [f64; 2],
}

/// Sum of sines and cosines over a recording: real and imaginary part.
type Sum = [f64; 2];

/// Power with the same phase in all recordings.
fn coherent(sums: &[Sum]) -> f64 {
    let [c, s] = sums
        .iter()
        .fold([0.0; 2], |[c, s], sum| [c + sum[0], s + sum[1]]);
    c * c + s * s
}

/// Power with a phase of its own in each.
fn of_own_phases(sums: &[Sum]) -> f64 {
    sums.iter().map(|[c, s]| c.hypot(*s)).sum::<f64>().powi(2)
}

impl Left {
    fn of(evidence: &Evidence, prediction: &Prediction, channel: usize) -> Self {
        let mut recordings = Vec::new();
        let mut at = 0;
        for (measured, trajectory) in evidence.recordings.iter().zip(&prediction.trajectories) {
            let n = measured.inputs.time.len();
            let left_over = &prediction.residuals[at + channel * n..at + (channel + 1) * n];
            at += 4 * n;
            let mut own = Vec::new();
            for (i, &value) in left_over.iter().enumerate() {
                let touching = trajectory.truth.contact_force[i] > 0.0
                    && measured.inputs.surface[i].is_finite();
                if value.is_finite() && (touching || channel != 2) {
                    own.push([measured.inputs.time[i], value.clamp(-20.0, 20.0)]);
                }
            }
            recordings.push(own);
        }
        let count = recordings.iter().map(Vec::len).sum();
        let values = recordings.iter().flatten().map(|[_, value]| value);
        Self {
            mean: values.sum::<f64>() / count as f64,
            recordings,
            count,
            turns: known_turns(&prediction.plant).unwrap_or_default(),
        }
    }

    fn sums(&self, frequency: f64) -> Vec<Sum> {
        let of = |recording: &Vec<[f64; 2]>| {
            let (mut c, mut s) = (0.0, 0.0);
            for [t, x] in recording {
                let (sin, cos) = (TAU * frequency * t).sin_cos();
                c += (x - self.mean) * cos;
                s += (x - self.mean) * sin;
            }
            [c, s]
        };
        self.recordings.iter().map(of).collect()
    }

    /// Frequencies [Hz] at which a power has its peaks, the highest first.
    fn peaks(&self, power: impl Fn(&[Sum]) -> f64 + Sync) -> Vec<f64> {
        if self.count < LEAST_SAMPLES {
            return vec![];
        }
        let [from, to] = self.turns.map(|end| (end / SPACING) as usize);
        let above = from.max(INDICES.end)..to.max(INDICES.end);
        let indices = INDICES.chain(above);
        let frequencies: Vec<f64> = indices.map(|i| i as f64 * SPACING).collect();
        let powers: Vec<f64> = frequencies
            .par_iter()
            .map(|f| power(&self.sums(*f)))
            .collect();
        let mut peaks: Vec<(f64, f64)> = (1..powers.len() - 1)
            .filter(|&i| powers[i] > powers[i - 1] && powers[i] >= powers[i + 1])
            .map(|i| (powers[i], frequencies[i]))
            .collect();
        peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
        peaks.into_iter().map(|(_, frequency)| frequency).collect()
    }

    /// The strongest line at which the tool may turn and the strongest other one, where the recordings' phases differ.
    fn with_phases(&self, of_tool: impl Fn(f64) -> bool) -> Vec<Line> {
        let peaks = self.peaks(of_own_phases);
        let strongest = |tool: bool| peaks.iter().find(|f| of_tool(**f) == tool);
        let lines = [strongest(false), strongest(true)].into_iter().flatten();
        lines
            .filter_map(|frequency| self.line_of_phases(*frequency))
            .collect()
    }

    fn line_of_phases(&self, frequency: f64) -> Option<Line> {
        let sums = self.sums(frequency);
        let [one, own] = [coherent(&sums), of_own_phases(&sums)];
        let gain = 2.0 * (own - one) / self.count as f64;
        if gain < GAIN_OF_PHASES || own < RATIO_OF_PHASES * one {
            return None;
        }
        let worth = sums.iter().map(|[c, s]| c * c + s * s).fold(0.0, f64::max) * NO_PHASE;
        // A sine of phase p has sums in proportion to sin p and cos p.
        let phases = sums
            .iter()
            .enumerate()
            .filter(|(_, [c, s])| c * c + s * s > worth);
        let mut phases = phases.map(|(place, [c, s])| (place, c.atan2(*s)));
        let (_, first) = phases.next()?;
        let phases = phases.filter(|(place, _)| *place < PHASES);
        let ahead = |phase: f64| (phase - first + PI).rem_euclid(TAU) - PI;
        Some(Line {
            frequency,
            phases: phases.map(|(place, phase)| (place, ahead(phase))).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left(phases: &[f64]) -> Left {
        let of = |phase: &f64| {
            let times = (0..2000).map(|i| 0.003 * f64::from(i));
            let wave = |t: f64| {
                [
                    t,
                    3.0 * (TAU * 7.3 * t + phase).sin() + (71.0 * t * t).sin(),
                ]
            };
            times.map(wave).collect::<Vec<[f64; 2]>>()
        };
        let recordings: Vec<Vec<[f64; 2]>> = phases.iter().map(of).collect();
        Left {
            count: recordings.iter().map(Vec::len).sum(),
            recordings,
            mean: 0.0,
            turns: [0.0; 2],
        }
    }

    #[test]
    fn phases_that_differ_between_recordings_are_found() {
        let lines = left(&[0.4, 2.4, -1.6]).with_phases(|f| f >= 11.0);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!((lines[0].frequency - 7.3).abs() < 0.03, "{lines:?}");
        for (place, expected) in [(1, 2.0), (2, -2.0)] {
            let (found, phase) = lines[0].phases[place - 1];
            assert!(
                found == place && (phase - expected).abs() < 0.05,
                "{lines:?}"
            );
        }
    }

    #[test]
    fn one_phase_is_no_phase_of_each() {
        assert_eq!(left(&[0.4, 0.4, 0.4]).with_phases(|f| f >= 11.0), []);
        let peaks = left(&[0.4, 0.4]).peaks(coherent);
        assert!((peaks[0] - 7.3).abs() < 0.03, "{peaks:?}");
    }
}
