//! Cleaning of a recording before it is used, and its quality: outliers, lost ones, gaps, jitter, noise.
//!
//! A reading is wild only if it stands alone and what it says of the rig is denied by another sensor (`wild`); impacts are seen by more than one.

use super::subject::{Denial, Subject};
use crate::quantity::counted;
use crate::stats::median_step;
use departure::noise_of;
pub(in crate::diagnosis) use departure::{departures, lagrange};

mod departure;
mod outlier;
#[cfg(test)]
mod tests;

/// Share of the usual step from which a longer one is a gap [1].
const GAP: f64 = 1.5;

/// Quality of a recording, by itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cleaning {
    /// Times at which a reading was wild and was set aside, by channel [s].
    pub outliers: Vec<Vec<f64>>,
    /// Readings that were never there, by channel, in channels that have others.
    pub lost: Vec<usize>,
    /// Gaps: time of the last sample before and the first after each [s].
    pub gaps: Vec<[f64; 2]>,
    /// The usual step from sample to sample [s].
    pub step: f64,
    /// Largest departure of a step from the usual one, gaps apart [s].
    pub jitter: f64,
    /// Standard deviation of each channel's noise, from the recording alone; none where there are too few readings.
    pub noise: Vec<Option<f64>>,
    /// Distance of neighbouring readings of each channel's converter; none where it is finer than the readings tell.
    pub resolution: Vec<Option<f64>>,
}

/// Sets outliers aside (they become NaN); `noise` is what the sensors' sheets say.
pub fn clean<S: Subject>(
    time: &[f64],
    readings: &mut S::Readings,
    noise: &S::Noise,
    model: &S::Model,
) -> Cleaning {
    let readings = readings.as_mut();
    let mut cleaning = Cleaning {
        step: median_step(time),
        outliers: vec![Vec::new(); readings.len()],
        lost: vec![0; readings.len()],
        ..Cleaning::default()
    };
    for pair in time.windows(2) {
        let step = pair[1] - pair[0];
        if step > GAP * cleaning.step {
            cleaning.gaps.push([pair[0], pair[1]]);
        } else {
            cleaning.jitter = cleaning.jitter.max((step - cleaning.step).abs());
        }
    }
    for (channel, values) in readings.iter_mut().enumerate() {
        let given = values.iter().filter(|value| !value.is_nan()).count();
        if given > 0 {
            cleaning.lost[channel] = values.len() - given;
        }
        let [low, high] = S::plausible(S::CHANNELS[channel]);
        for (value, time) in values.iter_mut().zip(time) {
            if !value.is_nan() && !(low..=high).contains(value) {
                *value = f64::NAN;
                cleaning.outliers[channel].push(*time);
            }
        }
    }
    let denials = S::CHANNELS.iter().map(|channel| S::denial(*channel, model));
    let denials: Vec<Denial> = denials.collect();
    set_aside(time, readings, noise.as_ref(), &denials, &mut cleaning);
    for (channel, values) in readings.iter().enumerate() {
        let noise = noise_of(&departures(time, values, cleaning.step));
        cleaning.noise.push(noise);
        cleaning.resolution.push(resolution(values));
        cleaning.outliers[channel].sort_by(f64::total_cmp);
    }
    cleaning
}

/// Looks for outliers until there are no more: one may hide behind another.
fn set_aside(
    time: &[f64],
    readings: &mut [Vec<f64>],
    noise: &[f64],
    denials: &[Denial],
    cleaning: &mut Cleaning,
) {
    const MOST_PASSES: usize = 4;
    for _ in 0..MOST_PASSES {
        let found = outlier::outlier(time, readings, noise, denials, cleaning.step);
        if found.iter().all(Vec::is_empty) {
            return;
        }
        for (channel, indices) in found.into_iter().enumerate() {
            for index in indices {
                readings[channel][index] = f64::NAN;
                cleaning.outliers[channel].push(time[index]);
            }
        }
    }
}

/// Distance of neighbouring readings of a converter; none where most readings differ from all others.
fn resolution(values: &[f64]) -> Option<f64> {
    let mut readings: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let count = readings.len();
    readings.sort_by(f64::total_cmp);
    readings.dedup();
    if 2 * readings.len() > count {
        return None;
    }
    let gaps = readings.windows(2).map(|pair| pair[1] - pair[0]);
    gaps.min_by(f64::total_cmp)
}

impl Cleaning {
    /// Notes on it for an engineer, a sentence each; nothing of a recording that is as it should be.
    pub fn account<S: Subject>(&self, sheet: &S::Noise) -> Vec<String> {
        /// Jitter below this share of a step is rounding of the stamps [1].
        const ROUNDING: f64 = 0.1;
        /// Noise that differs from the sheet's by this factor is worth a word [1].
        const OTHER_NOISE: f64 = 1.5;
        let sheet = sheet.as_ref();
        let columns = || S::CHANNELS.iter().map(|channel| S::column(*channel));
        let mut sentences = Vec::new();
        for (channel, column) in columns().enumerate() {
            let outliers = &self.outliers[channel];
            if !outliers.is_empty() {
                let times: Vec<String> = outliers.iter().map(|time| format!("{time:.3}")).collect();
                sentences.push(format!(
                    "{} of {column} set aside, at {} s",
                    counted(outliers.len(), "outlier"),
                    times.join(", ")
                ));
            }
            if self.lost[channel] > 0 {
                let lost = counted(self.lost[channel], "value");
                sentences.push(format!("{lost} of {column} lost"));
            }
            if let Some(noise) = self.noise[channel].filter(|noise| *noise > 0.0) {
                let ratio = noise / sheet[channel];
                if !(1.0 / OTHER_NOISE..OTHER_NOISE).contains(&ratio) {
                    sentences.push(format!(
                        "noise of {column} is {noise:.3e}, {ratio:.2} times what [sensors] says; `{column} = {noise:.1e}` there would do"
                    ));
                }
            }
        }
        for (channel, column) in columns().enumerate() {
            if let Some(step) = self.resolution[channel].filter(|step| *step > sheet[channel]) {
                let ratio = step / sheet[channel];
                sentences.push(format!(
                    "readings of {column} are {step:.3e} apart, {ratio:.1} times its noise: a coarse converter"
                ));
            }
        }
        if !self.gaps.is_empty() {
            let longest = self
                .gaps
                .iter()
                .map(|gap| gap[1] - gap[0])
                .fold(0.0, f64::max);
            let gaps = counted(self.gaps.len(), "gap");
            sentences.push(format!("{gaps}, the longest of {longest:.4} s"));
        }
        if self.jitter > ROUNDING * self.step {
            sentences.push(format!(
                "time stamps jitter by up to {:.1} % of a step",
                100.0 * self.jitter / self.step
            ));
        }
        sentences
    }
}
