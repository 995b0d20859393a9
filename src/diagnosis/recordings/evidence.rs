//! Recordings as a fit sees them: inputs, readings, their noise, and which samples count.

use crate::diagnosis::effort::Effort;
use crate::plant::{
    CHANNELS, Channel, Nudging, PlantInputs, PlantParameters, PlantTrajectory, Trajectory,
    readings, true_trajectory,
};
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// One recording with what was measured in it.
#[derive(Debug, Clone)]
pub struct Measured {
    /// File name.
    pub name: String,
    /// Inputs of the rig.
    pub inputs: PlantInputs,
    /// Readings in the order of [`CHANNELS`]; NaN where there is none or none that counts.
    pub readings: [Vec<f64>; 4],
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
pub struct Evidence {
    /// The recordings.
    pub recordings: Vec<Measured>,
    /// Standard deviation of each channel's noise, in the order of [`CHANNELS`].
    pub noise: [f64; 4],
    /// Time for which what a law leaves is taken to be alike at most [s].
    pub block: f64,
    /// Weight of a sample, where neighbours tell the same [1].
    pub worth: f64,
    /// Effort of the search that looks at it.
    pub effort: Effort,
    /// Motions measured, one per recording.
    nudgings: Vec<Nudging>,
    /// Shares found before.
    shares: Mutex<Vec<Shares>>,
}

impl Evidence {
    /// Recordings with the standard deviation of each channel's noise, in the order of [`CHANNELS`].
    /// The motion in a time in which a recording's piston is held is used, and no reading of that time is compared with.
    pub fn new(mut recordings: Vec<Measured>, noise: [f64; 4]) -> Self {
        let nudging = |measured: &Measured| {
            let force = &measured.readings[2];
            let touching = |i: usize| force[i].abs() > 6.0 * noise[2];
            Nudging::new(
                &measured.inputs.time,
                &measured.readings[1],
                &measured.readings[3],
                noise[1],
                noise[3],
                touching,
            )
        };
        let nudgings = recordings.iter().map(nudging).collect();
        for (place, measured) in recordings.iter_mut().enumerate() {
            measured.inputs.place = place;
            for readings in &mut measured.readings {
                readings[..measured.inputs.initial.samples()].fill(f64::NAN);
            }
        }
        Self {
            nudgings,
            recordings,
            noise,
            block: BLOCK,
            worth: 1.0,
            effort: Effort::default(),
            shares: Mutex::default(),
        }
    }
}

impl Evidence {
    /// The same of some of the recordings, by their index.
    #[must_use]
    pub fn of_those(&self, which: impl Fn(usize) -> bool) -> Self {
        let chosen = || (0..self.recordings.len()).filter(|i| which(*i));
        Self {
            recordings: chosen().map(|i| self.recordings[i].clone()).collect(),
            nudgings: chosen().map(|i| self.nudgings[i].clone()).collect(),
            shares: Mutex::default(),
            effort: self.effort.clone(),
            noise: self.noise,
            block: self.block,
            worth: self.worth,
        }
    }

    /// The same with the readings of one channel alone.
    #[must_use]
    pub fn of_channel(&self, channel: Channel) -> Self {
        let mut own = self.of_those(|_| true);
        for measured in &mut own.recordings {
            for other in CHANNELS.into_iter().filter(|other| *other != channel) {
                measured.readings[other as usize].fill(f64::NAN);
            }
        }
        own
    }
}

/// A description with what it gives.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// The description.
    pub plant: PlantParameters,
    /// Whether the piston was held to its measured motion.
    pub guided: bool,
    /// One trajectory per recording.
    pub trajectories: Vec<PlantTrajectory>,
    /// Measured less simulated, in standard deviations of the noise; recording by recording, channel by channel; NaN where nothing counts,
    /// infinite where the simulation is no number.
    pub residuals: Vec<f64>,
}

impl Evidence {
    /// Prediction of a description; trajectories are taken from `known` where only sensors differ.
    pub fn predict(
        &self,
        plant: &PlantParameters,
        guided: bool,
        known: Option<&Prediction>,
    ) -> Prediction {
        self.effort.count();
        let reusable = |measured: &Measured| {
            known.filter(|known| {
                if known.guided != guided
                    || (guided && plant.sensors.stroke_gain != known.plant.sensors.stroke_gain)
                {
                    return false;
                }
                plant.moves_as(&known.plant, measured.inputs.place)
                    || (measured.free && plant.moves_freely_as(&known.plant))
            })
        };
        let trajectory = |(index, measured): (usize, &Measured)| {
            let truth: Trajectory = match reusable(measured) {
                Some(known) => known.trajectories[index].truth.clone(),
                None => true_trajectory(
                    plant,
                    &measured.inputs,
                    guided.then(|| &self.nudgings[index]),
                ),
            };
            let readings = readings(plant, &measured.inputs, &truth);
            PlantTrajectory { truth, readings }
        };
        let trajectories: Vec<PlantTrajectory> =
            self.recordings.iter().enumerate().map(trajectory).collect();
        Prediction {
            plant: plant.clone(),
            guided,
            residuals: self.residuals(&trajectories),
            trajectories,
        }
    }

    fn residuals(&self, trajectories: &[PlantTrajectory]) -> Vec<f64> {
        let mut all = Vec::new();
        for (measured, trajectory) in self.recordings.iter().zip(trajectories) {
            for channel in 0..CHANNELS.len() {
                let noise = self.noise[channel];
                let pairs = measured.readings[channel]
                    .iter()
                    .zip(&trajectory.readings[channel]);
                // A model that is no longer finite is as far off as can be: as a value that does not count it would be the best of all.
                let residual = |(measured, simulated): (&f64, &f64)| match simulated.is_finite() {
                    false if measured.is_finite() => f64::INFINITY,
                    _ => (measured - simulated) / noise,
                };
                all.extend(pairs.map(residual));
            }
        }
        all
    }

    /// Residuals of many descriptions, in order.
    pub fn residuals_of(&self, plants: &[PlantParameters], known: &Prediction) -> Vec<Vec<f64>> {
        plants
            .par_iter()
            .map(|plant| self.predict(plant, known.guided, Some(known)).residuals)
            .collect()
    }

    /// Samples that count, as many as tell something of their own.
    pub fn count(&self) -> usize {
        let readings = self.recordings.iter().flat_map(|m| &m.readings);
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
            for (channel, (readings, noise)) in measured.readings.iter().zip(self.noise).enumerate()
            {
                let count = readings.len();
                // The acceleration went into the motion that the piston is held to.
                if guided && channel == 3 {
                    all.extend(std::iter::repeat_n(0.0, count));
                    continue;
                }
                if forgiven == 0.0 {
                    all.extend(std::iter::repeat_n(1.0, count));
                    continue;
                }
                let time = &measured.inputs.time;
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

/// Residuals of each recording and channel.
pub fn by_channel<'a>(
    evidence: &'a Evidence,
    residuals: &'a [f64],
) -> impl Iterator<Item = (usize, Channel, &'a [f64])> {
    let mut start = 0;
    let recordings = evidence.recordings.iter().enumerate();
    recordings.flat_map(move |(recording, measured)| {
        let count = measured.inputs.time.len();
        let first = start;
        start += CHANNELS.len() * count;
        CHANNELS.into_iter().enumerate().map(move |(at, channel)| {
            let from = first + at * count;
            (recording, channel, &residuals[from..from + count])
        })
    })
}
