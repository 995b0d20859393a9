//! Smallest effect of each kind that recordings would have shown, where none was found.
//!
//! ```text
//! |d|^2 - b^T H^-1 b >= (sqrt(P) + z)^2,   b = C^T d
//! ```
//!
//! d change of the residuals by the effect, C derivatives of the residuals by what a fit may move and H their information with priors: what is left of
//! the change after a fit without the effect. P penalty of the effect. The gain of a fit is a noncentral chi-square, whose root has a standard deviation of
//! one: z = 1.28 finds nine in ten. An effect that moves no channel by what is named is none (`Search::influence`).

use super::Search;
use super::influence::BELOW_NOISE;
use crate::diagnosis::fit::free::{Free, free_of};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::with_values;
use crate::diagnosis::recordings::evidence::{Prediction, by_channel, rms_by_channel};
use crate::effects::Effect;
use nalgebra::DVector;
use rayon::prelude::*;

/// Standard normal quantile of nine in ten [1].
const NINE_IN_TEN: f64 = 1.282;
/// Steps in size, at most.
const MOST_STEPS: usize = 5;
/// Share of a size to which it is found, and up to which one is reported [1].
const NEAR: [f64; 2] = [0.05, 0.3];
/// Standard deviations by which noise may hold an effect [1].
const CHANCE: f64 = 2.0;
/// Change of a residual that is none [1].
const UNCHANGED: f64 = 1e-6;
/// Largest and smallest size that is looked for, over the usual one [1].
const SIZES: [f64; 2] = [1e-4, 10.0];

/// An effect at the smallest size that recordings would have shown.
#[derive(Debug, Clone)]
pub struct Detectable {
    /// The effect.
    pub effect: &'static Effect,
    /// Its numbers at that size, an amplitude in the place of a sine and a cosine.
    pub numbers: Vec<DetectableNumber>,
}

/// A number of an effect at its smallest size.
#[derive(Debug, Clone, Copy)]
pub struct DetectableNumber {
    /// Name with its unit.
    pub name: &'static str,
    /// Value.
    pub value: f64,
    /// Value without the effect; none where there is none, or that is 0.
    pub without: Option<f64>,
}

/// Smallest effects that would have been named beside an explanation that names none; without those that these recordings show at no size, and without the rig
/// file's own numbers, which are no effects.
pub fn detectable(search: &Search<'_>, best: &Hypothesis) -> Vec<Detectable> {
    let effects = search.candidates.par_iter();
    effects
        .filter(|effect| effect.number_key().is_none())
        .filter_map(|effect| Change::of(search, best, effect)?.smallest())
        .collect()
}

/// An effect on its way from none to its usual size.
struct Change<'a> {
    search: &'a Search<'a>,
    best: &'a Hypothesis,
    effect: &'static Effect,
    free: Vec<Free>,
    /// Values without the effect; of what only shapes it, the usual one.
    absent: Vec<f64>,
    usual: Vec<f64>,
}

impl<'a> Change<'a> {
    /// None where no number of its own takes an effect away.
    fn of(search: &'a Search<'a>, best: &'a Hypothesis, effect: &'static Effect) -> Option<Self> {
        let plant = &best.fit.prediction.plant;
        let usual = effect.usual(plant);
        let free = free_of(effect, &search.nominal, &usual);
        let now: Vec<f64> = free.iter().map(|f| f.quantity.get(plant)).collect();
        let mut change = Self {
            search,
            best,
            effect,
            absent: usual.clone(),
            free,
            usual,
        };
        // A number that alone takes the effect away is its size; otherwise all that can be are.
        let finite: Vec<usize> = (0..now.len()).filter(|i| now[*i].is_finite()).collect();
        let switch = finite.iter().copied().find(|index| {
            let mut values = change.usual.clone();
            values[*index] = now[*index];
            values != change.usual && !change.at(&values).iter().any(|d| d.abs() > UNCHANGED)
        });
        let sizes = switch.map_or(finite, |index| vec![index]);
        for index in &sizes {
            change.absent[*index] = now[*index];
        }
        (change.absent != change.usual).then_some(change)
    }

    fn values(&self, share: f64) -> Vec<f64> {
        let pairs = self.absent.iter().zip(&self.usual);
        pairs
            .map(|(absent, usual)| absent + share * (usual - absent))
            .collect()
    }

