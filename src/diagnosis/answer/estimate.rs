//! Certainty of the numbers of an explanation.
//!
//! The posterior is taken normal in the fit's coordinates (`crate::diagnosis::fit::covariance`). A number of several quantities, such as an amplitude, takes its spread
//! along its gradient.
//!
//! Two things no residual tells are added. A law of the catalogue describes a real part to a hundredth of its own effect, no better (two standard
//! deviations; friction, orifices and lines are known to that at best: Armstrong-Helouvry et al. 1994, ISO 6358). And a sampled recording does not show
//! where between two samples a command was taken: a delay or a time constant of what follows one is uncertain by half a sample either way, evenly. A load cell
//! follows a force that is simulated between the samples too.

use crate::diagnosis::fit::Fit;
use crate::diagnosis::fit::covariance::covariance;
use crate::diagnosis::fit::free::{Free, Prior};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::diagnosis::search::ranking::Ranked;
use crate::effects::{Coordinate, Effect, Parameter};
use crate::plant::{Latent, PlantParameters, registry};
use crate::stats::{NORMAL_95, median_step};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Standard deviation of what a law leaves out, as a share of its own effect [1].
const IDEALISATION_OF_NUMBERS: f64 = 0.005;
/// Standard deviations to either side in a 95 % interval [1].
const INTERVAL: f64 = NORMAL_95;

/// Share of a range, in the fit's coordinate, within which a number stands at its end [1]: a prior keeps a tolerated one a little short of it.
const AT_LIMIT: f64 = 0.01;

/// A number with its 95 % interval, in the unit that its name ends with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// End of its range at which the value stands, if it does: the recordings ask for more than it may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_limit: Option<Limit>,
    /// Value without the effect; none where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub without: Option<f64>,
}

impl Estimate {
    /// A value with its interval, between the ends of its range.
    #[must_use]
    pub const fn new(value: f64, low: f64, high: f64) -> Self {
        Self {
            value,
            low,
            high,
            at_limit: None,
            without: None,
        }
    }
}

/// An end of a number's range: of its tolerance, or of what an effect's number may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// The least value.
    Lower,
    /// The largest value.
    Upper,
}

impl Limit {
    /// The end of a quantity's range at which a value stands.
    #[must_use]
    pub fn of(free: &Free, value: f64) -> Option<Self> {
        let at = |value: f64| free.coordinate.of(value);
        let [low, high] = free.bounds.map(at);
        // Of a range without an end in the fit's coordinate, such as a logarithm's down to 0, nothing is near but the end itself.
        let near = Some(AT_LIMIT * (high - low)).filter(|near| near.is_finite());
        let is_at = |end: f64, bound: f64| {
            value == bound || near.is_some_and(|near| (at(value) - end).abs() < near)
        };
        if is_at(low, free.bounds[0]) {
            Some(Self::Lower)
        } else {
            is_at(high, free.bounds[1]).then_some(Self::Upper)
        }
    }
}

impl Limit {
    /// The end of a quantity's range at which a value stands for the recordings ask for more. One without a prior that its interval keeps from the end stands
    /// between the ends, however wide the range; and where the end is the value without the effect there is no more to ask for.
    fn asked_for(
        free: &Free,
        value: f64,
        interval: [f64; 2],
        without: Option<f64>,
    ) -> Option<Self> {
        let [low, high] = free.bounds;
        let asks = |limit: &Self| match (free.prior, limit) {
            (Prior::Flat, Self::Lower) => interval[0] <= low && without != Some(low),
            (Prior::Flat, Self::Upper) => interval[1] >= high && without != Some(high),
            _ => true,
        };
        Self::of(free, value).filter(asks)
    }
}

/// A number with its 95 % interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// Name with its unit.
    pub name: &'static str,
    /// Value.
    pub value: f64,
    /// Interval.
    pub interval: [f64; 2],
    /// End of its range at which it stands; none where it stands between them.
    pub at_limit: Option<Limit>,
    /// Value without the effect that it is of; none where there is none.
    pub without: Option<f64>,
    /// Whether it is a part of the answer.
    pub reported: bool,
}

impl From<&Number> for Estimate {
    fn from(number: &Number) -> Self {
        let [low, high] = number.interval;
        Self {
            at_limit: number.at_limit,
            without: number.without,
            ..Self::new(number.value, low, high)
        }
    }
}

