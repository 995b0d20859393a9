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
/// Consecutive frequencies that are gone through by turning each sample's phase on: rounding adds up over so many.
const TURNED_ON: usize = 64;
/// Samples that are taken together.
const LANES: usize = 4;

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
    let spectrum = left.spectrum();
    let own: Vec<Line> = left.with_phases(&spectrum, of_tool);
    let peaks = peaks(&spectrum, coherent);
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
    let left = Left::of(evidence, prediction, channel);
    peaks(&left.spectrum(), coherent)
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

/// Frequencies [Hz], each with the sums of all recordings.
type Spectrum = Vec<(f64, Vec<Sum>)>;

/// Samples at a frequency, with their phasors and what turns them on to the next frequency.
struct Turning {
    value: [f64; LANES],
    phasor: [[f64; LANES]; 2],
    turn: [[f64; LANES]; 2],
}

impl Turning {
    /// Those of a recording, their mean taken off, at a frequency [Hz].
    fn all(recording: &[[f64; 2]], mean: f64, frequency: f64) -> Vec<Self> {
        let together = recording.chunks(LANES).map(|samples| {
            let mut turning = Self {
                value: [0.0; LANES],
                phasor: [[0.0; LANES]; 2],
                turn: [[0.0; LANES]; 2],
            };
            for (lane, [time, value]) in samples.iter().enumerate() {
                turning.value[lane] = value - mean;
                let (sin, cos) = (TAU * frequency * time).sin_cos();
                (turning.phasor[0][lane], turning.phasor[1][lane]) = (cos, sin);
                let (sin, cos) = (TAU * SPACING * time).sin_cos();
                (turning.turn[0][lane], turning.turn[1][lane]) = (cos, sin);
            }
            turning
        });
        together.collect()
    }

    /// The sum at their frequency; they go on to the next.
    fn sum_and_turn(samples: &mut [Self]) -> Sum {
        let mut sum = [[0.0; LANES]; 2];
        for Self {
            value,
            phasor: [cosines, sines],
            turn,
        } in samples
        {
            for lane in 0..LANES {
                let (cos, sin) = (cosines[lane], sines[lane]);
                sum[0][lane] += value[lane] * cos;
                sum[1][lane] += value[lane] * sin;
                cosines[lane] = cos * turn[0][lane] - sin * turn[1][lane];
                sines[lane] = sin * turn[0][lane] + cos * turn[1][lane];
            }
        }
        sum.map(|lanes| lanes.iter().sum())
    }
}

/// Frequencies [Hz] at which a power has its peaks, the highest first.
fn peaks(spectrum: &Spectrum, power: impl Fn(&[Sum]) -> f64) -> Vec<f64> {
    let powers: Vec<f64> = spectrum.iter().map(|(_, sums)| power(sums)).collect();
    let mut peaks: Vec<(f64, f64)> = (1..powers.len().saturating_sub(1))
        .filter(|&i| powers[i] > powers[i - 1] && powers[i] >= powers[i + 1])
        .map(|i| (powers[i], spectrum[i].0))
        .collect();
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
    peaks.into_iter().map(|(_, frequency)| frequency).collect()
}

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

    /// Sums of all recordings at all frequencies that are looked at; none of too few samples.
    fn spectrum(&self) -> Spectrum {
        if self.count < LEAST_SAMPLES {
            return Spectrum::new();
        }
        let [from, to] = self.turns.map(|end| (end / SPACING) as usize);
        let above = from.max(INDICES.end)..to.max(INDICES.end);
        let starts = [INDICES, above].map(|range| (range.end, range.step_by(TURNED_ON)));
        let runs: Vec<Range<usize>> = (starts.into_iter())
            .flat_map(|(end, starts)| starts.map(move |from| from..end.min(from + TURNED_ON)))
            .collect();
        let sums = runs.par_iter().map(|run| self.sums_over(run.clone()));
        sums.flatten_iter().collect()
    }

    /// Frequencies and sums at consecutive indices.
    fn sums_over(&self, run: Range<usize>) -> Spectrum {
        let mut turning: Vec<Vec<Turning>> = (self.recordings.iter())
            .map(|recording| Turning::all(recording, self.mean, run.start as f64 * SPACING))
            .collect();
        run.map(|index| {
            let sums = turning
                .iter_mut()
                .map(|samples| Turning::sum_and_turn(samples));
            (index as f64 * SPACING, sums.collect())
        })
        .collect()
    }

    /// The strongest line at which the tool may turn and the strongest other one, where the recordings' phases differ.
    fn with_phases(&self, spectrum: &Spectrum, of_tool: impl Fn(f64) -> bool) -> Vec<Line> {
        let peaks = peaks(spectrum, of_own_phases);
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
        let left = left(&[0.4, 2.4, -1.6]);
        let lines = left.with_phases(&left.spectrum(), |f| f >= 11.0);
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
        let alike = left(&[0.4, 0.4, 0.4]);
        let spectrum = alike.spectrum();
        assert_eq!(alike.with_phases(&spectrum, |f| f >= 11.0), []);
        let peaks = peaks(&spectrum, coherent);
        assert!((peaks[0] - 7.3).abs() < 0.03, "{peaks:?}");
    }

    #[test]
    fn a_phase_that_is_turned_on_is_that_of_its_frequency() {
        let mut left = left(&[0.4, 2.4]);
        (left.mean, left.turns) = (0.3, [90.0, 110.0]);
        let spectrum = left.spectrum();
        assert_eq!(spectrum.len(), 3980 + 400);
        for (frequency, sums) in &spectrum {
            for (found, expected) in sums.iter().zip(left.sums(*frequency)) {
                for part in 0..2 {
                    let error = (found[part] - expected[part]).abs();
                    assert!(error < 1e-9, "{frequency} Hz: {error:e}");
                }
            }
        }
    }
}
