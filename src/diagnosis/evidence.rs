//! Recordings as a fit sees them: inputs, readings, their noise, and which samples count.

use crate::plant::{CHANNELS, PlantCourse, PlantInputs, PlantParameters, Trajectory, readings, trajectory};
use rayon::prelude::*;

/// One recording with what was measured in it.
#[derive(Debug, Clone)]
pub struct Measured {
    /// File name.
    pub name: String,
    /// What drove the rig.
    pub inputs: PlantInputs,
    /// Readings in the order of [`CHANNELS`]; NaN where there is none or none that counts.
    pub readings: [Vec<f64>; 4],
}

/// Recordings and the noise of their channels.
#[derive(Debug, Clone)]
pub struct Evidence {
    /// The recordings.
    pub recordings: Vec<Measured>,
    /// Standard deviation of each channel's noise, in the order of [`CHANNELS`].
    pub noise: [f64; 4],
}

/// A description with what it gives.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// The description.
    pub plant: PlantParameters,
    /// One course per recording.
    pub courses: Vec<PlantCourse>,
    /// Measured less simulated, in standard deviations of the noise; recording by recording, channel by channel; NaN where nothing counts.
    pub residuals: Vec<f64>,
}

impl Evidence {
    /// What a description gives; trajectories are taken from `known` where only sensors differ.
    pub fn predict(&self, plant: &PlantParameters, known: Option<&Prediction>) -> Prediction {
        let reusable = known.filter(|known| plant.moves_as(&known.plant));
        let course = |(index, measured): (usize, &Measured)| {
            let truth: Trajectory = match reusable {
                Some(known) => known.courses[index].truth.clone(),
                None => trajectory(plant, &measured.inputs),
            };
            let readings = readings(&plant.sensors, &measured.inputs, &truth);
            PlantCourse { truth, readings }
        };
        let courses: Vec<PlantCourse> = self.recordings.iter().enumerate().map(course).collect();
        Prediction {
            plant: plant.clone(),
            residuals: self.residuals(&courses),
            courses,
        }
    }

    fn residuals(&self, courses: &[PlantCourse]) -> Vec<f64> {
        let mut all = Vec::new();
        for (measured, course) in self.recordings.iter().zip(courses) {
            for channel in 0..CHANNELS.len() {
                let noise = self.noise[channel];
                let pairs = measured.readings[channel]
                    .iter()
                    .zip(&course.readings[channel]);
                all.extend(pairs.map(|(measured, simulated)| (measured - simulated) / noise));
            }
        }
        all
    }

    /// Residuals of many descriptions, in order.
    pub fn residuals_of(&self, plants: &[PlantParameters], known: &Prediction) -> Vec<Vec<f64>> {
        plants
            .par_iter()
            .map(|plant| self.predict(plant, Some(known)).residuals)
            .collect()
    }

    /// Samples that count.
    pub fn count(&self) -> usize {
        let readings = self.recordings.iter().flat_map(|m| &m.readings);
        readings.flatten().filter(|value| value.is_finite()).count()
    }
}
