//! What an experiment is expected to tell: which explanation is right, and how large its numbers are.
//!
//! ```text
//! D2(i, j) = min over a, b of |y_i + J_i a - y_j - J_j b|2 / v + a' N_i a + b' N_j b         how far apart the nearest devices of both are
//! P(k | i) ~ p_k max(exp(-D2(i, k) / 2), M_i / (D2(i, k) + M_i))                             odds then, M_i a thousandth of |y_i - y_0|2
//! I = H(p) - sum over i of p_i H(P(. | i))                                                   about which (mutual information [nat]: Lindley 1956)
//! L = ln det(N_i + J_i' J_i / v) / 2 - ln det(N_i) / 2, over the numbers of its effects      about how much (D-optimality, Bayesian)
//! ```
//!
//! y predicted readings, y_0 those without any of the effects, in standard deviations of the sensors' noise, J their derivatives by what an explanation leaves free, N what the recordings at hand know
//! of that, v what explanations leave beyond noise, p odds now, H entropy. Box and Hill's criterion (Technometrics 9, 1967) is the sum over pairs of p_i p_j D2,
//! which grows without end where one pair is distinguished; I is bounded by what is open, so an experiment gains by what it settles. With two explanations that
//! are even, both choose by D2 (T-optimality: Atkinson and Fedorov, Biometrika 62, 1975).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::diagnosis::fit::free::Free;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::diagnosis::recordings::predictability::sensitivity;
use crate::diagnosis::search::scale::IMMATERIAL;
use crate::plant::{CHANNELS, PlantInputs, PlantParameters, PlantTrajectory, Trajectory, simulate};

/// Step of the difference quotients in the fit's coordinate, as in the fit [1].
const STEP: f64 = 0.03;
/// What a sample's difference comes to at most, in standard deviations: impacts met at other times tell too easily [1].
const MOST: f64 = 10.0;
/// Share of D2 that is counted on: the truth is none of the models exactly, and a new fit goes further than one step [1].
const COUNTED: f64 = 0.1;
/// Share of what one step explains at a sample that further ones may explain of the rest [1].
const CURVED: f64 = 0.2;
/// Samples that two explanations are compared at, at most: of more, one of so many stands for them.
const COMPARED: usize = 4000;

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
#[derive(Debug, Clone)]
pub struct Sensors {
    /// The rig without any of the explanations' effects.
    pub without: PlantParameters,
    /// Standard deviation of each channel's noise; infinite where there is no sensor.
    pub noise: [f64; CHANNELS.len()],
    /// Variance of what the best explanation leaves over the noise's, times the samples that tell as much as one [1].
    pub variance: [f64; CHANNELS.len()],
    /// A pressure sensor in a chamber, which no rig has by its file.
    pub probe: Option<Probe>,
}

/// A pressure sensor in a chamber.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// The chamber, 0 or 1.
    pub chamber: usize,
    /// Standard deviation of its noise [Pa].
    pub noise: f64,
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
fn weighed(sensors: &Sensors, trajectory: &PlantTrajectory) -> Vec<f64> {
    let scales = sensors.noise.iter().zip(sensors.variance);
    let own = (trajectory.readings.iter().zip(scales))
        .filter(|(_, (noise, _))| noise.is_finite())
        .flat_map(|(values, (noise, variance))| {
            let scale = noise * variance.sqrt();
            values.iter().map(move |value| value / scale)
        });
    let further = sensors.probe.iter().flat_map(|probe| {
        let values = trajectory.truth.pressures[probe.chamber].iter();
        values.map(|value| value / probe.noise)
    });
    own.chain(further).collect()
}

fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

/// A difference with the share of it that counts, by which it comes to no more than the largest.
fn bounded(difference: f64) -> (f64, f64) {
    let difference = finite(difference);
    let share = 1.0 / (difference / MOST).hypot(1.0);
    (share * difference, share)
}

