//! A set of effects fitted to the recordings, and what each further one would gain.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::effect::{ArmEffect, Candidate};
use super::evidence::{Column, Evidence};
use super::extent::without;
use super::fit::{Columns, Fit, Parameter, fit, is_curved, products, residuals_of, weighed};
use super::input::ArmInput;
use super::quadratic::least_within;
use crate::recorded_arm::{ArmParameters, Quantity, Tolerated};

/// Length of bristles within which they are looked for, and what is known of it [rad].
const BRISTLES: ([f64; 2], [f64; 2]) = ([1e-6, 2e-3], [2e-4, 2e-4]);

/// Difference between the stamps of currents and positions that is no effect [s]: stamps are written to a millisecond.
const STAMPS: f64 = 5e-4;

/// Decrease of the cost by a law or ripple alone below which it is not looked at further [1].
const OF_NO_USE: f64 = 4.0;

/// Effects, fitted.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    /// The effects with their numbers.
    pub effects: Vec<Candidate>,
    /// The fit.
    pub fit: Fit,
}

/// Numbers that are moved whatever is missing.
#[must_use]
pub fn nuisances(input: &ArmInput) -> Vec<Parameter> {
    let known = input.tolerated.iter().map(Parameter::tolerated);
    let bristles = (0..input.nominal.joints()).map(|joint| Parameter {
        quantity: Quantity::BristleLength(joint),
        bounds: BRISTLES.0,
        prior: Some(BRISTLES.1),
    });
    let stamps = Parameter::tolerated(&Tolerated {
        quantity: Quantity::Delay,
        bounds: [-STAMPS, STAMPS],
    });
    known.chain(bristles).chain([stamps]).collect()
}

/// Numbers of a set of effects with the nuisances that they do not free.
fn parameters(input: &ArmInput, effects: &[Candidate]) -> Vec<Parameter> {
    let mut all = nuisances(input);
    for parameter in effects.iter().flat_map(|effect| &effect.free) {
        match all.iter_mut().find(|p| p.quantity == parameter.quantity) {
            // Of two effects that move the same number, what both allow.
            Some(known) => *known = *parameter,
            None => all.push(*parameter),
        }
    }
    all
}

impl Hypothesis {
    /// The description as it is declared, within its tolerances.
    #[must_use]
    pub fn nominal(evidence: &Evidence, scales: &[f64], columns: &mut Columns) -> Self {
        let parameters = nuisances(evidence.input);
        let start = (&evidence.input.nominal, None);
        Self {
            effects: Vec::new(),
            fit: fit(evidence, start, &parameters, scales, columns),
        }
    }

    /// With another effect, fitted from where this one ended.
    #[must_use]
    pub fn with(
        &self,
        evidence: &Evidence,
        candidate: &Candidate,
        scales: &[f64],
        columns: &mut Columns,
    ) -> Self {
        let mut arm = self.fit.arm.clone();
        let placed = candidate.applied(&mut arm);
        let mut effects = self.effects.clone();
        effects.push(placed);
        let parameters = parameters(evidence.input, &effects);
        columns.forget(|q| is_curved(q) || matches!(q, Quantity::InverseGain(_)));
        let fit = fit(
            evidence,
            (&arm, Some(&self.fit.course)),
            &parameters,
            scales,
            columns,
        );
        Self { effects, fit }
    }

    /// The same effects with other scales, from where they are.
    #[must_use]
    pub fn of_same(
        evidence: &Evidence,
        known: &Self,
        scales: &[f64],
        columns: &mut Columns,
    ) -> Self {
        columns.forget(|_| true);
        let start = (&known.fit.arm, Some(&known.fit.course));
        Self {
            effects: known.effects.clone(),
            fit: fit(evidence, start, &known.fit.parameters, scales, columns),
        }
    }

    /// Without one of its effects, whose numbers go back to what is declared.
    #[must_use]
    pub fn without(
        &self,
        evidence: &Evidence,
        place: usize,
        scales: &[f64],
        columns: &mut Columns,
    ) -> Self {
        let mut effects = self.effects.clone();
        let dropped = effects.remove(place);
        let mut arm = without(evidence.input, &self.fit.arm, &[dropped]);
        // What another effect still needs stays as it is.
        for parameter in effects.iter().flat_map(|effect| &effect.free) {
            parameter
                .quantity
                .set(&mut arm, parameter.quantity.value(&self.fit.arm));
        }
        let parameters = parameters(evidence.input, &effects);
        columns.forget(|_| true);
        let fit = fit(evidence, (&arm, None), &parameters, scales, columns);
        Self { effects, fit }
    }

    /// The same effects from the description that a list of them gives, fitted anew.
    #[must_use]
    pub fn of(
        evidence: &Evidence,
        effects: &[Candidate],
        scales: &[f64],
        columns: &mut Columns,
    ) -> Self {
        let mut arm = evidence.input.nominal.clone();
        let placed: Vec<Candidate> = effects.iter().map(|e| e.applied(&mut arm)).collect();
        let parameters = parameters(evidence.input, &placed);
        columns.forget(|_| true);
        let fit = fit(evidence, (&arm, None), &parameters, scales, columns);
        Self {
            effects: placed,
            fit,
        }
    }

    /// Names of its effects.
    #[must_use]
    pub fn names(&self) -> Vec<ArmEffect> {
        self.effects.iter().map(|e| e.effect).collect()
    }
}