/// Numbers of an explanation.
#[derive(Debug, Clone)]
pub struct Estimates {
    /// Tolerated quantities that are still held, in the order of the fit.
    pub tolerated: Vec<Number>,
    /// Numbers of each effect.
    pub effects: Vec<(&'static Effect, Vec<Number>)>,
    /// Constants of the formula of a model discrepancy; empty where it is none.
    pub formula: Vec<Number>,
    /// Covariance of all that is free, in the fit's coordinates.
    pub covariance: DMatrix<f64>,
}

/// Standard deviation of what is not in the residuals, in a quantity's unit.
fn allowance(nominal: &PlantParameters, free: &Free, value: f64, sample: f64) -> f64 {
    // A frequency is determined by its phase, whatever the law.
    if free.quantity.name == "frequency_hz" {
        return 0.0;
    }
    let before = free.quantity.get(nominal);
    let own = value - if before.is_finite() { before } else { 0.0 };
    let of_load_cell =
        [&registry::FORCE_LAG, &registry::FORCE_DELAY].map(registry::Number::quantity);
    let of_load_cell = of_load_cell.iter().any(|own| own.is(&free.quantity));
    let late = ["delay_s", "offset_s", "time_constant_s"].contains(&free.quantity.name);
    let between = match late && !of_load_cell {
        true => sample / 12f64.sqrt(),
        false => 0.0,
    };
    (IDEALISATION_OF_NUMBERS * own).hypot(between)
}

/// The median distance of samples [s] of the slowest recording.
fn longest_sample(evidence: &Evidence) -> f64 {
    let recordings = evidence.recordings.iter();
    let medians = recordings.map(|measured| median_step(&measured.inputs.time));
    medians.fold(0.0, f64::max)
}

/// Widens a covariance to variances that are larger than its own, its correlations kept.
fn at_least(covariance: &mut DMatrix<f64>, variances: &[f64]) {
    let own = covariance.diagonal();
    let stretch = |i: usize| {
        (variances[i] / own[i].max(f64::MIN_POSITIVE))
            .max(1.0)
            .sqrt()
    };
    for i in 0..own.len() {
        for j in 0..own.len() {
            covariance[(i, j)] *= stretch(i) * stretch(j);
        }
    }
}

/// Variance of what a channel of its own has determined, in the fit's coordinates; 0 of the others.
fn settled(fit: &Fit) -> Vec<f64> {
    let of = |(free, value): (&Free, &f64)| match free.prior {
        Prior::Settled { .. } => free.departure_slope(*value).powi(-2),
        _ => 0.0,
    };
    fit.free.iter().zip(&fit.values).map(of).collect()
}

/// Variance of each free quantity of the first explanation over those that have it too, weighed by their probabilities, in the fit's coordinates
/// (Bayesian model averaging: Hoeting et al., Stat. Sci. 14, 1999). A number that an effect has beyond its tolerance is another than the tolerated one: where a
/// look-alike stands in the effect's place, that says nothing of it.
fn between_models(nominal: &PlantParameters, ranked: &[Ranked]) -> Vec<f64> {
    let best = &ranked[0].hypothesis.fit;
    let first = ranked[0].hypothesis.tolerated(nominal);
    let of = |(index, free): (usize, &Free)| {
        let here = free.coordinate.of(best.values[index]);
        let (mut squares, mut sum) = (0.0, 0.0);
        for other in ranked {
            let fit = &other.hypothesis.fit;
            // A constant of another formula is another number.
            let other_term = last_of_term(&ranked[0].hypothesis, index)
                && ranked[0].hypothesis.formula() != other.hypothesis.formula();
            if other_term {
                continue;
            }
            let same = |f: &Free| f.quantity.is(&free.quantity);
            let of_effect = |place: &usize| *place >= other.hypothesis.tolerated(nominal);
            let place = fit.free.iter().position(same);
            if let Some(place) = place.filter(|place| (index >= first) == of_effect(place)) {
                squares +=
                    other.probability * (free.coordinate.of(fit.values[place]) - here).powi(2);
                sum += other.probability;
            }
        }
        squares / f64::max(sum, f64::MIN_POSITIVE)
    };
    best.free.iter().enumerate().map(of).collect()
}

/// Whether a free quantity is one of the model discrepancy, which come last.
fn last_of_term(hypothesis: &Hypothesis, index: usize) -> bool {
    let own = hypothesis.unlisted().map_or(0, Latent::numbers);
    index + own >= hypothesis.fit.free.len()
}

/// Places of the numbers of each effect that does nothing where its numbers are those of the nominal model. Of friction with no Coulomb force the viscous coefficient alone may
/// be 0: that does not take the friction away.
fn vanishing(nominal: &PlantParameters, hypothesis: &Hypothesis) -> Vec<Range<usize>> {
    let effects = hypothesis.effects.iter().enumerate();
    let vanishing = effects.filter(|(_, effect)| vanishes(nominal, effect));
    let places = vanishing.map(|(index, _)| hypothesis.numbers_of(nominal, index));
    places.collect()
}

/// Whether an effect does nothing where its numbers are those of the nominal model, which they may be.
fn vanishes(nominal: &PlantParameters, effect: &Effect) -> bool {
    let mut plant = nominal.clone();
    let may_be = |parameter: &Parameter| {
        let value = parameter.quantity.get(nominal);
        parameter.quantity.set(&mut plant, value);
        (parameter.bounds[0]..=parameter.bounds[1]).contains(&value)
    };
    effect.parameters(nominal).iter().all(may_be) && plant == *nominal
}

/// Numbers and intervals of the first of the explanations.
pub fn estimates(nominal: &PlantParameters, ranked: &[Ranked], evidence: &Evidence) -> Estimates {
    let hypothesis = &ranked[0].hypothesis;
    let fit = &hypothesis.fit;
    let mut covariance = covariance(evidence, fit);
    if let Some(left) = &ranked[0].left_out {
        at_least(&mut covariance, &left.jackknife(&fit.free));
    }
    at_least(&mut covariance, &settled(fit));
    let first = hypothesis.tolerated(nominal);
    for (index, between) in between_models(nominal, ranked).into_iter().enumerate() {
        covariance[(index, index)] += between;
    }
    let sample = longest_sample(evidence);
    for (index, free) in fit.free.iter().enumerate().skip(first) {
        let slope = free.coordinate.slope(fit.values[index]);
        let allowed = allowance(nominal, free, fit.values[index], sample);
        covariance[(index, index)] += (allowed / slope).powi(2);
    }
    let vanishing = vanishing(nominal, hypothesis);
    let vanishes = |index: usize| vanishing.iter().any(|own| own.contains(&index));
    let number = |index: usize, reported: bool| {
        let free = &fit.free[index];
        let deviation = covariance[(index, index)].max(0.0).sqrt();
        let at = free.coordinate.of(fit.values[index]);
        let ends =
            [-INTERVAL, INTERVAL].map(|z| free.clamp(free.coordinate.value(at + z * deviation)));
        let interval = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let without = Some(free.quantity.get(nominal)).filter(|_| vanishes(index));
        Number {
            name: free.quantity.name,
            value: fit.values[index],
            at_limit: Limit::asked_for(free, fit.values[index], interval, without),
            interval,
            without,
            reported,
        }
    };
    let numbers: Vec<usize> = hypothesis
        .effects
        .iter()
        .map(|effect| effect.parameters(nominal).len())
        .collect();
    let mut at = first;
    let tolerated = (0..at).map(|index| number(index, false)).collect();
    let mut effects = Vec::new();
    for (effect, own) in hypothesis.effects.iter().zip(numbers) {
        let parameters = effect.parameters(nominal);
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
    let term = hypothesis
        .unlisted()
        .filter(|term| term.formula().is_some());
    let constants = term.map_or(0, Latent::numbers);
    let last = fit.free.len();
    Estimates {
        tolerated,
        effects,
        formula: (last - constants..last)
            .map(|index| number(index, true))
            .collect(),
        covariance,
    }
}

/// Zero to peak of a sine and a cosine.
fn amplitude(
    free: &[crate::diagnosis::fit::free::Free],
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
        at_limit: None,
        without: Some(0.0),
        reported: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::free::Prior;
    use crate::diagnosis::fit::hypothesis::Hypothesis;
    use crate::diagnosis::recordings::input::tolerated;
    use crate::diagnosis::test_evidence::{fit, plant};
    use crate::effects::{NUMBERS_OFF, every};
    use crate::plant::registry;

    #[test]
    fn a_covariance_is_widened_where_it_is_too_narrow_and_keeps_its_correlation() {
        let mut covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 1.0]);
        at_least(&mut covariance, &[1.0, 9.0]);
        assert_eq!(
            covariance,
            DMatrix::from_row_slice(2, 2, &[4.0, 3.0, 3.0, 9.0])
        );
    }

