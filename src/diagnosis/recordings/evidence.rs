//! Recordings as a fit sees them: inputs, readings, their noise, and which samples count.

use super::device::Device;
use super::subject::Subject;
use crate::diagnosis::effort::Effort;
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// One recording with what was measured in it.
#[derive(Debug, Clone)]
pub struct Measured<S: Subject = Device> {
    /// File name.
    pub name: String,
    /// Inputs of the subject.
    pub inputs: S::Inputs,
    /// Readings in the order of the channels; NaN where there is none or none that counts.
    pub readings: S::Readings,
    /// Whether there is no workpiece.
    pub free: bool,
}

/// Weight of each residual, given an error in time that is forgiven [s] and a piston that is held or not.
#[derive(Debug)]
struct Shares {
    of: (f64, bool),
    values: Arc<Vec<f64>>,
}

/// Time below which the residuals of a law are alike [s]: longer than a chamber takes to follow.
const BLOCK: f64 = 0.25;

/// Recordings and the noise of their channels.
#[derive(Debug)]
pub struct Evidence<S: Subject = Device> {
    /// The recordings.
    pub recordings: Vec<Measured<S>>,
    /// Standard deviation of each channel's noise, in the order of the channels.
    pub noise: S::Noise,
    /// Time for which what a law leaves is taken to be alike at most [s].
    pub block: f64,
    /// Weight of a sample, where neighbours tell the same [1].
    pub worth: f64,
    /// Effort of the search that looks at it.
    pub effort: Effort,
    /// What holds a simulation to each recording's measured course.
    guides: Vec<S::Guide>,
    /// Shares found before.
    shares: Mutex<Vec<Shares>>,
}

impl<S: Subject> Evidence<S> {
    /// Recordings with the standard deviation of each channel's noise, in the order of the channels.
    /// What the model takes of the start of a recording as it was measured is used, and no reading of that time is compared with.
    pub fn new(mut recordings: Vec<Measured<S>>, noise: S::Noise) -> Self {
        let guide = |m: &Measured<S>| S::guide(&m.inputs, &m.readings, &noise);
        let guides = recordings.iter().map(guide).collect();
        for (place, measured) in recordings.iter_mut().enumerate() {
            let given = S::placed(&mut measured.inputs, place);
            for readings in measured.readings.as_mut() {
                readings[..given].fill(f64::NAN);
            }
        }
        Self {
            guides,
            recordings,
            noise,
            block: BLOCK,
            worth: 1.0,
            effort: Effort::default(),
            shares: Mutex::default(),
        }
    }

    /// The same of some of the recordings, by their index.
    #[must_use]
    pub fn of_those(&self, which: impl Fn(usize) -> bool) -> Self {
        let chosen = || (0..self.recordings.len()).filter(|i| which(*i));
        Self {
            recordings: chosen().map(|i| self.recordings[i].clone()).collect(),
            guides: chosen().map(|i| self.guides[i].clone()).collect(),
            shares: Mutex::default(),
            effort: self.effort.clone(),
            noise: self.noise,
            block: self.block,
            worth: self.worth,
        }
    }

    /// The same with the readings of one channel alone.
    #[must_use]
    pub fn of_channel(&self, channel: S::Channel) -> Self {
        let mut own = self.of_those(|_| true);
        for measured in &mut own.recordings {
            let channels = S::CHANNELS.iter().zip(measured.readings.as_mut());
            for (_, readings) in channels.filter(|(other, _)| **other != channel) {
                readings.fill(f64::NAN);
            }
        }
        own
    }
}

/// A description with what it gives.
#[derive(Debug, Clone)]
pub struct Prediction<S: Subject = Device> {
    /// The description.
    pub plant: S::Model,
    /// Whether it was held to the measured course.
    pub guided: bool,
    /// One simulation per recording.
    pub trajectories: Vec<S::Simulated>,
    /// Measured less simulated, in standard deviations of the noise; recording by recording, channel by channel; NaN where nothing counts,
    /// infinite where the simulation is no number.
    pub residuals: Vec<f64>,
}

impl<S: Subject> Evidence<S> {
    /// Prediction of a description; `known` may spare simulations.
    pub fn predict(
        &self,
        plant: &S::Model,
        guided: bool,
        known: Option<&Prediction<S>>,
    ) -> Prediction<S> {
        self.effort.count();
        let known = known.filter(|known| known.guided == guided);
        let simulated = |(index, measured): (usize, &Measured<S>)| {
            let guide = guided.then(|| &self.guides[index]);
            let known = known.map(|known| (&known.plant, &known.trajectories[index]));
            S::simulate(plant, &measured.inputs, measured.free, guide, known)
        };
        let trajectories: Vec<S::Simulated> = (self.recordings.par_iter().enumerate())
            .map(simulated)
            .collect();
        Prediction {
            plant: plant.clone(),
            guided,
            residuals: self.residuals(&trajectories),
            trajectories,
        }
    }

