//! A model discrepancy as a formula: port x form x variables. Curves fitted at the ports point at it; each candidate is then fitted inside the simulator
//! as any effect is.
//!
//! ```text
//! promised = rough cost of the curve + D(form) + n ln N
//! ```
//!
//! D what the form costs more than the curve by the quadratic model of its fit (`src/diagnosis/formula/matching.rs`), n constants, N samples.

mod candidate;
mod grammar;
pub mod latent;
mod matching;
pub mod reach;
pub mod unlisted;

use crate::stats::median;
use rayon::prelude::*;

use self::candidate::{Candidate, modulated};
use self::grammar::{FORMS, WAVE};
use self::matching::CurveModel;
use super::fit::free::Free;
use super::fit::hypothesis::Hypothesis;
use super::fit::{FULL, Fit, Limit, ROUGH, Refit, Stage, Start, fit};
use super::search::Search;
use super::search::progress::{Observer, Step};
use super::search::scale::Scale;
use crate::effects::Coordinate;
use crate::plant::{Basis, Latent, Moment, Port, Variable};

/// Formulas that are fitted roughly, of those that promise most, and of one curve at most.
const FITTED: usize = 12;
const OF_ONE_CURVE: usize = 4;
/// Cost over the least that is promised from which a formula is not fitted [1]: promises are wrong by half where a law is bent.
const UNPROMISING: f64 = 3.0;
/// Polynomials among those of one curve, at least.
const POLYNOMIALS: usize = 2;
/// Iterations of that.
const ROUGH_ITERATIONS: usize = 8;
/// Iterations of a first look at a product with another variable.
const LOOK: usize = 3;
/// Formulas that products are tried of.
const MULTIPLIED: usize = 2;
/// Formulas that are fitted in full.
const IN_FULL: usize = 3;
/// Rough cost over that of the best beyond which a formula is not fitted in full [1].
const FAR: f64 = 1.15;
/// Cost over that of noise alone from which a full fit stands in a minimum that no width leads out of [1].
const HOPELESS: f64 = 2.0;
/// Factor by which a width is tried wider [1].
const WIDER: f64 = 8.0;
/// Iterations of the full fit.
const FULL_ITERATIONS: usize = 30;

/// A formula that a curve points at.
struct Promising {
    /// Cost that it promises [1].
    promised: f64,
    /// Whether it is in proportion to all of its constants.
    is_polynomial: bool,
    candidate: Candidate,
}

fn going_on(stages: &[Stage], iterations: usize) -> Refit<'_> {
    Refit {
        start: Start::Here,
        stages,
        limit: Limit::of(iterations),
    }
}

