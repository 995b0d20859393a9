//! Whether an explanation predicts a recording that it was not fitted to.
//!
//! ```text
//! u_r = u - (J' W J + P)^-1 (J' W r + p)      over all recordings but r, from the optimum u of all
//! ```
//!
//! J derivatives of the residuals by the coordinates, W weights of Huber's loss, P and p of the priors: one step of Gauss and Newton, which from the optimum
//! is all but the whole way. Then the recording r is simulated with u_r.

use super::evidence::Evidence;
use super::fit::{Fit, robust_sum, with_values};
use super::settings::HUBER;
use crate::plant::{CHANNELS, simulate};
use nalgebra::{DMatrix, DVector};

/// Longest step in a coordinate, as in the fit [1].
const LONGEST: f64 = 3.0;

/// Residuals of each recording by a fit to the others: measured less predicted in standard deviations, by recording and channel. None where there are no others.
pub fn left_out(evidence: &Evidence, fit: &Fit) -> Option<Vec<[Vec<f64>; CHANNELS.len()]>> {
    if evidence.recordings.len() < 2 || fit.columns.len() != fit.free.len() {
        return None;
    }
    let mut start = 0;
    let mut all = Vec::new();
    for measured in &evidence.recordings {
        let end = start + CHANNELS.len() * measured.inputs.time.len();
        let values = without(fit, start..end);
        let plant = with_values(&fit.prediction.plant, &fit.free, &values);
        let readings = simulate(&plant, &measured.inputs).readings;
        all.push(std::array::from_fn(|channel| {
            let pairs = measured.readings[channel].iter().zip(&readings[channel]);
            pairs
                .map(|(measured, predicted)| (measured - predicted) / evidence.noise[channel])
                .collect()
        }));
        start = end;
    }
    Some(all)
}

/// Robust sum of squares of what is left of recordings, each predicted by a fit to the others; nothing where there are no others.
pub fn cost(evidence: &Evidence, fit: &Fit) -> Option<f64> {
    Some(sum(&left_out(evidence, fit)?))
}

/// Robust sum of squares of what was left out in turn.
pub fn sum(left: &[[Vec<f64>; CHANNELS.len()]]) -> f64 {
    let channels = left.iter().flatten();
    channels.map(|residuals| robust_sum(residuals)).sum()
}

/// Values of the free quantities without some samples.
fn without(fit: &Fit, left: std::ops::Range<usize>) -> Vec<f64> {
    let count = fit.free.len();
    let residuals = &fit.prediction.residuals;
    let weight = |i: usize| {
        let size = residuals[i].abs();
        let counts = size.is_finite() && !left.contains(&i);
        let weight = if size <= HUBER { 1.0 } else { HUBER / size };
        if counts { weight } else { 0.0 }
    };
    let weights: Vec<f64> = (0..residuals.len()).map(weight).collect();
    let product = |one: &[f64], other: &[f64]| -> f64 {
        let pairs = one.iter().zip(other).zip(&weights);
        pairs
            .filter(|((one, other), w)| **w > 0.0 && one.is_finite() && other.is_finite())
            .map(|((one, other), w)| w * one * other)
            .sum()
    };
    let mut normal = DMatrix::zeros(count, count);
    let mut gradient = DVector::zeros(count);
    for i in 0..count {
        for j in 0..=i {
            let sum = product(&fit.columns[i], &fit.columns[j]);
            normal[(i, j)] = sum;
            normal[(j, i)] = sum;
        }
        gradient[i] = product(&fit.columns[i], residuals);
    }
    for (i, free) in fit.free.iter().enumerate() {
        let slope = free.departure_slope(fit.values[i]);
        normal[(i, i)] += slope * slope;
        gradient[i] += slope * free.departure(fit.values[i]);
        // What the others do not tell stays where it is.
        normal[(i, i)] += 1e-6 * normal[(i, i)] + 1e-3;
    }
    let Some(step) = normal.cholesky().map(|c| c.solve(&gradient)) else {
        return fit.values.clone();
    };
    let moved = |(i, free): (usize, &super::free::Free)| {
        let at = free.coordinate.of(fit.values[i]) - step[i].clamp(-LONGEST, LONGEST);
        free.clamp(free.coordinate.value(at))
    };
    fit.free.iter().enumerate().map(moved).collect()
}
