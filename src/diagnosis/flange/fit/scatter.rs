//! How far runs are from what a flange fitted to others says of them.
//!
//! ```text
//! s^2 = (v0 s0^2 + sum e^2) / (v0 + n),   interval: median exp(-+ hypot(t s, half the range of the fits))
//! ```
//!
//! e the logarithm of simulated over recorded, of each fitted run as a fit to the others predicts it, n such runs, t Student's for v0 + n degrees of freedom. s0
//! is what is to be expected before any run has said so, worth v0 runs (a conjugate prior of a variance: Gelman et al., Bayesian Data Analysis, 2013, 2.6):
//! runs of one flange at one setting differ by as much, and a simulation of it is wrong by it at another speed.

use super::prediction::{Logged, predict_run};
use super::report::SimulatedResult;
use super::residuals::Targets;
use super::solve::{Solution, refitted};
use crate::flange::{FlangeModel, Ripple};
use crate::stats::student_90;

/// What is to be expected of the logarithms of peak, ringing, settling and spread [1].
const EXPECTED: [f64; 4] = [0.15, 0.1, 0.25, 0.25];
/// Runs that it is worth.
const WORTH: f64 = 4.0;

/// Half of a 90 % interval of the logarithms of peak, ringing, settling and spread [1].
pub(super) type Scatter = [f64; 4];

/// Scatter of a flange by the runs that it was fitted to, each predicted by a fit to the others; of one run by that fit itself.
pub(super) fn scatter(
    best: &Solution,
    (targets, logged): (&[Targets], &[Logged<'_>]),
    mass: f64,
    ripple: Option<Ripple>,
) -> Scatter {
    let mut sums = [[0.0; 2]; 4];
    for (left, run) in logged.iter().enumerate() {
        let model: FlangeModel = match targets.len() {
            1 => best.model,
            _ => {
                let others = targets.iter().enumerate().filter(|(i, _)| *i != left);
                let others: Vec<Targets> = others.map(|(_, t)| t.clone()).collect();
                refitted(&others, mass, &best.model).model
            }
        };
        let Some(made) = predict_run(&[model], ripple, run) else {
            continue;
        };
        let results = [
            Some(made.peak),
            made.ringing,
            Some(made.settling),
            made.spread,
        ];
        for (sum, result) in sums.iter_mut().zip(results) {
            let error = result.map(|r| (r.simulated / r.recorded).ln());
            if let Some(error) = error.filter(|error| error.is_finite()) {
                sum[0] += error * error;
                sum[1] += 1.0;
            }
        }
    }
    std::array::from_fn(|i| half(EXPECTED[i], sums[i]))
}

fn half(expected: f64, [squares, count]: [f64; 2]) -> f64 {
    let variance = (WORTH * expected * expected + squares) / (WORTH + count);
    student_90(WORTH + count) * variance.sqrt()
}

/// A result with its 90 % interval.
pub(super) fn with_interval(result: SimulatedResult, half: f64) -> SimulatedResult {
    let range = 0.5 * (result.high / result.low).ln();
    let half = half.hypot(if range.is_finite() { range } else { 0.0 });
    SimulatedResult {
        low: result.simulated * (-half).exp(),
        high: result.simulated * half.exp(),
        ..result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_as_wide_as_runs_scatter() {
        // Nothing known: Student's t of what is expected.
        assert!((half(0.15, [0.0, 0.0]) - 2.132 * 0.15).abs() < 1e-3 * 2.132 * 0.15);
        // Four runs that are off by 0.3 each.
        let expected = 1.860 * ((4.0 * 0.0225 + 4.0 * 0.09) / 8.0f64).sqrt();
        assert!((half(0.15, [4.0 * 0.09, 4.0]) - expected).abs() < 1e-3 * expected);
        let result = SimulatedResult {
            recorded: 1.0,
            simulated: 100.0,
            low: 90.0,
            high: 110.0,
        };
        let found = with_interval(result, 0.3);
        let wide = 0.3f64.hypot(0.5 * (110.0f64 / 90.0).ln());
        assert!((found.high - 100.0 * wide.exp()).abs() < 1e-9, "{found:?}");
        assert!((found.low * found.high - 1e4).abs() < 1e-6);
    }
}