/// Readings of one recording, by channel.
type Readings = [Vec<f64>; CHANNELS.len()];

/// An explanation's readings with their derivatives.
struct Predicted {
    readings: Readings,
    here: Vec<f64>,
    columns: DMatrix<f64>,
    /// N.
    before: DMatrix<f64>,
    gained: f64,
}

/// Derivatives of weighed readings by what an explanation leaves free, in the fit's coordinates: a row a sample, a column a number.
fn slopes(open: &Open, sensors: &Sensors, inputs: &PlantInputs, here: &[f64]) -> DMatrix<f64> {
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
            let there = weighed(sensors, &simulate(&moved, inputs));
            let pairs = there.iter().zip(here);
            pairs
                .map(|(there, here)| finite((there - here) / step))
                .collect()
        })
        .collect();
    DMatrix::from_fn(here.len(), columns.len(), |i, j| columns[j][i])
}

fn squares(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum()
}

fn bounded_slope(slope: f64) -> f64 {
    slope.clamp(-MOST / STEP, MOST / STEP)
}

impl Open {
    /// What recordings know of its numbers, with their priors: by the same steps as what an experiment would, for a derivative at an impact, of a step as small
    /// as a fit's, claims more than holds over any distance.
    #[must_use]
    pub fn informed_by(mut self, evidence: &Evidence, sensors: &Sensors) -> Self {
        let count = self.free.len();
        let mut information = DMatrix::zeros(count, count);
        for measured in &evidence.recordings {
            let here = weighed(sensors, &simulate(&self.plant, &measured.inputs));
            let mut columns = slopes(&self, sensors, &measured.inputs, &here);
            let readings = measured.readings.iter().zip(sensors.noise);
            let given = readings
                .filter(|(_, noise)| noise.is_finite())
                .flat_map(|(values, _)| values.iter().map(|value| value.is_finite()));
            for (row, given) in given.enumerate() {
                for slope in columns.row_mut(row).iter_mut() {
                    *slope = if given { bounded_slope(*slope) } else { 0.0 };
                }
            }
            information += columns.tr_mul(&columns);
        }
        for (place, (free, value)) in self.free.iter().zip(&self.values).enumerate() {
            information[(place, place)] += free.departure_slope(*value).powi(2);
        }
        self.information = information;
        self
    }
}

impl Predicted {
    fn of(open: &Open, sensors: &Sensors, inputs: &PlantInputs, own: &PlantTrajectory) -> Self {
        let here = weighed(sensors, own);
        let readings = own.readings.clone();
        let columns = slopes(open, sensors, inputs, &here);
        let count = columns.ncols();
        let mut before = DMatrix::zeros(count, count);
        if open.information.nrows() == count {
            before += &open.information;
        }
        for i in 0..count {
            before[(i, i)] += 1e-9 * before[(i, i)] + 1e-6;
        }
        let bounded = columns.map(bounded_slope);
        let after = bounded.tr_mul(&bounded) + &before;
        let gained = gain(&before, &after, &open.of_effects);
        Self {
            readings,
            here,
            columns,
            before,
            gained,
        }
    }