    /// Change of the residuals where the effect has these values.
    fn at(&self, values: &[f64]) -> Vec<f64> {
        let here: &Prediction = &self.best.fit.prediction;
        let plant = with_values(&here.plant, &self.free, values);
        let there = self
            .search
            .evidence
            .predict(&plant, here.guided, Some(here));
        let pairs = there.residuals.iter().zip(&here.residuals);
        pairs.map(|(there, here)| there - here).collect()
    }

    /// Root of what a change leaves after a fit without the effect, over what it must be, and the same of the largest channel; the smaller one.
    fn seen(&self, change: &[f64]) -> f64 {
        let fit = &self.best.fit;
        let product = |one: &[f64], other: &[f64]| -> f64 {
            let products = one.iter().zip(other).map(|(a, b)| a * b);
            products.filter(|product| product.is_finite()).sum()
        };
        let along = DVector::from_iterator(
            fit.columns.len(),
            fit.columns.iter().map(|column| product(column, change)),
        );
        let explained = (fit.information.clone().cholesky())
            .filter(|_| fit.information.nrows() == fit.columns.len())
            .map_or(0.0, |h| along.dot(&h.solve(&along)));
        let gain = self.search.evidence.worth * (product(change, change) - explained).max(0.0);
        let numbers = self.free.len() as f64;
        let penalty = numbers * (self.search.evidence.count() as f64).ln()
            + self.search.settings.look_elsewhere;
        let sizes = rms_by_channel(self.search.evidence, change);
        let moved = sizes.into_iter().fold(0.0, f64::max) / BELOW_NOISE;
        moved.min(gain.sqrt() / (penalty.sqrt() + NINE_IN_TEN))
    }

    /// Multiple of a change that what is left holds of it in the recording that holds most, less two standard deviations of noise.
    fn held(&self, change: &[f64]) -> f64 {
        let mut sums = vec![[0.0; 2]; self.search.evidence.recordings.len()];
        let left = &self.best.fit.prediction.residuals;
        let mut at = 0;
        for (recording, _, own) in by_channel(self.search.evidence, change) {
            for (d, r) in own.iter().zip(&left[at..]) {
                if (d * r).is_finite() {
                    sums[recording][0] += d * r;
                    sums[recording][1] += d * d;
                }
            }
            at += own.len();
        }
        let held = |[product, square]: [f64; 2]| product.abs() / square - CHANCE / square.sqrt();
        let shown = sums.into_iter().filter(|[_, square]| *square > 0.0);
        shown.map(held).fold(0.0, f64::max)
    }

    fn smallest(&self) -> Option<Detectable> {
        let (mut share, mut seen) = (1.0, 0.0);
        for _ in 0..MOST_STEPS {
            seen = self.seen(&self.at(&self.values(share)));
            if !seen.is_finite() || seen <= 0.0 {
                return None;
            }
            if (seen - 1.0).abs() < NEAR[0] {
                break;
            }
            share = (share / seen).clamp(SIZES[0], SIZES[1]);
        }
        if (seen - 1.0).abs() > NEAR[1] {
            return None;
        }
        // What is left may hold more of it than noise would need to: then less than that has not shown.
        let values = self.values(share * self.held(&self.at(&self.values(share))).max(1.0));
        let mut bounds = self.free.iter().zip(&values);
        let within = bounds.all(|(free, value)| (free.bounds[0]..=free.bounds[1]).contains(value));
        if !within {
            return None;
        }
        Some(Detectable {
            effect: self.effect,
            numbers: self.numbers(&values),
        })
    }

    fn numbers(&self, values: &[f64]) -> Vec<DetectableNumber> {
        let plant = &self.best.fit.prediction.plant;
        let parameters = self.effect.parameters(&self.search.nominal);
        let place = |name: &str| parameters.iter().position(|p| p.quantity.name == name);
        let amplitude = place("sine_m").zip(place("cosine_m"));
        let amplitude = amplitude.map(|(sine, cosine)| DetectableNumber {
            name: "amplitude_m",
            value: values[sine].hypot(values[cosine]),
            without: None,
        });
        let sized = self
            .absent
            .iter()
            .zip(&self.usual)
            .map(|(absent, usual)| absent != usual);
        let all = parameters.iter().zip(values).zip(sized);
        let reported = all.filter(|((parameter, _), _)| parameter.reported);
        let own = reported.map(|((parameter, value), sized)| DetectableNumber {
            name: parameter.quantity.name,
            value: *value,
            without: Some(parameter.quantity.get(plant)).filter(|own| sized && *own != 0.0),
        });
        amplitude.into_iter().chain(own).collect()
    }
}
