//! How sure the numbers of an explanation are.
//!
//! The posterior is taken normal in the fit's coordinates, with the inverse of the information matrix as its covariance, widened by the root of the mean
//! square of what is left where that is more than noise. A number of several quantities, such as an amplitude, takes its spread along its gradient.

use super::search::Hypothesis;
use crate::effects::{Coordinate, Effect};
use crate::plant::PlantParameters;
use nalgebra::DMatrix;

/// Standard deviations to either side in a 95 % interval [1].
const INTERVAL: f64 = 1.96;

/// A number with its 95 % interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// Name with its unit.
    pub name: &'static str,
    /// Value.
    pub value: f64,
    /// Interval.
    pub interval: [f64; 2],
    /// Is it a part of the answer?
    pub reported: bool,
}

/// Numbers of an explanation.
#[derive(Debug, Clone)]
pub struct Estimates {
    /// What was tolerated and is still held to it, in the order of the fit.
    pub tolerated: Vec<Number>,
    /// Numbers of each effect.
    pub effects: Vec<(&'static Effect, Vec<Number>)>,
}

/// Numbers and intervals of an explanation of `samples` samples.
pub fn estimates(believed: &PlantParameters, hypothesis: &Hypothesis, samples: usize) -> Estimates {
    let fit = &hypothesis.fit;
    let count = fit.free.len();
    let widened = (fit.misfit / samples as f64).max(1.0);
    let covariance = covariance(&fit.information) * widened;
    let number = |index: usize, reported: bool| {
        let free = &fit.free[index];
        let deviation = covariance[(index, index)].max(0.0).sqrt();
        let at = free.coordinate.of(fit.values[index]);
        let ends =
            [-INTERVAL, INTERVAL].map(|z| free.clamp(free.coordinate.value(at + z * deviation)));
        Number {
            name: free.quantity.name,
            value: fit.values[index],
            interval: [ends[0].min(ends[1]), ends[0].max(ends[1])],
            reported,
        }
    };
    let numbers: Vec<usize> = hypothesis
        .effects
        .iter()
        .map(|effect| (effect.parameters)(believed).len())
        .collect();
    let mut at = count - numbers.iter().sum::<usize>();
    let tolerated = (0..at).map(|index| number(index, false)).collect();
    let mut effects = Vec::new();
    for (effect, own) in hypothesis.effects.iter().zip(numbers) {
        let parameters = (effect.parameters)(believed);
        let mut list: Vec<Number> = parameters
            .iter()
            .enumerate()
            .map(|(i, parameter)| number(at + i, parameter.reported))
            .collect();
        let place = |name: &str| parameters.iter().position(|p| p.quantity.name == name);
        if let (Some(sine), Some(cosine)) = (place("sine_m"), place("cosine_m")) {
            list.insert(
                0,
                amplitude(&fit.free, &fit.values, &covariance, at + sine, at + cosine),
            );
        }
        effects.push((*effect, list));
        at += own;
    }
    Estimates { tolerated, effects }
}

/// Zero to peak of a sine and a cosine.
fn amplitude(
    free: &[super::free::Free],
    values: &[f64],
    covariance: &DMatrix<f64>,
    sine: usize,
    cosine: usize,
) -> Number {
    let (s, c) = (values[sine], values[cosine]);
    let value = s.hypot(c);
    let slope = |index: usize, part: f64| match free[index].coordinate {
        Coordinate::Linear(scale) => scale * part / value,
        Coordinate::Logarithmic => values[index] * part / value,
    };
    let (a, b) = (slope(sine, s), slope(cosine, c));
    let variance = a * a * covariance[(sine, sine)]
        + 2.0 * a * b * covariance[(sine, cosine)]
        + b * b * covariance[(cosine, cosine)];
    let half = INTERVAL * variance.max(0.0).sqrt();
    Number {
        name: "amplitude_m",
        value,
        interval: [(value - half).max(0.0), value + half],
        reported: true,
    }
}

/// Inverse of an information matrix, scaled first; what is not determined at all gets a large variance.
fn covariance(information: &DMatrix<f64>) -> DMatrix<f64> {
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