    /// D2 of two explanations. Large differences count less, with their derivatives: what a number explains of them it explains still.
    fn apart(&self, other: &Self) -> f64 {
        let stride = self.here.len().div_ceil(COMPARED).max(1);
        let rows: Vec<usize> = (0..self.here.len()).step_by(stride).collect();
        let (difference, shares): (Vec<f64>, Vec<f64>) = (rows.iter())
            .map(|row| bounded(other.here[*row] - self.here[*row]))
            .unzip();
        let [own, others] = [&self.before, &other.before].map(DMatrix::nrows);
        let columns = DMatrix::from_fn(rows.len(), own + others, |row, column| {
            let slope = match column < own {
                true => self.columns[(rows[row], column)],
                false => -other.columns[(rows[row], column - own)],
            };
            shares[row] * slope
        });
        let mut known = DMatrix::zeros(own + others, own + others);
        known.view_mut((0, 0), (own, own)).copy_from(&self.before);
        known
            .view_mut((own, own), (others, others))
            .copy_from(&other.before);
        let by = stride as f64;
        let difference = DVector::from_vec(difference);
        let slope = columns.tr_mul(&difference) * by;
        let after = (columns.tr_mul(&columns) * by + &known).cholesky();
        let Some(moved) = after.map(|after| after.solve(&slope)) else {
            return by * difference.norm_squared();
        };
        let explained = &columns * &moved;
        let left = (difference.iter().zip(explained.iter()))
            .map(|(difference, own)| ((difference - own).abs() - CURVED * own.abs()).max(0.0));
        by * squares(left) + (&known * &moved).dot(&moved)
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

/// Information on which explanation is right, of odds now and then [nat].
fn on_which(open: &[Open], odds: &[Vec<f64>]) -> f64 {
    let now = shares_of(open);
    let then: f64 = (now.iter().zip(odds))
        .map(|(p, odds)| p * entropy(odds))
        .sum();
    (entropy(&now) - then).max(0.0)
}

/// What inputs make each explanation read.
pub struct Outlook<'a> {
    open: &'a [Open],
    /// Change of the readings by each explanation's effects, counted as differences are: the square of it [1].
    explained: Vec<f64>,
    sensors: &'a Sensors,
    inputs: &'a PlantInputs,
    trajectories: Vec<PlantTrajectory>,
}

impl<'a> Outlook<'a> {
    /// One simulation of each explanation.
    #[must_use]
    pub fn of(open: &'a [Open], sensors: &'a Sensors, inputs: &'a PlantInputs) -> Self {
        let trajectories: Vec<PlantTrajectory> = open
            .par_iter()
            .map(|own| simulate(&own.plant, inputs))
            .collect();
        let without = simulate(&sensors.without, inputs);
        let without = weighed(sensors, &without);
        let explained = trajectories.iter().map(|own| {
            let own = weighed(sensors, own);
            let pairs = own.iter().zip(&without);
            squares(pairs.map(|(own, without)| bounded(own - without).0))
        });
        Self {
            open,
            explained: explained.collect(),
            sensors,
            inputs,
            trajectories,
        }
    }

    /// What the likeliest explanation gives.
    #[must_use]
    pub fn likeliest(&self) -> &Trajectory {
        &self.trajectories[0].truth
    }

    /// Largest sensitivity of the motion over the explanations, as [`sensitivity`] has it [1].
    #[must_use]
    pub fn sensitivity(&self) -> f64 {
        let own = self.open.par_iter().zip(&self.trajectories);
        let of = own.map(|(open, own)| sensitivity(&open.plant, self.inputs, &own.truth.stroke));
        of.reduce(|| 0.0, f64::max)
    }

    /// Information on which explanation is right if none could be fitted anew [nat]: no less than there is.
    #[must_use]
    pub fn most_on_which(&self) -> f64 {
        let all = self.trajectories.iter();
        let own = all.map(|own| weighed(self.sensors, own));
        let own: Vec<Vec<f64>> = own.collect();
        let missed = |model: usize, truth: usize| {
            let pairs = own[truth].iter().zip(&own[model]);
            squares(pairs.map(|(truth, own)| bounded(truth - own).0))
        };
        on_which(self.open, &self.odds_after(missed))
    }

    /// Odds afterwards were each explanation the truth, by D2 of a model and a truth; never below what the idealisation of laws may come to.
    fn odds_after(&self, apart: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
        let of = |truth: usize| -> Vec<f64> {
            let idealised = IMMATERIAL * self.explained[truth];
            let odds = |(model, own): (usize, &Open)| {
                let apart = apart(model, truth);
                let least = match idealised > 0.0 && model != truth {
                    true => idealised / (apart + idealised),
                    false => 0.0,
                };
                own.probability * (-0.5 * COUNTED * apart).exp().max(least)
            };
            let odds: Vec<f64> = self.open.iter().enumerate().map(odds).collect();
            let sum: f64 = odds.iter().sum();
            odds.iter().map(|own| own / sum).collect()
        };
        (0..self.open.len()).map(of).collect()
    }

