//! Recordings in which the tool touches something: the wrench is then more than the tool's own, and nobody knows it beforehand.
//!
//! ```text
//! force = z + A a        of each component, fitted to each recording alone
//! ```
//!
//! a acceleration of the flange less gravity, in its axes [m/s2]. Zero, mass, turned axes, gains and crosstalk are all in it; contact is not.

use nalgebra::{DMatrix, DVector};

use super::input::ArmInput;
use crate::recorded_arm::simulate::{Channel, RigidCourse};
use crate::stats::median;

/// What such a fit leaves, over the noise, from which there is contact [1], and how many times what it leaves of the other recordings.
const CONTACT: [f64; 2] = [5.0, 3.0];

/// Whether each recording is one with contact.
#[must_use]
pub fn touching(input: &ArmInput) -> Vec<bool> {
    let left: Vec<f64> = (0..input.recordings.len())
        .map(|r| left_of(input, r))
        .collect();
    let usual = median(left.iter().copied()).unwrap_or(0.0);
    (left.iter())
        .map(|left| *left > CONTACT[0] && *left > CONTACT[1] * usual)
        .collect()
}

/// Root mean square over the noise that the fit leaves of a recording's forces [1].
fn left_of(input: &ArmInput, recording: usize) -> f64 {
    let own = &input.recordings[recording];
    let forces = |c: &usize| matches!(input.channels[*c], Channel::Wrench(k) if k < 3);
    let channels: Vec<usize> = (0..input.channels.len()).filter(forces).collect();
    if channels.is_empty() || input.nominal.wrench.is_none() || own.motion.outside.is_some() {
        return 0.0;
    }
    let flange = RigidCourse::of(&input.nominal, &own.motion).flange;
    let mut worst: f64 = 0.0;
    for c in channels {
        let rows: Vec<usize> = (0..flange.len())
            .filter(|i| own.readings[c][*i].is_finite())
            .collect();
        if rows.len() < 10 {
            continue;
        }
        let a = DMatrix::from_fn(rows.len(), 4, |i, k| {
            let acceleration = flange[rows[i]].acceleration;
            [1.0, acceleration.x, acceleration.y, acceleration.z][k]
        });
        let b = DVector::from_iterator(rows.len(), rows.iter().map(|i| own.readings[c][*i]));
        let normal = a.transpose() * &a + DMatrix::identity(4, 4) * 1e-9;
        let Some(factor) = normal.cholesky() else {
            continue;
        };
        let residual = &b - &a * factor.solve(&(a.transpose() * &b));
        let rms = (residual.norm_squared() / rows.len() as f64).sqrt();
        worst = worst.max(rms / input.noise[c]);
    }
    worst
}
