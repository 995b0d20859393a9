//! What a sample counts for in a fit.
//!
//! ```text
//! rho(r) = r^2 for |r| <= c,   2 c |r| - c^2 beyond    (Huber);     c^2 ln(1 + (r/c)^2)    (Cauchy)
//! ```
//!
//! r residual [standard deviations], c where the loss turns [1].

use crate::diagnosis::settings::HUBER;
use crate::stats::quantile;

/// Robust sum of squares.
pub fn robust_sum(residuals: &[f64]) -> f64 {
    residuals
        .iter()
        .filter(|r| !r.is_nan())
        .map(|r| loss(*r, HUBER))
        .sum()
}

/// Weight of a residual relative to one that is not far off [1].
pub fn robust_weight(residual: f64) -> f64 {
    (HUBER / residual.abs()).min(1.0)
}

/// Huber's loss beyond a limit.
pub(in crate::diagnosis) fn loss(residual: f64, limit: f64) -> f64 {
    let size = residual.abs().min(1e6);
    if size <= limit {
        size * size
    } else {
        limit * (2.0 * size - limit)
    }
}

/// Weights of the samples.
pub(super) struct Weighing<'a> {
    /// One over what a residual is divided by.
    pub shares: &'a [f64],
    /// Where the loss turns from square to proportional, or to a logarithm.
    pub limit: f64,
    /// The logarithm (Cauchy): an impact that is met by one sample more or less counts for little.
    pub bounded: bool,
}

impl Weighing<'_> {
    /// Sum of the losses [1].
    pub fn sum(&self, residuals: &[f64]) -> f64 {
        let pairs = residuals
            .iter()
            .zip(self.shares)
            .filter(|(r, share)| !r.is_nan() && **share > 0.0);
        if self.bounded {
            let square = self.limit * self.limit;
            pairs
                .map(|(r, share)| square * ((r * share).powi(2).min(1e12) / square).ln_1p())
                .sum()
        } else {
            pairs.map(|(r, share)| loss(r * share, self.limit)).sum()
        }
    }

    /// Weights of the squares; none where there is no value.
    pub fn weights(&self, residuals: &[f64]) -> Vec<f64> {
        residuals
            .iter()
            .zip(self.shares)
            .map(|(r, share)| {
                if !r.is_finite() {
                    return 0.0;
                }
                let size = (r * share).abs();
                let weight = if self.bounded {
                    1.0 / (1.0 + (size / self.limit).powi(2))
                } else if size <= self.limit {
                    1.0
                } else {
                    self.limit / size
                };
                share * share * weight
            })
            .collect()
    }
}

/// Where the loss turns from square to proportional for now: far out while much is unexplained, because a proportional loss has no curvature and
/// converges slowly; at `HUBER` in the end.
pub(super) fn limit_for(residuals: &[f64], shares: &[f64]) -> f64 {
    let finite = residuals.iter().zip(shares).filter(|(r, _)| r.is_finite());
    let high = quantile(finite.map(|(r, share)| (r * share).abs()), 0.98);
    // Of noise alone, one in fifty is beyond 2.33.
    HUBER * (high.unwrap_or(0.0) / 2.5).max(1.0)
}
