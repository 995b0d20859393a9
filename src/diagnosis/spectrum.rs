//! Periodic parts of what is left in the force while the tool touches.

use super::evidence::{Evidence, Prediction};
use std::f64::consts::TAU;

/// Frequencies [Hz] of the strongest periodic parts, strongest first, at most four, by least squares of a sine over all recordings with the same phase.
pub fn strongest(evidence: &Evidence, prediction: &Prediction) -> Vec<f64> {
    let mut times = Vec::new();
    let mut left = Vec::new();
    let mut at = 0;
    for (measured, course) in evidence.recordings.iter().zip(&prediction.courses) {
        let n = measured.inputs.time.len();
        let force = &prediction.residuals[at + 2 * n..at + 3 * n];
        at += 4 * n;
        for (i, &force) in force.iter().enumerate() {
            if course.truth.contact_force[i] > 0.0
                && force.is_finite()
                && measured.inputs.surface[i].is_finite()
            {
                times.push(measured.inputs.time[i]);
                left.push(force.clamp(-20.0, 20.0));
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
    use rayon::prelude::*;
    let powers: Vec<f64> = frequencies.par_iter().map(|f| power(*f)).collect();
    let mut peaks: Vec<(f64, f64)> = (1..powers.len() - 1)
        .filter(|&i| powers[i] > powers[i - 1] && powers[i] >= powers[i + 1])
        .map(|i| (powers[i], frequencies[i]))
        .collect();
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut low: Vec<f64> = peaks
        .iter()
        .filter(|p| p.1 < 11.0)
        .take(2)
        .map(|p| p.1)
        .collect();
    low.extend(peaks.iter().filter(|p| p.1 >= 11.0).take(2).map(|p| p.1));
    low
}
