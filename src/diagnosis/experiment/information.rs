//! What an experiment is expected to tell: which explanation is right, and how large its numbers are.
//!
//! ```text
//! D2(i, j) = min over dv of |(y_i - y_j) - J_j dv|2 / v + dv' N_j dv                         what j would still miss, fitted anew, were i the truth
//! P(k | i) = p_k exp(-D2(i, k) / 2) / sum over m of p_m exp(-D2(i, m) / 2)                   odds then
//! I = H(p) - sum over i of p_i H(P(. | i))                                                   about which (mutual information [nat]: Lindley 1956)
//! L = ln det(N_i + J_i' J_i / v) / 2 - ln det(N_i) / 2, over the numbers of its effects      about how much (D-optimality, Bayesian)
//! ```
//!
//! y predicted readings in standard deviations of the sensors' noise, J their derivatives by what an explanation leaves free, N what the recordings at hand know
//! of that, v what explanations leave beyond noise, p odds now, H entropy. Box and Hill's criterion (Technometrics 9, 1967) is the sum over pairs of p_i p_j D2,
//! which grows without end where one pair is distinguished; I is bounded by what is open, so an experiment gains by what it settles. With two explanations that
//! are even, both choose by D2 (T-optimality: Atkinson and Fedorov, Biometrika 62, 1975).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

use crate::diagnosis::fit::free::Free;
use crate::plant::{CHANNELS, PlantInputs, PlantParameters, simulate};

/// Step of the difference quotients in the fit's coordinate, as in the fit [1].
const STEP: f64 = 0.03;
/// Largest difference of a sample that counts, in standard deviations: impacts met at other times tell too easily [1].
const MOST: f64 = 10.0;
/// Share of D2 that is counted on: the truth is none of the models exactly, and a new fit goes further than one step [1].
const COUNTED: f64 = 0.25;

/// An explanation that is open.
#[derive(Debug, Clone)]
pub struct Open {
    /// Its effects as people read them.
    pub name: String,
    /// Its probability among the explanations [1].
    pub probability: f64,
    /// Its description.
    pub plant: PlantParameters,
    /// What it leaves free.
    pub free: Vec<Free>,
    /// Values of that.
    pub values: Vec<f64>,
    /// Information of the recordings at hand, in the fit's coordinates.
    pub information: DMatrix<f64>,
    /// Places of the numbers of its effects among what is free.
    pub of_effects: Vec<usize>,
}

/// What sensors are there, and what counts beside their noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensors {
    /// Standard deviation of each channel's noise; infinite where there is no sensor.
    pub noise: [f64; CHANNELS.len()],
    /// Variance of what the best explanation leaves over the noise's, times the samples that tell as much as one [1].
    pub variance: [f64; CHANNELS.len()],
}

/// What an experiment is expected to tell.
#[derive(Debug, Clone)]
pub struct Expected {
    /// Information on which explanation is right [nat].
    pub which: f64,
    /// Information on the numbers of their effects, weighed by their odds [nat].
    pub how_much: f64,
    /// Odds afterwards: for each explanation, were it the truth, those of all.
    pub odds: Vec<Vec<f64>>,
    /// Readings of each explanation.
    pub readings: Vec<[Vec<f64>; CHANNELS.len()]>,
}

/// Readings in standard deviations, channel after channel; nothing where there is no sensor.
fn weighed(sensors: &Sensors, readings: &[Vec<f64>; CHANNELS.len()]) -> Vec<f64> {
    let scales = sensors.noise.iter().zip(sensors.variance);
    (readings.iter().zip(scales))
        .filter(|(_, (noise, _))| noise.is_finite())
        .flat_map(|(values, (noise, variance))| {
            let scale = noise * variance.sqrt();
            values.iter().map(move |value| value / scale)
        })
        .collect()
}

fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

/// An explanation's readings with their derivatives.
struct Predicted {
    readings: [Vec<f64>; CHANNELS.len()],
    here: Vec<f64>,
    columns: DMatrix<f64>,
    /// N + J' J.
    after: Option<Cholesky<f64, Dyn>>,
    gained: f64,
}

