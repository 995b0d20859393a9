//! Periodic parts of what is left in the force while the tool touches.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::evidence::{Evidence, Prediction};

/// Frequencies [Hz] of the strongest periodic parts of the force while touching, the strongest first, at most two slower and two faster than a tool
/// turns, by least squares of a sine over all recordings with the same phase.
pub fn strongest(evidence: &Evidence, prediction: &Prediction) -> Vec<f64> {
    let peaks = strongest_in(evidence, prediction, 2);
    let (low, high): (Vec<f64>, Vec<f64>) = peaks.iter().partition(|f| **f < 11.0);
    low.into_iter()
        .take(2)
        .chain(high.into_iter().take(2))
        .collect()
}

/// Frequencies [Hz] of the periodic parts of what is left in a channel, strongest first; of the force while touching alone.
pub fn strongest_in(evidence: &Evidence, prediction: &Prediction, channel: usize) -> Vec<f64> {
    let mut times = Vec::new();
    let mut left = Vec::new();
    let mut at = 0;
    for (measured, trajectory) in evidence.recordings.iter().zip(&prediction.trajectories) {
        let n = measured.inputs.time.len();
        let left_over = &prediction.residuals[at + channel * n..at + (channel + 1) * n];
        at += 4 * n;
        for (i, &value) in left_over.iter().enumerate() {
            let touching =
                trajectory.truth.contact_force[i] > 0.0 && measured.inputs.surface[i].is_finite();
            if value.is_finite() && (touching || channel != 2) {
                times.push(measured.inputs.time[i]);
                left.push(value.clamp(-20.0, 20.0));
            }
        }
    }
    if times.len() < 50 {
        return vec![];
    }
    let mean = left.iter().sum::<f64>() / left.len() as f64;
    let power = |f: f64| {
        let (mut c, mut s) = (0.0, 0.0);
        for (t, x) in times.iter().zip(&left) {
            let (sin, cos) = (TAU * f * t).sin_cos();
            c += (x - mean) * cos;
            s += (x - mean) * sin;
        }
        c * c + s * s
    };
    let spacing = 0.025;
    let frequencies: Vec<f64> = (20..4000).map(|i| f64::from(i) * spacing).collect();
    let powers: Vec<f64> = frequencies.par_iter().map(|f| power(*f)).collect();
    let mut peaks: Vec<(f64, f64)> = (1..powers.len() - 1)
        .filter(|&i| powers[i] > powers[i - 1] && powers[i] >= powers[i + 1])
        .map(|i| (powers[i], frequencies[i]))
        .collect();
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
    peaks.into_iter().map(|(_, frequency)| frequency).collect()
}