    fn residuals(&self, trajectories: &[S::Simulated]) -> Vec<f64> {
        let mut all = Vec::new();
        for (measured, trajectory) in self.recordings.iter().zip(trajectories) {
            let channels = measured.readings.as_ref().iter();
            let channels = channels
                .zip(S::readings(trajectory))
                .zip(self.noise.as_ref());
            for ((measured, simulated), noise) in channels {
                // A model that is no longer finite is as far off as can be: as a value that does not count it would be the best of all.
                let residual = |(measured, simulated): (&f64, &f64)| match simulated.is_finite() {
                    false if measured.is_finite() => f64::INFINITY,
                    _ => (measured - simulated) / noise,
                };
                all.extend(measured.iter().zip(simulated).map(residual));
            }
        }
        all
    }

    /// Residuals of many descriptions, in order.
    pub fn residuals_of(&self, plants: &[S::Model], known: &Prediction<S>) -> Vec<Vec<f64>> {
        plants
            .par_iter()
            .map(|plant| self.predict(plant, known.guided, Some(known)).residuals)
            .collect()
    }

    /// Samples that count, as many as tell something of their own.
    pub fn count(&self) -> usize {
        let readings = self.recordings.iter().flat_map(|m| m.readings.as_ref());
        let finite = readings.flatten().filter(|value| value.is_finite()).count();
        (finite as f64 * self.worth) as usize
    }

    /// Weight of each residual when errors in time [s] are forgiven: noise over noise and slope times that error together.
    pub fn shares(&self, forgiven: f64, guided: bool) -> Arc<Vec<f64>> {
        let of = (forgiven, guided);
        let mut known = self
            .shares
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(shares) = known.iter().find(|shares| shares.of == of) {
            return shares.values.clone();
        }
        let values = Arc::new(self.compute_shares(forgiven, guided));
        known.push(Shares {
            of,
            values: values.clone(),
        });
        values
    }

    fn compute_shares(&self, forgiven: f64, guided: bool) -> Vec<f64> {
        let mut all = Vec::new();
        for measured in &self.recordings {
            let channels = measured.readings.as_ref().iter().zip(self.noise.as_ref());
            for ((readings, noise), channel) in channels.zip(S::CHANNELS) {
                let count = readings.len();
                // What went into the course that it is held to is met by that alone.
                if guided && S::guides(*channel) {
                    all.extend(std::iter::repeat_n(0.0, count));
                    continue;
                }
                if forgiven == 0.0 {
                    all.extend(std::iter::repeat_n(1.0, count));
                    continue;
                }
                let time = S::time(&measured.inputs);
                for i in 0..count {
                    let from = time.partition_point(|t| *t < time[i] - forgiven);
                    let to = time.partition_point(|t| *t <= time[i] + forgiven);
                    let near = readings[from.min(i.saturating_sub(1))..to.max((i + 2).min(count))]
                        .iter()
                        .filter(|v| v.is_finite());
                    let (low, high) = near.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                        (l.min(*v), h.max(*v))
                    });
                    // The range of noise alone is not a slope.
                    let swing = (0.5 * (high - low) / noise - 2.0).max(0.0);
                    all.push(1.0 / (1.0 + swing * swing).sqrt());
                }
            }
        }
        all
    }
}

/// Place of each recording's first residual; its channels stand one behind another.
pub fn starts<S: Subject>(evidence: &Evidence<S>) -> impl Iterator<Item = usize> {
    let counts = evidence.recordings.iter();
    let counts = counts.map(|measured| S::CHANNELS.len() * S::time(&measured.inputs).len());
    counts.scan(0, |next, count| {
        let start = *next;
        *next += count;
        Some(start)
    })
}

/// Root mean square of residuals in each channel over all recordings, those apart that are not known.
pub fn rms_by_channel<S: Subject>(evidence: &Evidence<S>, residuals: &[f64]) -> Vec<f64> {
    let of = |channel: &S::Channel| {
        let own = by_channel(evidence, residuals).filter(|(_, other, _)| other == channel);
        let all = own.flat_map(|(_, _, values)| values);
        let known = all.filter(|value| value.is_finite());
        let (squares, count) = known.fold((0.0, 0.0), |(sum, n), v| (sum + v * v, n + 1.0));
        (squares / f64::max(count, 1.0)).sqrt()
    };
    S::CHANNELS.iter().map(of).collect()
}

/// Residuals of each recording and channel.
pub fn by_channel<'a, S: Subject>(
    evidence: &'a Evidence<S>,
    residuals: &'a [f64],
) -> impl Iterator<Item = (usize, S::Channel, &'a [f64])> {
    let recordings = evidence.recordings.iter().enumerate().zip(starts(evidence));
    recordings.flat_map(move |((recording, measured), first)| {
        let count = S::time(&measured.inputs).len();
        S::CHANNELS.iter().enumerate().map(move |(at, channel)| {
            let from = first + at * count;
            (recording, *channel, &residuals[from..from + count])
        })
    })
}
