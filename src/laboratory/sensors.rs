//! Records of a trajectory: noise of each sensor, and the steps of its converter.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Steps of a converter in a standard deviation of its noise: fine enough that it adds less than 1 % to it.
const STEPS: f64 = 8.0;

/// Step of a usual converter of a sensor with noise of a standard deviation.
pub(super) fn step_of(deviation: f64) -> f64 {
    decimal(deviation / STEPS)
}

/// Readings with noise of a standard deviation, rounded as a converter of a step does.
pub(super) fn measured(
    values: &[f64],
    deviation: f64,
    step: f64,
    rng: &mut ChaCha8Rng,
) -> Vec<f64> {
    values
        .iter()
        .map(|value| {
            let noise: f64 = StandardNormal.sample(rng);
            let steps = ((value + deviation * noise) / step).round();
            // Divided by a whole number, so that the decimal is the shortest.
            let per_unit = (1.0 / step).round();
            if per_unit >= 1.0 {
                steps / per_unit
            } else {
                steps * step
            }
        })
        .collect()
}

/// The power of ten at or below a number.
pub(super) fn decimal(value: f64) -> f64 {
    10f64.powi(value.log10().floor() as i32)
}

/// A number between two, every order of magnitude alike.
pub(super) fn between(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low * (high / low).powf(rng.random_range(0.0..1.0))
}

/// A number to three significant digits, as a data sheet gives it.
pub(super) fn as_printed(value: f64, digits: i32) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    format!("{value:.*e}", (digits - 1).max(0) as usize)
        .parse()
        .unwrap_or(value)
}