impl Search<'_> {
    /// Formulas that do what curves point at, fitted in full, the best first; `base` is what the curves stand beside.
    pub(super) fn formulas(
        &self,
        base: &Hypothesis,
        curves: &[Hypothesis],
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let noise = self.left_alone(scale);
        let promising = self.most_promising(curves);
        let mut fitted: Vec<Hypothesis> = promising
            .par_iter()
            .map(|(_, curve, candidate)| {
                let here = &curve.fit.prediction.plant;
                let beside: Vec<Free> =
                    (base.fit.free.iter().map(|f| f.from_where(here))).collect();
                let fitted = self.with_formula(base, &beside, candidate, ROUGH_ITERATIONS);
                fitted.without_columns()
            })
            .collect();
        for ((promised, ..), hypothesis) in promising.iter().zip(&fitted) {
            let detail = format!(
                "{} promised {promised:.0}, {:.0}",
                text(hypothesis),
                self.latent_score(hypothesis)
            );
            observer(&Step::Variation.of(hypothesis, detail));
        }
        self.sort_by_cost(&mut fitted);
        if self.is_spent() {
            fitted.truncate(1);
        }
        let unexplained = |h: &&mut Hypothesis| h.fit.rough > noise;
        for leading in fitted.iter_mut().take(IN_FULL).filter(unexplained) {
            if self.is_spent() {
                break;
            }
            self.widen(leading, (ROUGH, ROUGH_ITERATIONS), |fit| fit.rough);
        }
        self.sort_by_cost(&mut fitted);
        if fitted.first().is_some_and(|best| best.fit.rough > noise) && !self.is_spent() {
            self.add_products(base, &mut fitted, observer);
        }
        let Some(best) = fitted.first() else {
            return fitted;
        };
        // One that jumps may score below noise where the piston is held, and fail in full.
        let near = FAR * self.latent_score(best).max(noise);
        let mut full: Vec<Hypothesis> = Vec::new();
        for h in fitted.iter().take(IN_FULL) {
            if self.latent_score(h) < near && (full.is_empty() || !self.is_spent()) {
                full.push(self.formula_in_full(h, &full));
            }
        }
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        let hopeless = HOPELESS * self.evidence.count() as f64;
        if let Some(best) = full.first_mut()
            && best.fit.cost() < hopeless
            && !self.is_spent()
            && !scale.is_adequate(best)
        {
            self.widen(best, (FULL, FULL_ITERATIONS), Fit::cost);
        }
        for h in &full {
            let detail = format!("{} in full {:.1}", text(h), self.score(h));
            observer(&Step::Variation.of(h, detail));
        }
        full
    }

    /// Formulas that promise most over the variables of some curves, with the curve that points at each.
    fn most_promising<'h>(
        &self,
        curves: &'h [Hypothesis],
    ) -> Vec<(f64, &'h Hypothesis, Candidate)> {
        let mut promising: Vec<(f64, &'h Hypothesis, Candidate)> = Vec::new();
        for curve in curves {
            let mut own = self.matches(curve);
            own.sort_by(|a, b| a.promised.total_cmp(&b.promised));
            // Polynomials beside them: a form with thresholds may bend to what a curve is wrong by.
            let mut polynomials = 0;
            let mut place = 0;
            own.retain(|one| {
                place += 1;
                polynomials += usize::from(one.is_polynomial);
                place <= OF_ONE_CURVE || (one.is_polynomial && polynomials <= POLYNOMIALS)
            });
            let own = own.into_iter();
            promising.extend(own.map(|one| (one.promised, curve, one.candidate)));
        }
        promising.sort_by(|a, b| a.0.total_cmp(&b.0));
        promising.truncate(FITTED);
        let least = promising.first().map_or(0.0, |(promised, ..)| *promised);
        promising.retain(|(promised, ..)| *promised <= UNPROMISING * least);
        promising
    }

    /// A formula fitted in full; one that is hopelessly behind others before the finest measure is left there.
    fn formula_in_full(&self, rough: &Hypothesis, others: &[Hypothesis]) -> Hypothesis {
        let (coarse, finest) = FULL.split_at(FULL.len() - 1);
        let fitted = self.refit(rough, going_on(coarse, FULL_ITERATIONS));
        let best = (others.iter().map(|h| self.score(h))).fold(f64::INFINITY, f64::min);
        match self.score(&fitted) < best + self.settings.given_up {
            true => self.refit(&fitted, going_on(finest, FULL_ITERATIONS)),
            false => fitted,
        }
    }

    /// Formulas over the variable of a curve, with what each promises.
    fn matches(&self, curve: &Hypothesis) -> Vec<Promising> {
        let Some(latent) = curve.unlisted() else {
            return Vec::new();
        };
        let samples = (self.evidence.count() as f64).ln();
        let promised = |candidate: &Candidate, cost: f64| {
            curve.fit.rough + cost + candidate.count() as f64 * samples
        };
        let typical = self.typical(curve, latent);
        let seals = &curve.fit.prediction.plant.device.seal_friction;
        let bristles = latent.port == Port::Friction && !seals.is_dry();
        match latent.basis {
            Basis::Waves { frequency } => {
                let [sine, cosine] = [latent.coefficients[0], latent.coefficients[1]];
                let constants = [sine.hypot(cosine), frequency, cosine.atan2(sine)];
                let candidate = Candidate::new(&WAVE, (latent, bristles), typical, &constants);
                vec![Promising {
                    promised: promised(&candidate, 0.0),
                    is_polynomial: false,
                    candidate,
                }]
            }
            Basis::Hats { ends } => {
                let Some(model) = CurveModel::of(&curve.fit, latent) else {
                    return Vec::new();
                };
                let makes_sense =
                    |form: &&grammar::Form| form.makes_sense(latent.port, latent.variable, ends);
                FORMS
                    .par_iter()
                    .filter(makes_sense)
                    .filter_map(|form| {
                        let text = Candidate::new(form, (latent, bristles), typical, &[]);
                        let moment = |at: f64| typical.with(latent.variable, at);
                        let best = model.best(form, text.law(), moment)?;
                        let candidate =
                            Candidate::new(form, (latent, bristles), typical, &best.constants);
                        Some(Promising {
                            promised: promised(&candidate, best.cost),
                            is_polynomial: form.constants.iter().all(|(_, r)| r.is_linear()),
                            candidate,
                        })
                    })
                    .collect()
            }
            Basis::Formula(_) => Vec::new(),
        }
    }

    /// The median of each variable over the recordings; of what acts with the motion, at a speed that is clear.
    fn typical(&self, hypothesis: &Hypothesis, latent: &Latent) -> Moment {
        let trajectories = &hypothesis.fit.prediction.trajectories;
        let mut typical = Moment::default();
        for variable in Variable::ALL {
            let mut values: Vec<f64> = Vec::new();
            for (measured, trajectory) in self.evidence.recordings.iter().zip(trajectories) {
                let count = measured.inputs.time.len();
                let of = |i| trajectory.truth.moment(&measured.inputs, i).of(variable);
                values.extend((0..count).map(of).filter(|value: &f64| value.is_finite()));
            }
            if variable != Variable::PressureDifference
                && let Some(median) = median(values)
            {
                typical = typical.with(variable, median);
            }
        }
        typical.pressures[1] = typical.pressures[1].max(1e5);
        typical.speed = if latent.directed { CLEAR } else { 0.0 };
        typical
    }

    /// Largest size of a variable in the recordings.
    fn largest(&self, hypothesis: &Hypothesis, variable: Variable) -> f64 {
        let trajectories = &hypothesis.fit.prediction.trajectories;
        let mut largest = 0.0f64;
        for (measured, trajectory) in self.evidence.recordings.iter().zip(trajectories) {
            for i in 0..measured.inputs.time.len() {
                let value = trajectory.truth.moment(&measured.inputs, i).of(variable);
                if value.is_finite() {
                    largest = largest.max(value.abs());
                }
            }
        }
        largest
    }

    /// A hypothesis with a formula beside it, fitted roughly.
    fn with_formula(
        &self,
        base: &Hypothesis,
        beside: &[Free],
        candidate: &Candidate,
        iterations: usize,
    ) -> Hypothesis {
        let mut plant = base.fit.prediction.plant.clone();
        plant.latent = Some(candidate.latent.clone());
        let mut free = beside.to_vec();
        free.extend(candidate.free.iter().copied());
        let fit = fit(
            self.evidence,
            (&plant, None),
            (&free, &[]),
            ROUGH,
            Limit::of(iterations),
        );
        Hypothesis {
            effects: base.effects.clone(),
            fit,
            depends_on: candidate.depends_on.clone(),
        }
    }

    /// Fits a formula again with each of its widths, limits and periods wider, and takes what fits better: a ramp that became a step does not find back.
    fn widen(
        &self,
        hypothesis: &mut Hypothesis,
        (stages, iterations): (&[Stage], usize),
        cost: impl Fn(&Fit) -> f64,
    ) {
        let fitted = &hypothesis.fit;
        let own = fitted.free.len() - hypothesis.unlisted().map_or(0, Latent::numbers);
        let tried = (own..fitted.free.len())
            .filter(|i| fitted.free[*i].coordinate == Coordinate::Logarithmic)
            .map(|i| {
                let mut free = fitted.free_from_here();
                free[i].start = (WIDER * free[i].start).min(free[i].bounds[1]);
                let from = (&fitted.prediction.plant, None);
                let limit = Limit::of(iterations);
                fit(self.evidence, from, (&free, &[]), stages, limit)
            })
            .min_by(|a, b| cost(a).total_cmp(&cost(b)));
        if let Some(wider) = tried
            && cost(&wider) < cost(fitted)
        {
            hypothesis.fit = wider;
        }
    }

    /// Adds products of the leading formulas with another variable, where these do better.
    fn add_products(
        &self,
        base: &Hypothesis,
        fitted: &mut Vec<Hypothesis>,
        observer: &mut Observer<'_>,
    ) {
        let mut products: Vec<(Hypothesis, Candidate)> = Vec::new();
        for leading in fitted.iter().take(MULTIPLIED) {
            let Some(candidate) = Candidate::of(leading) else {
                continue;
            };
            let largest = |variable| self.largest(leading, variable);
            products.extend(
                modulated(&candidate, largest)
                    .into_iter()
                    .map(|product| (leading.clone(), product)),
            );
        }
        let mut looked: Vec<Hypothesis> = products
            .par_iter()
            .map(|(leading, product)| {
                let here = &leading.fit.prediction.plant;
                let beside: Vec<Free> =
                    (base.fit.free.iter().map(|f| f.from_where(here))).collect();
                let fitted = self.with_formula(base, &beside, product, LOOK);
                fitted.without_columns()
            })
            .collect();
        self.sort_by_cost(&mut looked);
        looked.truncate(IN_FULL);
        let gone_on: Vec<Hypothesis> = looked
            .par_iter()
            .map(|h| {
                self.refit(h, going_on(ROUGH, ROUGH_ITERATIONS))
                    .without_columns()
            })
            .collect();
        for h in &gone_on {
            let detail = format!("{} {:.0}", text(h), self.latent_score(h));
            observer(&Step::Variation.of(h, detail));
        }
        fitted.extend(gone_on);
        self.sort_by_cost(fitted);
    }
}

/// Speed at which the direction of motion is clear [m/s].
const CLEAR: f64 = 0.1;

/// A hypothesis' formula as its text with port.
fn text(hypothesis: &Hypothesis) -> String {
    hypothesis.formula().map_or_else(String::new, |formula| {
        let law = &formula.law;
        format!("{} = {}", law.port.name(), law.expression.text())
    })
}
