//! Prediction of each recording by a fit to the others, to one of two depths.
//!
//! ```text
//! u_r = u - (J' W J + P)^-1 (J' W r + p)      over all recordings but r, from the optimum u of all
//! ```
//!
//! J derivatives of the residuals by the coordinates, W weights of Huber's loss, P and p of the priors: one step of Gauss and Newton, which from an optimum
//! is all but the whole way where a law is nearly linear. A refit goes the whole way. Then the recording r is simulated with u_r.

use super::evidence::Evidence;
use super::fit::{Fit, ROUGH, Refit, fit, robust_sum, with_values};
use super::free::Free;
use super::model_error::ModelError;
use super::settings::HUBER;
use crate::plant::CHANNELS;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Longest step in a coordinate, as in the fit [1].
const LONGEST: f64 = 3.0;

/// Depth of a fit to the others.
#[derive(Debug, Clone, Copy)]
pub enum Depth {
    /// One step from the optimum of all, without a simulation.
    OneStep,
    /// A fit.
    Refit(Refit<'static>),
}

/// Recordings, each predicted by a fit to the others.
#[derive(Debug, Clone)]
pub struct LeftOut {
    /// Measured less predicted in standard deviations, by recording and channel.
    pub residuals: Vec<[Vec<f64>; CHANNELS.len()]>,
    /// Values of what is free in the fits, in the order of the fit to all.
    pub values: Vec<Vec<f64>>,
}

impl LeftOut {
    /// Robust sum of squares, weighed by a model error.
    pub fn sum(&self, model_error: &ModelError) -> f64 {
        let of_recording =
            (self.residuals.iter()).flat_map(|recording| recording.iter().enumerate());
        of_recording
            .map(|(channel, residuals)| model_error.cost_of(channel, residuals))
            .sum()
    }

    /// Variance of each free quantity in the fit's coordinates by how its value moves as recordings are left out: (n - 1) / n sum of (u_r - mean u)^2, the
    /// jackknife with recordings as its groups (Efron and Stein, Ann. Stat. 9, 1981). A law that is a little wrong is so in each recording in another way.
    pub fn jackknife(&self, free: &[Free]) -> Vec<f64> {
        let count = self.values.len() as f64;
        let of = |(index, free): (usize, &Free)| {
            let at: Vec<f64> = (self.values.iter())
                .map(|values| free.coordinate.of(values[index]))
                .collect();
            let mean = at.iter().sum::<f64>() / count;
            (count - 1.0) / count * at.iter().map(|u| (u - mean).powi(2)).sum::<f64>()
        };
        free.iter().enumerate().map(of).collect()
    }
}

/// Each recording, and the others.
#[derive(Debug)]
pub struct CrossValidation<'a> {
    evidence: &'a Evidence,
    turns: Vec<(Evidence, Evidence)>,
}

impl<'a> CrossValidation<'a> {
    /// Of recordings; none where one stands alone.
    #[must_use]
    pub fn of(evidence: &'a Evidence) -> Option<Self> {
        let count = evidence.recordings.len();
        let turn = |left| {
            let own = evidence.of_those(|i| i == left);
            (own, evidence.of_those(|i| i != left))
        };
        (count > 1).then(|| Self {
            evidence,
            turns: (0..count).map(turn).collect(),
        })
    }

    /// Samples of a recording among the residuals of all.
    fn samples(&self, recording: usize) -> Range<usize> {
        let count = |i: usize| CHANNELS.len() * self.evidence.recordings[i].inputs.time.len();
        let start: usize = (0..recording).map(count).sum();
        start..start + count(recording)
    }

    /// Standard deviations of the predictions of a recording by a fit to the others, by channel, noise included, in units of the noise's [1]; none where
    /// the fit has no derivatives.
    #[must_use]
    pub fn predictive(&self, whole: &Fit, recording: usize) -> Option<[Vec<f64>; CHANNELS.len()]> {
        if whole.columns.len() != whole.free.len() {
            return None;
        }
        let all = predictive(whole, &self.samples(recording));
        let count = all.len() / CHANNELS.len();
        Some(std::array::from_fn(|channel| {
            all[channel * count..(channel + 1) * count].to_vec()
        }))
    }

