//! Prediction of each recording by a fit to the others, to one of two depths.
//!
//! ```text
//! u_r = u - (J' W J + P)^-1 (J' W r + p)      over all recordings but r, from the optimum u of all
//! ```
//!
//! J derivatives of the residuals by the coordinates, W weights of Huber's loss, P and p of the priors: one step of Gauss and Newton, which from an optimum
//! is all but the whole way where a law is nearly linear. A refit goes the whole way. Then the recording r is simulated with u_r.

use super::free::Free;
use super::model_error::ModelError;
use super::normal_equations::weighted_products;
use super::{Fit, ROUGH, Refit, fit, robust_sum, with_values};
use crate::diagnosis::recordings::device::Device;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::diagnosis::recordings::subject::Subject;
use crate::diagnosis::settings::HUBER;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Longest step in a coordinate, as in the fit [1].
const LONGEST: f64 = 3.0;

/// Depth of a fit to the others.
#[derive(Debug, Clone, Copy)]
pub enum Depth<S: Subject = Device> {
    /// One step from the optimum of all, without a simulation.
    OneStep,
    /// A fit.
    Refit(Refit<'static, S>),
}

/// Recordings, each predicted by a fit to the others.
#[derive(Debug, Clone)]
pub struct LeftOut {
    /// Measured less predicted in standard deviations, by recording and channel.
    pub residuals: Vec<Vec<Vec<f64>>>,
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
    pub fn jackknife<S: Subject>(&self, free: &[Free<S>]) -> Vec<f64> {
        let count = self.values.len() as f64;
        let of = |(index, free): (usize, &Free<S>)| {
            let at: Vec<f64> = (self.values.iter())
                .map(|values| free.coordinate.of(values[index]))
                .collect();
            let mean = at.iter().sum::<f64>() / count;
            (count - 1.0) / count * at.iter().map(|u| (u - mean).powi(2)).sum::<f64>()
        };
        free.iter().enumerate().map(of).collect()
    }
}

/// Each recording as predicted by a fit to the others; none where there are no others, or where derivatives are asked for that the fit has not.
#[must_use]
pub fn left_out<S: Subject>(
    evidence: &Evidence<S>,
    whole: &Fit<S>,
    depth: Depth<S>,
) -> Option<LeftOut> {
    let values = values(evidence, whole, depth)?;
    let residuals = values.par_iter().enumerate().map(|(left, values)| {
        let plant = with_values(&whole.prediction.plant, &whole.free, values);
        let own = evidence.of_those(|i| i == left);
        by_channel::<S>(own.predict(&plant, false, None).residuals)
    });
    Some(LeftOut {
        residuals: residuals.collect(),
        values,
    })
}

/// Cost of each recording by a fit to the others, the piston held to its measured motion and errors in time forgiven [1]; none where there are no others.
#[must_use]
pub fn rough_cost<S: Subject>(
    evidence: &Evidence<S>,
    whole: &Fit<S>,
    depth: Depth<S>,
) -> Option<f64> {
    let values = values(evidence, whole, depth)?;
    let turns = values.iter().enumerate().map(|(left, values)| {
        let own = evidence.of_those(|i| i == left);
        let plant = with_values(&whole.prediction.plant, &whole.free, values);
        let shares = own.shares(ROUGH[0].forgiven, ROUGH[0].guided);
        let left = own.predict(&plant, ROUGH[0].guided, None).residuals;
        let counted = left.iter().zip(shares.iter()).map(|(r, share)| r * share);
        robust_sum(&counted.collect::<Vec<f64>>())
    });
    Some(turns.sum())
}

/// Standard deviations of the predictions of a recording by a fit to the others, noise included, in standard deviations of the noise, by channel:
/// sqrt(1 + c' V c), c the derivatives of a sample and V the covariance of that fit [1]; none where the fit has no derivatives.
#[must_use]
pub fn predictive<S: Subject>(
    evidence: &Evidence<S>,
    whole: &Fit<S>,
    left: usize,
) -> Option<Vec<Vec<f64>>> {
    let samples = samples(evidence, left);
    let known = normal_without(whole, &samples)?.0.cholesky()?;
    let deviation = |i: usize| {
        let slopes = whole.columns.iter().map(|column| column[i]);
        let slopes = slopes.map(|c| if c.is_finite() { c } else { 0.0 });
        let c = DVector::from_iterator(whole.columns.len(), slopes);
        (1.0 + c.dot(&known.solve(&c))).sqrt()
    };
    Some(by_channel::<S>(samples.map(deviation).collect()))
}

/// Values of one recording's samples by channel.
fn by_channel<S: Subject>(all: Vec<f64>) -> Vec<Vec<f64>> {
    let count = (all.len() / S::CHANNELS.len()).max(1);
    all.chunks(count).map(<[f64]>::to_vec).collect()
}

/// Samples of a recording among the residuals of all.
fn samples<S: Subject>(evidence: &Evidence<S>, recording: usize) -> Range<usize> {
    let length = |i: usize| S::time(&evidence.recordings[i].inputs).len();
    let count = |i: usize| S::CHANNELS.len() * length(i);
    let start: usize = (0..recording).map(count).sum();
    start..start + count(recording)
}

/// Values of what is free by a fit to all recordings but one, for each of them.
fn values<S: Subject>(
    evidence: &Evidence<S>,
    whole: &Fit<S>,
    depth: Depth<S>,
) -> Option<Vec<Vec<f64>>> {
    let count = evidence.recordings.len();
    let turn = |left: usize| match depth {
        Depth::Refit(refit) => {
            let (free, from) = (refit.free(whole), (&whole.prediction.plant, None));
            let others = evidence.of_those(|i| i != left);
            Some(fit(&others, from, (&free, &[]), refit.stages, refit.limit).values)
        }
        Depth::OneStep => without(whole, &samples(evidence, left)),
    };
    let turns = (0..count).into_par_iter().filter(|_| count > 1).map(turn);
    let values: Option<Vec<Vec<f64>>> = turns.collect();
    values.filter(|values| !values.is_empty())
}

/// Normal equations in the fit's coordinates without some samples, priors included: information and gradient; none without derivatives.
fn normal_without<S: Subject>(
    fit: &Fit<S>,
    left: &Range<usize>,
) -> Option<(DMatrix<f64>, DVector<f64>)> {
    let count = fit.free.len();
    if fit.columns.len() != count {
        return None;
    }
    let residuals = &fit.prediction.residuals;
    let weight = |i: usize| {
        let size = residuals[i].abs();
        let counts = size.is_finite() && !left.contains(&i);
        let weight = if size <= HUBER { 1.0 } else { HUBER / size };
        if counts { weight } else { 0.0 }
    };
    let weights: Vec<f64> = (0..residuals.len()).map(weight).collect();
    let (mut normal, mut gradient) = weighted_products(&fit.columns, residuals, &weights);
    for (i, free) in fit.free.iter().enumerate() {
        let slope = free.departure_slope(fit.values[i]);
        normal[(i, i)] += slope * slope;
        gradient[i] += slope * free.departure(fit.values[i]);
        // What the others do not tell stays where it is.
        normal[(i, i)] += 1e-6 * normal[(i, i)] + 1e-3;
    }
    Some((normal, gradient))
}

/// Values of the free quantities without some samples, by one step.
fn without<S: Subject>(fit: &Fit<S>, left: &Range<usize>) -> Option<Vec<f64>> {
    let (normal, gradient) = normal_without(fit, left)?;
    let Some(step) = normal.cholesky().map(|c| c.solve(&gradient)) else {
        return Some(fit.values.clone());
    };
    let moved = |(i, free): (usize, &Free<S>)| {
        let at = free.coordinate.of(fit.values[i]) - step[i].clamp(-LONGEST, LONGEST);
        free.clamp(free.coordinate.value(at))
    };
    Some(fit.free.iter().enumerate().map(moved).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::{evidence, fit, free};
    use crate::plant::CHANNELS;

    /// Of a mean the jackknife is the sample variance over the number, to the last digit.
    #[test]
    fn the_jackknife_of_a_mean_is_its_variance() {
        let drawn = [3.0, -1.0, 4.0, 1.5, 9.0];
        let sum: f64 = drawn.iter().sum();
        let values = drawn.map(|left| vec![(sum - left) / 4.0]).to_vec();
        let left = LeftOut {
            residuals: Vec::new(),
            values,
        };
        let mean = sum / 5.0;
        let squares: f64 = drawn.iter().map(|x| (x - mean).powi(2)).sum();
        let found = left.jackknife(&[free()]);
        assert!((found[0] - squares / 4.0 / 5.0).abs() < 1e-12, "{found:?}");
    }

    /// A mean over two recordings: what one predicts of the other is uncertain by as much noise as one over the samples that it has.
    #[test]
    fn a_prediction_is_as_uncertain_as_what_it_was_fitted_to_says() {
        let evidence = evidence(2);
        let count = 2 * CHANNELS.len() * evidence.recordings[0].inputs.time.len();
        let whole = fit(vec![0.0; count], vec![0.2; count], 0.0);
        let known = 0.04 * (count / 2) as f64;
        let expected = (1.0 + 0.04 / known).sqrt();
        for deviation in predictive(&evidence, &whole, 1).unwrap().iter().flatten() {
            assert!(
                (deviation - expected).abs() < 1e-5,
                "{deviation}, {expected}"
            );
        }
        // One that carries no information on it leaves it unknown.
        let mut column = vec![0.2; count / 2];
        column.extend(vec![0.0; count / 2]);
        let blind = predictive(&evidence, &fit(vec![0.0; count], column, 0.0), 0).unwrap();
        assert!(blind[0][0] > 5.0, "{}", blind[0][0]);
    }

    /// One step from the mean of both recordings is the mean of the other.
    #[test]
    fn one_step_goes_to_the_fit_to_the_others() {
        let evidence = evidence(2);
        let half = CHANNELS.len() * evidence.recordings[0].inputs.time.len();
        let mut residuals = vec![1.0; half];
        residuals.extend(vec![-1.0; half]);
        // Measured less predicted: the derivative by a value added to the prediction is -1.
        let whole = fit(residuals, vec![-1.0; 2 * half], 5.0);
        let values = values(&evidence, &whole, Depth::OneStep).unwrap();
        assert!((values[0][0] - 4.0).abs() < 1e-3, "{values:?}");
        assert!((values[1][0] - 6.0).abs() < 1e-3, "{values:?}");
    }

    /// Two recordings of surfaces a millimetre apart: fitted to one alone the surface is where that one has it. A recording that stayed in the fit that is to
    /// predict it would draw the surface to the middle, and predict itself better than it is predicted.
    #[test]
    fn a_refit_knows_nothing_of_the_recording_that_it_predicts() {
        let surfaces = [0.0, 1e-3];
        let recorded = surfaces.map(|surface| {
            let mut truth = crate::diagnosis::test_evidence::plant();
            truth.contact.surface_offset = surface;
            crate::diagnosis::test_evidence::evidence_of(&truth, vec![vec![2e5; 126]]).recordings
        });
        let noise = crate::diagnosis::test_evidence::evidence(1).noise;
        let evidence = Evidence::new(recorded.concat(), noise);
        let quantity = Free {
            coordinate: crate::effects::Coordinate::Linear(1e-3),
            bounds: [-0.01, 0.01],
            ..free()
        };
        let start = (&crate::diagnosis::test_evidence::plant(), None);
        let stages = crate::diagnosis::fit::FINEST;
        let limit = crate::diagnosis::fit::Limit::FULL;
        let whole = crate::diagnosis::fit::fit(&evidence, start, (&[quantity], &[]), stages, limit);
        let left = left_out(&evidence, &whole, Depth::Refit(Refit::FINEST)).unwrap();
        assert!((left.values[0][0] - 1e-3).abs() < 2e-5, "{:?}", left.values);
        assert!(left.values[1][0].abs() < 2e-5, "{:?}", left.values);
        // What is predicted is the recording that was left out: it lies a millimetre off, in stroke or force.
        let largest = |recording: usize| {
            let residuals = left.residuals[recording].iter().flatten();
            residuals.fold(0.0, |most: f64, r| most.max(r.abs()))
        };
        assert!(largest(0) > 10.0 && largest(1) > 10.0);
        let none = left_out(
            &evidence.of_those(|i| i == 0),
            &whole,
            Depth::Refit(Refit::FINEST),
        );
        assert!(none.is_none(), "one recording has no others");
    }
}
