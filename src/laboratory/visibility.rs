//! Visibility of an effect beside all that its owner tolerates.
//!
//! ```text
//! D^2 = min over q of  sum w_i^2 (d_i - sum J_ij q_j)^2 + sum q_j^2,      w_i = 1 / sqrt(1 + (T s_i)^2)
//! ```
//!
//! d what the effect moves a reading by, in standard deviations of its noise; J what a tolerated number moves it by, in that number's standard deviation
//! q (of a value anywhere within its tolerance); s how fast the reading changes, in standard deviations a second; T 1 ms: that an impact comes a moment
//! earlier is no more than that. D^2 is what the effect adds to twice the log-likelihood, so that a test for one number asks for some 20.

use nalgebra::{SMatrix, SVector};

use super::concealed::Concealed;
use super::draw::{TOLERANCES, toleranced};
use super::programme::Programme;
use super::rig::LaboratoryRig;
use super::trajectory::{LaboratoryError, LaboratoryTrajectory, run};

/// Error in time that is forgiven [s].
const FORGIVEN: f64 = 1e-3;
/// Step of a tolerated number, in its standard deviations [1].
const STEP: f64 = 0.3;
/// Number of tolerated numbers.
const TOLERATED: usize = TOLERANCES.len();

/// A device without the effect, seen through its sensors and its owner's tolerances.
pub(super) struct Eye {
    /// Its readings, recording by recording.
    trajectories: Vec<LaboratoryTrajectory>,
    /// Weight over noise of each reading.
    weights: Vec<f64>,
    /// Changes by each tolerated number, weighted.
    columns: Vec<Vec<f64>>,
    /// J'J + 1, inverted.
    inverse: SMatrix<f64, TOLERATED, TOLERATED>,
}

impl Eye {
    /// Of a device, with what is concealed in it beside, whose tolerances are relative to its nominal values.
    pub fn new(
        bare: &LaboratoryRig,
        beside: &Concealed,
        nominal: &LaboratoryRig,
        tolerances: &[f64; TOLERATED],
        programmes: &[Programme],
    ) -> Result<Self, LaboratoryError> {
        let all = |rig: &LaboratoryRig| -> Result<Vec<LaboratoryTrajectory>, LaboratoryError> {
            programmes.iter().map(|p| run(rig, beside, p)).collect()
        };
        let trajectories = all(bare)?;
        let mut weights = Vec::new();
        for (trajectory, programme) in trajectories.iter().zip(programmes) {
            for (values, noise) in trajectory.readings.iter().zip(bare.noise) {
                weights.extend(weight(&programme.times, values, noise));
            }
        }
        let mut eye = Self {
            trajectories,
            weights,
            columns: Vec::new(),
            inverse: SMatrix::identity(),
        };
        let mut nominal = nominal.clone();
        let nominal = toleranced(&mut nominal).map(|value| *value);
        for (index, tolerance) in tolerances.iter().enumerate() {
            let deviation = tolerance * nominal[index] / 3f64.sqrt();
            let mut moved = bare.clone();
            *toleranced(&mut moved)[index] += STEP * deviation;
            let mut column = eye.differences(&all(&moved)?);
            for value in &mut column {
                *value /= STEP;
            }
            eye.columns.push(column);
        }
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let normal = SMatrix::<f64, TOLERATED, TOLERATED>::from_fn(|i, j| {
            dot(&eye.columns[i], &eye.columns[j]) + if i == j { 1.0 } else { 0.0 }
        });
        eye.inverse = normal.try_inverse().unwrap_or_else(SMatrix::identity);
        Ok(eye)
    }

    /// The readings without the effect.
    pub fn trajectories(&self) -> &[LaboratoryTrajectory] {
        &self.trajectories
    }

    /// D of what these readings differ by.
    pub fn visibility(&self, trajectories: &[LaboratoryTrajectory]) -> f64 {
        let off = self.differences(trajectories);
        let all: f64 = off.iter().map(|value| value * value).sum();
        let along = SVector::<f64, TOLERATED>::from_fn(|j, _| {
            self.columns[j].iter().zip(&off).map(|(a, b)| a * b).sum()
        });
        (all - along.dot(&(self.inverse * along))).max(0.0).sqrt()
    }

    fn differences(&self, trajectories: &[LaboratoryTrajectory]) -> Vec<f64> {
        let readings = |trajectories: &[LaboratoryTrajectory]| -> Vec<f64> {
            let all = trajectories
                .iter()
                .flat_map(|trajectory| &trajectory.readings);
            all.flatten().copied().collect()
        };
        let pairs = readings(trajectories)
            .into_iter()
            .zip(readings(&self.trajectories));
        let weighted = pairs.zip(&self.weights);
        weighted
            .map(|((with, without), weight)| weight * (with - without))
            .collect()
    }
}

fn weight(times: &[f64], values: &[f64], noise: f64) -> Vec<f64> {
    let last = times.len() - 1;
    (0..=last)
        .map(|i| {
            let (from, to) = (i.saturating_sub(1), (i + 1).min(last));
            let fastest = (from..to)
                .map(|j| ((values[j + 1] - values[j]) / (times[j + 1] - times[j])).abs())
                .fold(0.0, f64::max);
            1.0 / (noise * (FORGIVEN * fastest / noise).hypot(1.0))
        })
        .collect()
}
