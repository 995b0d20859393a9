//! How wide a band about a prediction holds nine readings in ten, from readings that were not fitted to.
//!
//! ```text
//! w = max(1.645, 90th percentile of |r| / sqrt(1 + c' V c))
//! ```
//!
//! r residuals of recordings that were left out in turn, in standard deviations of the noise, c derivatives of a residual by the fit's coordinates, V their
//! covariance. 1.645 is that of a normal distribution; a law that is a little wrong needs more (split conformal prediction: Lei et al., JASA 113, 2018).

use nalgebra::{DMatrix, DVector};

use crate::diagnosis::difference::extent::percentile_90;
use crate::diagnosis::recordings::evidence::{Evidence, by_channel};
use crate::diagnosis::search::ranking::Ranked;
use crate::plant::CHANNELS;
use crate::stats::NORMAL_90;

/// Half of a 90 % band of each channel, in standard deviations of noise and numbers together [1].
pub(in crate::diagnosis) fn half_widths(
    evidence: &Evidence,
    best: &Ranked,
    covariance: &DMatrix<f64>,
) -> [f64; CHANNELS.len()] {
    let fit = &best.hypothesis.fit;
    let known = fit.columns.len() == covariance.nrows();
    let deviation = |index: usize| {
        if !known {
            return 1.0;
        }
        let slopes = fit.columns.iter().map(|column| column[index]);
        let slopes = slopes.map(|c| if c.is_finite() { c } else { 0.0 });
        let c = DVector::from_iterator(fit.columns.len(), slopes);
        (1.0 + c.dot(&(covariance * &c)).max(0.0)).sqrt()
    };
    let mut sizes: [Vec<f64>; CHANNELS.len()] = Default::default();
    let mut at = 0;
    for (recording, channel, own) in by_channel(evidence, &fit.prediction.residuals) {
        let channel = channel as usize;
        let left = best.left_out.as_ref();
        let residuals = left.map_or(own, |left| &left.residuals[recording][channel]);
        for (place, residual) in residuals.iter().enumerate() {
            if residual.is_finite() {
                sizes[channel].push(residual / deviation(at + place));
            }
        }
        at += own.len();
    }
    sizes.map(|sizes| {
        let percentile = percentile_90(sizes.into_iter());
        percentile.map_or(NORMAL_90, |p| p.max(NORMAL_90))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::cross_validation::LeftOut;
    use crate::diagnosis::fit::hypothesis::Hypothesis;
    use crate::diagnosis::test_evidence::{evidence, fit};

    #[test]
    fn what_was_left_out_says_how_wide_a_band_is() {
        let evidence = evidence(2);
        let samples = evidence.recordings[0].inputs.time.len();
        let count = 2 * CHANNELS.len() * samples;
        let spread = |most: f64| {
            (0..samples)
                .map(|i| most * i as f64 / (samples - 1) as f64)
                .collect()
        };
        let best = |most: [f64; 4]| Ranked {
            hypothesis: Hypothesis {
                effects: Vec::new(),
                // Derivatives of 3 and a deviation of 1: sqrt(10) standard deviations of noise in all.
                fit: fit(vec![1.0; count], vec![3.0; count], 0.0),
                depends_on: Vec::new(),
            },
            score: 0.0,
            odds: 1.0,
            probability: 1.0,
            left_out: Some(LeftOut {
                residuals: vec![most.map(spread).to_vec(); 2],
                values: vec![vec![0.0]; 2],
            }),
        };
        let covariance = DMatrix::from_element(1, 1, 1.0);
        let found = half_widths(&evidence, &best([1.0, 10.0, 20.0, 0.0]), &covariance);
        let expected = [
            NORMAL_90,
            9.0 / 10f64.sqrt(),
            18.0 / 10f64.sqrt(),
            NORMAL_90,
        ];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
        }
    }
}