    /// A device with 2.3 N of friction and a Stribeck velocity that may have been the default of a seal without friction was stated at 50 %, for the interval of that
    /// velocity held "its value without the effect".
    #[test]
    fn a_number_that_cannot_take_its_effect_away_has_no_value_without_it() {
        let all = [
            ("coulomb_viscous_friction", false),
            ("stribeck_friction", false),
            ("end_cushioning", false),
            ("supply_droop", false),
            ("moving_mass_error", true),
            ("axial_force_offset", true),
            ("force_sensor_bias_drift", true),
        ];
        for (name, expected) in all {
            let effect = every().find(|effect| effect.name == name).unwrap();
            assert_eq!(vanishes(&plant(), effect), expected, "{name}");
        }
    }

    /// 7 to 3 between 1 and 3: 0.3 times the square of their difference. One without the number says nothing of it.
    #[test]
    fn models_that_are_nearly_as_good_widen_an_interval_by_their_probability() {
        let ranked = |value: f64, probability: f64| Ranked {
            hypothesis: Hypothesis {
                effects: Vec::new(),
                fit: fit(Vec::new(), Vec::new(), value),
                depends_on: Vec::new(),
            },
            score: 0.0,
            odds: 1.0,
            probability,
            left_out: None,
        };
        let alone = [ranked(1.0, 1.0)];
        assert_eq!(between_models(&plant(), &alone), [0.0]);
        let mut other = ranked(0.0, 0.5);
        other.hypothesis.fit.free.clear();
        let three = [ranked(1.0, 0.35), ranked(3.0, 0.15), other];
        assert!((between_models(&plant(), &three)[0] - 0.3 * 4.0).abs() < 1e-12);
        // A bore 4 % off, and in its place a gain with the bore within its tolerance: the interval of a real piston held the nominal bore so.
        let bore = NUMBERS_OFF[0].parameters(&plant())[0].quantity;
        let gain = every().find(|e| e.name == "force_sensor_gain_error");
        let of = |value, effect: &'static Effect, tolerated: usize| {
            let mut ranked = ranked(value, 0.5);
            ranked.hypothesis.effects = vec![effect];
            let own = ranked.hypothesis.fit.free[0];
            let free = vec![
                Free {
                    quantity: bore,
                    ..own
                };
                1 + tolerated
            ];
            ranked.hypothesis.fit.free = free;
            ranked.hypothesis.fit.values = vec![value; 1 + tolerated];
            ranked
        };
        let alike = [of(0.026, &NUMBERS_OFF[0], 0), of(0.025, gain.unwrap(), 1)];
        assert_eq!(between_models(&plant(), &alike), [0.0]);
    }

    #[test]
    fn a_number_at_the_end_of_its_range_is_distinguished_from_one_between() {
        // 5 kg to 10 %: a parameter once stood at its tolerance's limit without a word.
        let mass = tolerated(registry::MOVING_MASS.quantity(), 5.0, 0.1);
        let at = |value: f64| Limit::of(&mass, value);
        assert_eq!([at(4.5), at(5.5)], [Some(Limit::Lower), Some(Limit::Upper)]);
        // A prior keeps it a little short of the end.
        assert_eq!(at(5.495), Some(Limit::Upper));
        assert_eq!([at(5.48), at(5.0), at(4.52)], [None; 3]);
        // Of a logarithm down to nothing the end itself counts alone.
        let wide = Free {
            coordinate: Coordinate::Logarithmic,
            bounds: [0.0, 100.0],
            prior: Prior::Flat,
            ..mass
        };
        assert_eq!(Limit::of(&wide, 1e-9), None);
        assert_eq!(Limit::of(&wide, 0.0), Some(Limit::Lower));
    }
}
