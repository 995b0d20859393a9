//! Covariance of fitted quantities that holds where the residuals are not white.
//!
//! ```text
//! V = H^-1 (B + P) H^-1,   B = sum over blocks of g g^T,   g = sum over a block's samples of w c r         (White 1982; blocks: Newey and West 1987)
//! ```
//!
//! H information with priors, P that of the priors alone, c derivatives of a residual r by the fit's coordinates, w its robust weight. Where a law is a
//! little wrong its residuals have the same sign for a while, and a block of them counts as one. Where they are white, B is H less P and V is H^-1; less
//! than that is never trusted.

use nalgebra::{DMatrix, DVector};

use super::{Fit, robust_weight};
use crate::diagnosis::recordings::evidence::Evidence;
use crate::diagnosis::recordings::subject::Subject;

/// Covariance of the free quantities in the fit's coordinates.
pub fn covariance<S: Subject>(evidence: &Evidence<S>, fit: &Fit<S>) -> DMatrix<f64> {
    let inverse = inverse(&fit.information);
    let count = fit.free.len();
    if fit.columns.len() != count {
        return inverse;
    }
    let mut meat = DMatrix::zeros(count, count);
    for (i, free) in fit.free.iter().enumerate() {
        meat[(i, i)] = free.departure_slope(fit.values[i]).powi(2);
    }
    for block in blocks(evidence, fit) {
        meat += &block * block.transpose();
    }
    let robust = &inverse * meat * &inverse;
    let stretch = DVector::from_fn(count, |i, _| {
        (inverse[(i, i)] / robust[(i, i)].max(f64::MIN_POSITIVE))
            .sqrt()
            .max(1.0)
    });
    DMatrix::from_fn(count, count, |i, j| {
        stretch[i] * stretch[j] * robust[(i, j)]
    })
}

/// Gradients of each block.
fn blocks<S: Subject>(evidence: &Evidence<S>, fit: &Fit<S>) -> Vec<DVector<f64>> {
    let residuals = &fit.prediction.residuals;
    let mut found = Vec::new();
    let mut at = 0;
    for measured in &evidence.recordings {
        let time = S::time(&measured.inputs);
        let first = time[0];
        let number = |t: f64| ((t - first) / evidence.block) as usize;
        let mut own = vec![DVector::zeros(fit.free.len()); number(time[time.len() - 1]) + 1];
        for _ in S::CHANNELS {
            for (i, t) in time.iter().enumerate() {
                let residual = residuals[at + i];
                if !residual.is_finite() {
                    continue;
                }
                let weighted = robust_weight(residual) * residual;
                let block = &mut own[number(*t)];
                for (sum, column) in block.iter_mut().zip(&fit.columns) {
                    let slope = column[at + i];
                    if slope.is_finite() {
                        *sum += weighted * slope;
                    }
                }
            }
            at += time.len();
        }
        found.append(&mut own);
    }
    found
}

/// Inverse of an information matrix, scaled first; what is not determined at all gets a large variance.
pub fn inverse(information: &DMatrix<f64>) -> DMatrix<f64> {
    let count = information.nrows();
    let scale: Vec<f64> = (0..count)
        .map(|i| 1.0 / information[(i, i)].max(1e-12).sqrt())
        .collect();
    let mut scaled = DMatrix::from_fn(count, count, |i, j| {
        information[(i, j)] * scale[i] * scale[j]
    });
    for i in 0..count {
        scaled[(i, i)] += 1e-10;
    }
    let inverse = scaled
        .cholesky()
        .map_or_else(|| DMatrix::identity(count, count), |c| c.inverse());
    DMatrix::from_fn(count, count, |i, j| inverse[(i, j)] * scale[i] * scale[j])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::{evidence, fit};
    use crate::plant::CHANNELS;

    /// Samples in each block of a quarter of a second, of half a second every 4 ms: 63, 62 and the last one.
    const BLOCKS: [f64; 3] = [63.0, 62.0, 1.0];
    const DERIVATIVE: f64 = 0.2;

    /// Residuals of one deviation that keep their sign for a block: each block counts as one residual of all its samples, so that the variance is the sum over
    /// blocks of (c n r)^2 over the square of the information n c^2, 50 times that of white ones.
    #[test]
    fn residuals_that_keep_their_sign_for_a_block_count_as_one() {
        let evidence = evidence(1);
        let samples = evidence.recordings[0].inputs.time.len();
        let count = CHANNELS.len() * samples;
        let channels = CHANNELS.len() as f64;
        let found = covariance(
            &evidence,
            &fit(vec![1.0; count], vec![DERIVATIVE; count], 0.0),
        )[(0, 0)];
        let information = DERIVATIVE * DERIVATIVE * count as f64;
        let gradients = BLOCKS.map(|of| (DERIVATIVE * channels * of).powi(2));
        let expected = gradients.iter().sum::<f64>() / information.powi(2);
        assert!((found / expected - 1.0).abs() < 1e-6, "{found}, {expected}");
        assert!(found > 50.0 / information, "{found}");
    }

    /// Residuals of alternating sign cancel in every block: less than the variance of white noise is not trusted.
    #[test]
    fn residuals_that_cancel_leave_the_variance_of_white_noise() {
        let evidence = evidence(1);
        let samples = evidence.recordings[0].inputs.time.len();
        let count = CHANNELS.len() * samples;
        let alternating = (0..count).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 });
        let found = covariance(
            &evidence,
            &fit(alternating.collect(), vec![DERIVATIVE; count], 0.0),
        )[(0, 0)];
        let white = 1.0 / (DERIVATIVE * DERIVATIVE * count as f64);
        assert!((found / white - 1.0).abs() < 1e-6, "{found}, {white}");
    }

    /// Blocks end with their recording: two recordings of opposite residuals do not cancel.
    #[test]
    fn a_block_is_of_one_recording() {
        let evidence = evidence(2);
        let samples = evidence.recordings[0].inputs.time.len();
        let half = CHANNELS.len() * samples;
        let mut residuals = vec![1.0; half];
        residuals.extend(vec![-1.0; half]);
        let found = covariance(&evidence, &fit(residuals, vec![DERIVATIVE; 2 * half], 0.0))[(0, 0)];
        let channels = CHANNELS.len() as f64;
        let gradients = BLOCKS.map(|of| 2.0 * (DERIVATIVE * channels * of).powi(2));
        let information = DERIVATIVE * DERIVATIVE * (2 * half) as f64;
        let expected = gradients.iter().sum::<f64>() / information.powi(2);
        assert!((found / expected - 1.0).abs() < 1e-6, "{found}, {expected}");
    }
}