    /// What is expected of these inputs.
    #[must_use]
    pub fn expected(&self) -> Expected {
        let Self {
            open,
            sensors,
            inputs,
            trajectories,
            ..
        } = self;
        let predicted: Vec<Predicted> = (open.par_iter().zip(trajectories))
            .map(|(own, trajectory)| Predicted::of(own, sensors, inputs, trajectory))
            .collect();
        let pairs: Vec<[usize; 2]> = (1..open.len())
            .flat_map(|other| (0..other).map(move |one| [one, other]))
            .collect();
        let apart: Vec<f64> = (pairs.par_iter())
            .map(|[one, other]| predicted[*one].apart(&predicted[*other]))
            .collect();
        let odds = self.odds_after(|model, truth| {
            let pair = [model.min(truth), model.max(truth)];
            let place = pairs.iter().position(|known| *known == pair);
            place.map_or(0.0, |place| apart[place])
        });
        let how_much = (shares_of(open).iter().zip(&predicted))
            .map(|(p, own)| p * own.gained)
            .sum();
        Expected {
            which: on_which(open, &odds),
            how_much,
            odds,
            readings: predicted.into_iter().map(|own| own.readings).collect(),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::diagnosis::fit::free::Prior;
    use crate::diagnosis::test_evidence::{evidence, plant};
    use crate::effects::Coordinate;
    use crate::plant::registry;

    pub(in super::super) fn sensors() -> Sensors {
        Sensors {
            without: plant(),
            noise: [400.0, 2e-5, 0.8, 0.15],
            variance: [1.0; 4],
            probe: None,
        }
    }

    fn expected(open: &[Open], sensors: &Sensors, inputs: &PlantInputs) -> Expected {
        Outlook::of(open, sensors, inputs).expected()
    }

    pub(in super::super) fn open(name: &str, plant: PlantParameters, probability: f64) -> Open {
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

    pub(in super::super) fn inputs() -> PlantInputs {
        evidence(1).recordings.swap_remove(0).inputs
    }

    #[test]
    fn what_is_alike_stays_open_and_what_is_not_is_settled() {
        let mut other = plant();
        other.sensors.force_gain = 1.2;
        let pair = |second: &PlantParameters| {
            let all = [open("a", plant(), 0.6), open("b", second.clone(), 0.3)];
            expected(&all, &sensors(), &inputs())
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
        // Even the idealisation of a law leaves a thousandth of what it changes: M / (D2 + M), all of D2 and M being the change of the gain.
        let floor = IMMATERIAL / (1.0 + IMMATERIAL);
        // The first explanation changes nothing, and so is held to all of D2.
        let right = 1.0 / (1.0 + 2.0 * floor);
        let closed = whole - odds_left(right) / 3.0;
        assert!(
            (apart.which - closed).abs() < 1e-6,
            "{} {closed}",
            apart.which
        );
        assert!((apart.odds[1][1] - right).abs() < 1e-6, "{:?}", apart.odds);
    }

    /// Entropy of two odds.
    fn odds_left(right: f64) -> f64 {
        entropy(&[right, 1.0 - right])
    }

    /// Another gain is what a free gain comes to: nothing is missed, unless the recordings at hand know it.
    #[test]
    fn what_a_free_number_could_do_as_well_does_not_separate() {
        let mut other = plant();
        other.sensors.force_gain = 1.01;
        let truth = open("b", other, 0.5);
        let which = |known: f64| {
            let all = [with_gain(open("a", plant(), 0.5), known), truth.clone()];
            let found = expected(&all, &sensors(), &inputs());
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
        let found = expected(std::slice::from_ref(&own), &sensors(), &inputs());
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