/// Decrease of the cost that each candidate promises, by one step from a hypothesis.
#[must_use]
pub fn screen(
    evidence: &Evidence,
    hypothesis: &Hypothesis,
    candidates: &[Candidate],
    scales: &[f64],
    columns: &mut Columns,
) -> Vec<f64> {
    let base = Base::of(evidence, hypothesis, scales, columns);
    let promised = |candidate: &Candidate| {
        let promised = base.promised(evidence, hypothesis, candidate, scales);
        // Where one step leads nowhere, a whole fit says what there is to gain.
        if promised.is_finite() {
            return promised;
        }
        let whole = hypothesis.with(evidence, candidate, scales, columns);
        hypothesis.fit.cost - whole.fit.cost
    };
    candidates.iter().map(promised).collect()
}

/// Normal equations of a hypothesis, to which a candidate's are added.
struct Base {
    parameters: Vec<Parameter>,
    columns: Vec<Arc<Column>>,
    hessian: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Base {
    fn of(
        evidence: &Evidence,
        hypothesis: &Hypothesis,
        scales: &[f64],
        columns: &mut Columns,
    ) -> Self {
        let fit = &hypothesis.fit;
        let each: Vec<Arc<Column>> = (fit.parameters.iter())
            .map(|p| columns.of(evidence, &fit.course, p.quantity))
            .collect();
        let gradient = fit.parameters.iter().zip(&each).map(|(p, column)| {
            let pull = p.prior.map_or(0.0, |[centre, deviation]| {
                (centre - p.quantity.value(&fit.arm)) / (deviation * deviation)
            });
            weighed(&products(column, &fit.residuals), scales) + pull
        });
        let gradient = DVector::from_iterator(each.len(), gradient);
        Self {
            parameters: fit.parameters.clone(),
            columns: each,
            hessian: fit.hessian.clone(),
            gradient,
        }
    }

    /// Decrease of the cost with a candidate.
    fn promised(
        &self,
        evidence: &Evidence,
        hypothesis: &Hypothesis,
        candidate: &Candidate,
        scales: &[f64],
    ) -> f64 {
        let fit = &hypothesis.fit;
        let mut arm = fit.arm.clone();
        let placed = candidate.applied(&mut arm);
        let course = evidence.course(&arm, Some(&fit.course));
        let mut hessian = self.hessian.clone();
        let mut gradient = self.gradient.clone();
        let value = |p: &Parameter, arm: &ArmParameters| p.quantity.value(arm);
        let mut bounds: Vec<[f64; 2]> = (self.parameters.iter())
            .map(|p| p.bounds.map(|b| b - value(p, &fit.arm)))
            .collect();
        let mut added: Vec<Column> = Vec::new();
        // Where a candidate begins elsewhere than at nothing, its start is a part of the step.
        let moved = (candidate.presets.iter())
            .any(|(q, v)| candidate.screened.contains(q) && v.abs() > 1e-2);
        let residuals = moved.then(|| residuals_of(evidence, &course));
        let start = residuals.as_ref().unwrap_or(&fit.residuals);
        if moved {
            for (i, column) in self.columns.iter().enumerate() {
                let before = weighed(&products(column, &fit.residuals), scales);
                gradient[i] += weighed(&products(column, start), scales) - before;
            }
        }
        let is_one_of_many =
            candidate.law.is_some() || matches!(candidate.effect, ArmEffect::GearRipple(_));
        let mut alone = 0.0;
        for quantity in &placed.screened {
            let free = placed.free.iter().find(|p| p.quantity == *quantity);
            let Some(free) = free else { continue };
            let room = free.bounds.map(|b| b - value(free, &arm));
            if let Some(place) = self.parameters.iter().position(|p| p.quantity == *quantity) {
                bounds[place] = room;
                if let Some([centre, deviation]) = self.parameters[place].prior {
                    let weight = 1.0 / (deviation * deviation);
                    hessian[(place, place)] -= weight;
                    gradient[place] -= (centre - quantity.value(&fit.arm)) * weight;
                }
                continue;
            }
            let column = evidence.derivative(&course, *quantity);
            // Of thousands of laws and ripples most have nothing to do with what is left.
            let with = weighed(&products(&column, start), scales);
            let own = weighed(&products(&column, &column), scales).max(1e-300);
            alone += with * with / own;
            if is_one_of_many && added.len() + 1 == placed.screened.len() && alone < OF_NO_USE {
                return 0.0;
            }
            let last = hessian.nrows();
            hessian = hessian.insert_row(last, 0.0).insert_column(last, 0.0);
            gradient = gradient.insert_row(last, with);
            let all = (self.columns.iter().map(Arc::as_ref)).chain(&added);
            for (i, other) in all.enumerate() {
                let product = weighed(&products(&column, other), scales);
                hessian[(last, i)] = product;
                hessian[(i, last)] = product;
            }
            hessian[(last, last)] = own * (1.0 + 1e-9) + 1e-12;
            bounds.push(room);
            added.push(column);
        }
        let change = least_within(&hessian, &gradient, &bounds, &vec![0.0; bounds.len()]);
        let change = DVector::from_vec(change);
        let gained = 2.0 * gradient.dot(&change) - change.dot(&(&hessian * &change));
        let at_start = if moved {
            let cost = |r: &Column| weighed(&products(r, r), scales);
            cost(&fit.residuals) - cost(start)
        } else {
            0.0
        };
        gained + at_start
    }
}