    /// Values of what is free by a fit to all recordings but one, for each of them.
    fn values(&self, whole: &Fit, depth: Depth) -> Vec<Vec<f64>> {
        let turn = |left: usize| match depth {
            Depth::Refit(refit) => {
                let (free, from) = (refit.free(whole), (&whole.prediction.plant, None));
                let others = &self.turns[left].1;
                fit(others, from, (&free, &[]), refit.stages, refit.limit).values
            }
            Depth::OneStep => without(whole, &self.samples(left)),
        };
        (0..self.turns.len()).into_par_iter().map(turn).collect()
    }

    /// Each recording as predicted; none where derivatives are asked for that the fit has not.
    #[must_use]
    pub fn left_out(&self, whole: &Fit, depth: Depth) -> Option<LeftOut> {
        if matches!(depth, Depth::OneStep) && whole.columns.len() != whole.free.len() {
            return None;
        }
        let values = self.values(whole, depth);
        let turns = self.turns.par_iter().zip(&values);
        let residuals = turns.map(|((own, _), values)| {
            let plant = with_values(&whole.prediction.plant, &whole.free, values);
            let residuals = own.predict(&plant, false, None).residuals;
            let count = own.recordings[0].inputs.time.len();
            std::array::from_fn(|channel| {
                residuals[channel * count..(channel + 1) * count].to_vec()
            })
        });
        Some(LeftOut {
            residuals: residuals.collect(),
            values,
        })
    }

    /// Cost of all recordings, the piston held to its measured motion and errors in time forgiven [1].
    #[must_use]
    pub fn rough_cost(&self, whole: &Fit, depth: Depth) -> f64 {
        let values = self.values(whole, depth);
        let turns = self.turns.iter().zip(&values).map(|((own, _), values)| {
            let plant = &with_values(&whole.prediction.plant, &whole.free, values);
            let shares = own.shares(ROUGH[0].forgiven, ROUGH[0].guided);
            let left = own.predict(plant, ROUGH[0].guided, None).residuals;
            let counted = left.iter().zip(shares.iter()).map(|(r, share)| r * share);
            robust_sum(&counted.collect::<Vec<f64>>())
        });
        turns.sum()
    }
}

/// Normal equations in the fit's coordinates without some samples, priors included: information and gradient.
fn normal_without(fit: &Fit, left: &Range<usize>) -> (DMatrix<f64>, DVector<f64>) {
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
    (normal, gradient)
}

/// Values of the free quantities without some samples.
fn without(fit: &Fit, left: &Range<usize>) -> Vec<f64> {
    let (normal, gradient) = normal_without(fit, left);
    let Some(step) = normal.cholesky().map(|c| c.solve(&gradient)) else {
        return fit.values.clone();
    };
    let moved = |(i, free): (usize, &Free)| {
        let at = free.coordinate.of(fit.values[i]) - step[i].clamp(-LONGEST, LONGEST);
        free.clamp(free.coordinate.value(at))
    };
    fit.free.iter().enumerate().map(moved).collect()
}

/// Standard deviation of the prediction of samples by a fit to the others, noise included, in standard deviations of the noise: sqrt(1 + c' V c), c their
/// derivatives and V the covariance of that fit [1].
fn predictive(fit: &Fit, left: &Range<usize>) -> Vec<f64> {
    let Some(known) = normal_without(fit, left).0.cholesky() else {
        return vec![1.0; left.len()];
    };
    let of = |i: usize| {
        let slopes = fit.columns.iter().map(|column| column[i]);
        let c = DVector::from_iterator(
            fit.columns.len(),
            slopes.map(|c| if c.is_finite() { c } else { 0.0 }),
        );
        (1.0 + c.dot(&known.solve(&c))).sqrt()
    };
    left.clone().map(of).collect()
}