impl Predicted {
    fn of(open: &Open, sensors: &Sensors, inputs: &PlantInputs) -> Self {
        let readings = simulate(&open.plant, inputs).readings;
        let here = weighed(sensors, &readings);
        let columns: Vec<Vec<f64>> = (open.free.par_iter().zip(&open.values))
            .map(|(free, value)| {
                let [back, on] = free.room(*value);
                if on - back <= 0.0 {
                    return vec![0.0; here.len()];
                }
                let at = free.coordinate.of(*value);
                let step = if STEP > on { -STEP } else { STEP };
                let mut moved = open.plant.clone();
                free.quantity
                    .set(&mut moved, free.coordinate.value(at + step));
                let there = weighed(sensors, &simulate(&moved, inputs).readings);
                let pairs = there.iter().zip(&here);
                pairs
                    .map(|(there, here)| {
                        finite((there - here) / step).clamp(-MOST / STEP, MOST / STEP)
                    })
                    .collect()
            })
            .collect();
        let count = columns.len();
        let columns = DMatrix::from_fn(here.len(), count, |i, j| columns[j][i]);
        let mut after = columns.tr_mul(&columns);
        let mut before = DMatrix::zeros(count, count);
        if open.information.nrows() == count {
            before += &open.information;
        }
        for i in 0..count {
            before[(i, i)] += 1e-9 * before[(i, i)] + 1e-6;
        }
        after += &before;
        let gained = gain(&before, &after, &open.of_effects);
        Self {
            readings,
            here,
            columns,
            after: after.cholesky(),
            gained,
        }
    }

    /// What this explanation would still miss, fitted anew, were another the truth.
    fn missed(&self, truth: &Self) -> f64 {
        let difference: Vec<f64> = (truth.here.iter().zip(&self.here))
            .map(|(truth, own)| finite(truth - own).clamp(-MOST, MOST))
            .collect();
        let difference = DVector::from_vec(difference);
        let slope = self.columns.tr_mul(&difference);
        let explained = (self.after.as_ref()).map_or(0.0, |after| slope.dot(&after.solve(&slope)));
        (difference.norm_squared() - explained).max(0.0)
    }
}

/// Information on some of the numbers, the others being free as well: half the change of the logarithm of their covariance's determinant.
fn gain(before: &DMatrix<f64>, after: &DMatrix<f64>, of: &[usize]) -> f64 {
    if of.is_empty() {
        return 0.0;
    }
    let logarithm = |information: &DMatrix<f64>| -> Option<f64> {
        let inverse = information.clone().cholesky()?.inverse();
        let own = DMatrix::from_fn(of.len(), of.len(), |i, j| inverse[(of[i], of[j])]);
        let root = own.cholesky()?;
        Some((0..of.len()).map(|i| root.l_dirty()[(i, i)].ln()).sum())
    };
    match (logarithm(before), logarithm(after)) {
        (Some(before), Some(after)) => (before - after).max(0.0),
        _ => 0.0,
    }
}

/// Entropy of odds [nat].
#[must_use]
pub fn entropy(odds: &[f64]) -> f64 {
    let own = odds.iter().filter(|p| **p > 0.0);
    own.map(|p| -p * p.ln()).sum()
}

/// Probabilities of explanations among one another [1].
#[must_use]
pub fn shares_of(open: &[Open]) -> Vec<f64> {
    let sum: f64 = open.iter().map(|own| own.probability).sum();
    open.iter().map(|own| own.probability / sum).collect()
}

