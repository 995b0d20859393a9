//! Inputs of a rig in a recording: set pressure, valve, surface.

use super::arm_trajectory::ArmTrajectory;
use super::initial_state::InitialState;
use super::measured_motion::MeasuredMotion;
use std::cmp::Ordering;
use std::sync::Arc;

/// Inputs, one of each per sample time.
#[derive(Debug, Clone, PartialEq)]
pub struct PlantInputs {
    /// Sample times [s], increasing.
    pub time: Vec<f64>,
    /// Set pressure [Pa gauge], held from its sample to the next.
    pub set_pressure: Vec<f64>,
    /// Whether the 5/2 valve extends. Held likewise.
    pub extends: Vec<bool>,
    /// Where the surface stands along the stroke [m], a smooth motion; NaN where there is no workpiece.
    pub surface: Vec<f64>,
    /// The arm that carries the device, if it is one of a cell: it says where the surface stands, and how the device is carried.
    pub cell: Option<Arc<ArmTrajectory>>,
    /// The motion of the piston, where a rig or a drive moves it; the set pressure is then that in chamber 1, as it was measured.
    pub motion: Option<Arc<MeasuredMotion>>,
    /// State in which it starts.
    pub initial: InitialState,
    /// Its place among the recordings that are fitted together, from 0: each has its own phase of what is periodic.
    pub place: usize,
}

/// Inputs that do not fit together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InputError {
    /// Another number of values than of times.
    #[error("{quantity} has {found} values, expected {expected}, one per time")]
    Length {
        /// Which input.
        quantity: &'static str,
        /// Their number.
        found: usize,
        /// Number of times.
        expected: usize,
    },
    /// Less than two samples.
    #[error("{found} samples, expected at least 2")]
    TooShort {
        /// Their number.
        found: usize,
    },
    /// Time stands still or goes back.
    #[error("time {value} s of sample {index} is not after {before} s")]
    Time {
        /// Which sample.
        index: usize,
        /// Its time [s].
        value: f64,
        /// The time before [s].
        before: f64,
    },
}

impl PlantInputs {
    /// Checks that the inputs fit together.
    ///
    /// # Errors
    /// Lengths differ, less than two samples, time not increasing.
    pub fn check(&self) -> Result<(), InputError> {
        let expected = self.time.len();
        let lengths = [
            ("set pressure", self.set_pressure.len()),
            ("valve", self.extends.len()),
            ("surface", self.surface.len()),
        ];
        if let Some(&(quantity, found)) = lengths.iter().find(|(_, found)| *found != expected) {
            return Err(InputError::Length {
                quantity,
                found,
                expected,
            });
        }
        if expected < 2 {
            return Err(InputError::TooShort { found: expected });
        }
        match (1..expected)
            .find(|&i| self.time[i].partial_cmp(&self.time[i - 1]) != Some(Ordering::Greater))
        {
            None => Ok(()),
            Some(index) => Err(InputError::Time {
                index,
                value: self.time[index],
                before: self.time[index - 1],
            }),
        }
    }

    /// Slope at a sample of what is known at each [1/s]: of the parabola through it and its neighbours, which may be at unlike distances, as at a gap.
    pub(super) fn slope(&self, values: &[f64], index: usize) -> f64 {
        let before = index.saturating_sub(1);
        let after = (index + 1).min(self.time.len() - 1);
        let usable = |i: usize| {
            if values[i].is_finite() { i } else { index }
        };
        let (before, after) = (usable(before), usable(after));
        let chord = |from: usize, to: usize| {
            (values[to] - values[from]) / (self.time[to] - self.time[from])
        };
        match (before == index, after == index) {
            (true, true) => 0.0,
            (true, false) | (false, true) => chord(before, after),
            (false, false) => {
                let [back, on] = [(before, index), (index, after)]
                    .map(|(from, to)| self.time[to] - self.time[from]);
                (on * chord(before, index) + back * chord(index, after)) / (back + on)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{InitialState, PlantInputs};

    #[test]
    fn a_parabola_has_its_slope_at_every_distance_of_samples() {
        let time = vec![0.0, 0.004, 0.068, 0.071, 0.076];
        let values: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t + 5.0 * t * t).collect();
        let inputs = PlantInputs {
            set_pressure: vec![0.0; 5],
            extends: vec![true; 5],
            surface: values.clone(),
            time: time.clone(),
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
        };
        for (i, t) in time.iter().enumerate().take(4).skip(1) {
            let slope = inputs.slope(&values, i);
            assert!((slope - (10.0 * t - 2.0)).abs() < 1e-12, "{slope}");
        }
        let mut open = values;
        open[2] = f64::NAN;
        let chord = (open[1] - open[0]) / 0.004;
        assert!((inputs.slope(&open, 1) - chord).abs() < 1e-12);
    }
}