/// What inputs are expected to tell of open explanations.
#[must_use]
pub fn expected(open: &[Open], sensors: &Sensors, inputs: &PlantInputs) -> Expected {
    let predicted: Vec<Predicted> = open
        .par_iter()
        .map(|own| Predicted::of(own, sensors, inputs))
        .collect();
    let odds: Vec<Vec<f64>> = predicted
        .iter()
        .map(|truth| {
            let logs: Vec<f64> = (open.iter().zip(&predicted))
                .map(|(own, model)| own.probability.ln() - 0.5 * COUNTED * model.missed(truth))
                .collect();
            let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let shares: Vec<f64> = logs.iter().map(|log| (log - most).exp()).collect();
            let sum: f64 = shares.iter().sum();
            shares.iter().map(|share| share / sum).collect()
        })
        .collect();
    let now = shares_of(open);
    let then: f64 = (now.iter().zip(&odds))
        .map(|(p, odds)| p * entropy(odds))
        .sum();
    let how_much = now.iter().zip(&predicted).map(|(p, own)| p * own.gained);
    Expected {
        which: (entropy(&now) - then).max(0.0),
        how_much: how_much.sum(),
        odds,
        readings: predicted.into_iter().map(|own| own.readings).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::free::Prior;
    use crate::diagnosis::test_evidence::{evidence, plant};
    use crate::effects::Coordinate;
    use crate::plant::registry;

    const SENSORS: Sensors = Sensors {
        noise: [400.0, 2e-5, 0.8, 0.15],
        variance: [1.0; 4],
    };

    fn open(name: &str, plant: PlantParameters, probability: f64) -> Open {
        Open {
            name: name.to_owned(),
            probability,
            plant,
            free: Vec::new(),
            values: Vec::new(),
            information: DMatrix::zeros(0, 0),
            of_effects: Vec::new(),
        }
    }

    /// The gain of the force sensor, free.
    fn with_gain(mut own: Open, known: f64) -> Open {
        own.free = vec![Free {
            quantity: registry::FORCE_GAIN.named("gain"),
            start: 1.0,
            coordinate: Coordinate::Linear(1.0),
            bounds: [0.5, 2.0],
            prior: Prior::Flat,
        }];
        own.values = vec![own.plant.sensors.force_gain];
        own.information = DMatrix::from_element(1, 1, known);
        own.of_effects = vec![0];
        own
    }

    fn inputs() -> PlantInputs {
        evidence(1).recordings.swap_remove(0).inputs
    }

    #[test]
    fn what_is_alike_stays_open_and_what_is_not_is_settled() {
        let mut other = plant();
        other.sensors.force_gain = 1.2;
        let pair = |second: &PlantParameters| {
            let all = [open("a", plant(), 0.6), open("b", second.clone(), 0.3)];
            expected(&all, &SENSORS, &inputs())
        };
        let same = pair(&plant());
        assert!(same.which.abs() < 1e-12);
        assert!(
            (same.odds[0][0] - 2.0 / 3.0).abs() < 1e-12,
            "{:?}",
            same.odds
        );
        let apart = pair(&other);
        let whole = entropy(&[2.0 / 3.0, 1.0 / 3.0]);
        assert!((apart.which - whole).abs() < 1e-6, "{}", apart.which);
        assert!(apart.odds[1][1] > 0.999_999);
    }

    /// Another gain is what a free gain comes to: nothing is missed, unless the recordings at hand know it.
    #[test]
    fn what_a_free_number_could_do_as_well_does_not_separate() {
        let mut other = plant();
        other.sensors.force_gain = 1.01;
        let truth = open("b", other, 0.5);
        let which = |known: f64| {
            let all = [with_gain(open("a", plant(), 0.5), known), truth.clone()];
            let found = expected(&all, &SENSORS, &inputs());
            // That the gain is moved stands for the truth: what is known of it denies that.
            found.odds[1][0]
        };
        assert!(which(0.0) > 0.49, "{}", which(0.0));
        assert!(which(1e12) < 1e-3, "{}", which(1e12));
    }

    /// ln(1 + J'J / N) / 2 of a number that scales the force.
    #[test]
    fn information_on_a_number_is_that_of_its_closed_form() {
        let known = 2e6;
        let own = with_gain(open("a", plant(), 1.0), known);
        let found = expected(std::slice::from_ref(&own), &SENSORS, &inputs());
        let force = &simulate(&own.plant, &inputs()).readings[2];
        // The derivative of the reading by the gain is the force itself, of which no sample counts more than its limit.
        let slopes = force
            .iter()
            .map(|f| (f / 0.8).clamp(-MOST / STEP, MOST / STEP));
        let gained: f64 = slopes.map(|slope| slope * slope).sum();
        let closed = 0.5 * (1.0 + gained / known).ln();
        assert!(
            (found.how_much / closed - 1.0).abs() < 1e-3,
            "{} {closed}",
            found.how_much
        );
        assert!(found.how_much > 0.1 && found.which == 0.0);
    }
}
