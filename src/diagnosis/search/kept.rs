//! Explanations of a diagnosis as data, and a search that goes on from them with recordings that have come since.

use std::f64::consts::TAU;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::progress::{Observer, Step};
use super::scale::Scale;
use super::screen::PHASE;
use super::{RoughFit, Search, same};
use crate::diagnosis::fit::free::{Free, Prior, free_of};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::model_error::ModelError;
use crate::diagnosis::fit::{FINEST, Limit, Refit, robust_sum, rough_noise};
use crate::effects::{Coordinate, UNLISTED};
use crate::plant::registry::{LATENT_COEFFICIENT, LATENT_FREQUENCY, LATENT_RISE};
use crate::plant::{
    Basis, Constant, Expression, Formula, Latent, LawText, Moment, Number, PlantParameters, Port,
    Quantity, SYMBOLS, Variable, kept_name,
};

/// Score behind the best from which an explanation is fitted from its starts too [1].
const BEHIND: f64 = 6.0;
/// Starts of each, at most.
const STARTS: usize = 3;
/// Phases that are tried of what is periodic in a recording that is new.
const PHASES: usize = 8;

/// An explanation as data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptExplanation {
    /// Names of its effects.
    pub effects: Vec<String>,
    /// Variables on which its model discrepancy depends.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    depends_on: Vec<String>,
    /// Values of what it leaves free, in the order of its fit, without phases [SI].
    values: Vec<f64>,
    /// Phases of what is periodic, with the place of their recording [rad].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    phases: Vec<(usize, f64)>,
    /// Its model discrepancy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    term: Option<KeptTerm>,
}

/// A model discrepancy as data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct KeptTerm {
    port: String,
    variable: String,
    directed: bool,
    basis: KeptBasis,
    coefficients: Vec<f64>,
    free: Vec<KeptFree>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum KeptBasis {
    Hats {
        ends: [f64; 2],
    },
    Waves {
        frequency: f64,
    },
    Formula {
        text: String,
        constants: Vec<KeptConstant>,
        visited: [f64; 2],
        /// The values of a moment in its order; none where there is no surface.
        typical: [Option<f64>; MOMENT],
    },
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct KeptConstant {
    name: String,
    value: f64,
    unit: Option<String>,
}

/// Values of a moment.
const MOMENT: usize = 9;

fn values_of(moment: &Moment) -> [Option<f64>; MOMENT] {
    let [first, second] = moment.pressures;
    [
        moment.time,
        moment.stroke,
        moment.speed,
        first,
        second,
        moment.mass_flow,
        moment.set_pressure,
        moment.surface,
        moment.contact_force,
    ]
    .map(|value| value.is_finite().then_some(value))
}

fn moment_of(values: [Option<f64>; MOMENT]) -> Moment {
    let [
        time,
        stroke,
        speed,
        first,
        second,
        mass_flow,
        set_pressure,
        surface,
        contact_force,
    ] = values.map(|value| value.unwrap_or(f64::NAN));
    Moment {
        time,
        stroke,
        speed,
        pressures: [first, second],
        mass_flow,
        set_pressure,
        surface,
        contact_force,
    }
}

/// What is free of a term, as the fit moves it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct KeptFree {
    kind: Kind,
    index: usize,
    name: String,
    /// Scale of a linear coordinate; none of a logarithmic one.
    scale: Option<f64>,
    bounds: [f64; 2],
    /// Mean and standard deviation, where it is not free between its bounds.
    prior: Option<[f64; 2]>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Coefficient,
    Rise,
    Frequency,
}

impl Kind {
    const ALL: [(Self, &'static Number); 3] = [
        (Self::Coefficient, &LATENT_COEFFICIENT),
        (Self::Rise, &LATENT_RISE),
        (Self::Frequency, &LATENT_FREQUENCY),
    ];

    fn of(quantity: &Quantity) -> Option<Self> {
        let own = |(_, number): &&(Self, &'static Number)| std::ptr::eq(*number, quantity.number);
        Self::ALL.iter().find(own).map(|(kind, _)| *kind)
    }

    fn quantity(self, name: &str, index: usize) -> Option<Quantity> {
        let own = Self::ALL.iter().find(|(kind, _)| *kind == self);
        own.map(|(_, number)| number.named(kept_name(name)).of(index))
    }
}

impl KeptFree {
    fn of(free: &Free) -> Option<Self> {
        Some(Self {
            kind: Kind::of(&free.quantity)?,
            index: free.quantity.index,
            name: free.quantity.name.to_owned(),
            scale: match free.coordinate {
                Coordinate::Linear(scale) => Some(scale),
                Coordinate::Logarithmic => None,
            },
            bounds: free.bounds,
            prior: match free.prior {
                Prior::Normal { mean, deviation } => Some([mean, deviation]),
                Prior::Flat | Prior::Settled { .. } => None,
            },
        })
    }

    fn free(&self, start: f64) -> Option<Free> {
        Some(Free {
            quantity: self.kind.quantity(&self.name, self.index)?,
            start,
            coordinate: self
                .scale
                .map_or(Coordinate::Logarithmic, Coordinate::Linear),
            bounds: self.bounds,
            prior: self
                .prior
                .map_or(Prior::Flat, |[mean, deviation]| Prior::Normal {
                    mean,
                    deviation,
                }),
        })
    }
}

impl KeptTerm {
    fn of(term: &Latent, free: &[Free]) -> Option<Self> {
        let first = free.len().checked_sub(term.numbers())?;
        Some(Self {
            port: term.port.name().to_owned(),
            variable: term.variable.name().to_owned(),
            directed: term.directed,
            basis: match &term.basis {
                Basis::Hats { ends } => KeptBasis::Hats { ends: *ends },
                Basis::Waves { frequency } => KeptBasis::Waves {
                    frequency: *frequency,
                },
                Basis::Formula(formula) => KeptBasis::Formula {
                    text: formula.law.expression.text().to_owned(),
                    constants: (formula.law.constants.iter())
                        .map(|own| KeptConstant {
                            name: own.name.to_owned(),
                            value: own.value,
                            unit: own.unit.map(str::to_owned),
                        })
                        .collect(),
                    visited: formula.visited,
                    typical: values_of(&formula.typical),
                },
            },
            coefficients: term.coefficients.clone(),
            free: free[first..]
                .iter()
                .map(KeptFree::of)
                .collect::<Option<_>>()?,
        })
    }

    /// The term; none where a name or its text is of another version of the program.
    fn latent(&self) -> Option<Latent> {
        let port = Port::ALL
            .into_iter()
            .find(|port| port.name() == self.port)?;
        let mut variables = Variable::ALL.into_iter();
        let variable = variables.find(|own| own.name() == self.variable)?;
        let basis = match &self.basis {
            KeptBasis::Hats { ends } => Basis::Hats { ends: *ends },
            KeptBasis::Waves { frequency } => Basis::Waves {
                frequency: *frequency,
            },
            KeptBasis::Formula {
                text,
                constants,
                visited,
                typical,
            } => {
                let constants: Vec<Constant> = (constants.iter())
                    .map(|own| Constant {
                        name: kept_name(&own.name),
                        value: own.value,
                        unit: own.unit.as_deref().map(kept_name),
                        range: None,
                    })
                    .collect();
                let names: Vec<&str> = (SYMBOLS.iter().map(|symbol| symbol.name))
                    .chain(constants.iter().map(|constant| constant.name))
                    .collect();
                Basis::Formula(Arc::new(Formula {
                    law: LawText {
                        name: UNLISTED,
                        port,
                        expression: Expression::read(text, &names).ok()?,
                        constants,
                    },
                    visited: *visited,
                    typical: moment_of(*typical),
                }))
            }
        };
        Some(Latent {
            port,
            variable,
            directed: self.directed,
            basis,
            coefficients: self.coefficients.clone(),
        })
    }
}

impl KeptExplanation {
    /// Of an explanation that was fitted; none of one that this form cannot hold.
    #[must_use]
    pub fn of(hypothesis: &Hypothesis) -> Option<Self> {
        let fit = &hypothesis.fit;
        let is_phase =
            |free: &Free| (hypothesis.effects.iter()).any(|e| e.has_phase(&free.quantity));
        let both = || fit.free.iter().zip(&fit.values);
        let term = match hypothesis.unlisted() {
            Some(term) => Some(KeptTerm::of(term, &fit.free)?),
            None => None,
        };
        Some(Self {
            effects: hypothesis
                .effects
                .iter()
                .map(|e| e.name.to_owned())
                .collect(),
            depends_on: hypothesis
                .depends_on
                .iter()
                .map(|&v| v.to_owned())
                .collect(),
            values: both()
                .filter(|(f, _)| !is_phase(f))
                .map(|(_, v)| *v)
                .collect(),
            phases: (both().filter(|(f, _)| is_phase(f)))
                .map(|(f, value)| (f.quantity.index, *value))
                .collect(),
            term,
        })
    }

    /// The description and what is free in it, from where it was; none where an effect is not sought, or the file is of another rig.
    fn restored(&self, search: &Search<'_>) -> Option<(Hypothesis, Vec<Free>)> {
        let nominal = &search.nominal;
        let of_name = |name: &String| {
            let mut all = search.candidates.iter();
            all.find(|effect| effect.name == name).copied()
        };
        let effects = (self.effects.iter().map(of_name)).collect::<Option<Vec<_>>>()?;
        let own: Vec<Free> = (effects.iter())
            .flat_map(|effect| {
                let count = effect.parameters(nominal).len();
                free_of(effect, nominal, &vec![0.0; count])
            })
            .collect();
        let tolerated = search.tolerated.iter().copied();
        let mut free: Vec<Free> = tolerated
            .filter(|f| !own.iter().any(|o| same(o, f, nominal)))
            .collect();
        free.extend(own);
        let mut plant = nominal.clone();
        plant.latent = match &self.term {
            Some(term) => Some(term.latent()?),
            None => None,
        };
        let term = self.term.as_ref().map_or(&[][..], |term| &term.free);
        if free.len() + term.len() != self.values.len() {
            return None;
        }
        let (own, of_term) = self.values.split_at(free.len());
        for (free, value) in free.iter_mut().zip(own) {
            free.start = free.clamp(*value);
        }
        if let Some(phase) = effects.iter().find_map(|effect| effect.phase) {
            free.extend((self.phases.iter()).map(|(place, start)| Free {
                quantity: phase.quantity().of(*place),
                start: *start,
                ..PHASE
            }));
        }
        for (own, value) in term.iter().zip(of_term) {
            free.push(own.free(*value)?);
        }
        for f in &free {
            f.quantity.set(&mut plant, f.start);
        }
        let hypothesis = Hypothesis {
            effects,
            depends_on: self.depends_on.iter().map(|own| kept_name(own)).collect(),
            fit: search
                .fitted(Vec::new(), (&plant, None), &free, FINEST, Limit::of(0))
                .fit,
        };
        Some((hypothesis, free))
    }
}

impl Search<'_> {
    /// Goes on from explanations that were found in fewer recordings: each is fitted anew, and what may have come to light beside the best is looked for. None
    /// where none of them explains what is there now: then what was settled is not.
    pub(in crate::diagnosis) fn resumed(
        &self,
        kept: &[KeptExplanation],
        observer: &mut Observer<'_>,
    ) -> Option<(Vec<Hypothesis>, Vec<RoughFit>, ModelError)> {
        let noise = rough_noise(self.evidence);
        let baseline = self.baseline();
        let detail = format!("cost {:.0}, noise {noise:.0}", baseline.fit.rough);
        observer(&Step::Baseline.of(&baseline, detail));
        let scale = Scale::of(self.evidence, &baseline, noise);
        let mut rough: Vec<Hypothesis> = Vec::new();
        for (hypothesis, free) in kept.iter().filter_map(|own| own.restored(self)) {
            if self.is_spent() {
                break;
            }
            let started = self.with_new_phases(hypothesis, &free);
            let own = self.refit(&started, Refit::ROUGH);
            observer(&Step::RoughFit.of(&own, format!("cost {:.1}", self.rough_score(&own))));
            rough.push(own);
        }
        rough.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        let mut full = self.in_full(&rough, &scale, &mut Vec::new(), observer);
        self.start_anew(&mut full, &rough, observer);
        if !full.first().is_some_and(|best| scale.is_adequate(best)) {
            return None;
        }
        self.eliminate(&mut full, observer);
        if !rough.iter().any(Hypothesis::finds_nothing) {
            rough.push(baseline.clone());
        }
        Some(self.concluded(
            (full, rough),
            (&baseline, &scale),
            &mut Vec::new(),
            observer,
        ))
    }

    /// Fits those anew that a new recording has put behind the best, from where their last effect may start: where they stood before, they may have come to rest in a
    /// minimum that the recording has made a bad one, and nothing is ruled out by that.
    fn start_anew(
        &self,
        full: &mut Vec<Hypothesis>,
        rough: &[Hypothesis],
        observer: &mut Observer<'_>,
    ) {
        let best = full.iter().map(|h| self.score(h));
        let best = best.fold(f64::INFINITY, f64::min);
        for own in rough {
            let place = full.iter().position(|h| h.names() == own.names());
            let known = place.map_or(f64::INFINITY, |place| self.score(&full[place]));
            let Some(effect) = own.effects.last() else {
                continue;
            };
            if known < best + BEHIND || own.unlisted().is_some() || self.is_spent() {
                continue;
            }
            let numbers = own.numbers_of(&self.nominal, own.effects.len() - 1);
            let starts = effect.starts(&self.clues(own, &[], &[]));
            let fitted = starts.into_iter().take(STARTS).map(|start| {
                let mut other = own.clone();
                other.fit.values[numbers.clone()].copy_from_slice(&start);
                let rough = self.refit(&other, Refit::ROUGH);
                self.refit(&rough, Refit::FULL)
            });
            let fitted = fitted.min_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            let Some(fitted) = fitted.filter(|h| self.score(h) < known) else {
                continue;
            };
            let detail = format!("anew {:.1}, before {known:.1}", self.score(&fitted));
            observer(&Step::FullFit.of(&fitted, detail));
            match place {
                Some(place) => full[place] = fitted,
                None => full.push(fitted),
            }
        }
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// Of what is periodic the phases in recordings that were not there: the best of some.
    fn with_new_phases(&self, hypothesis: Hypothesis, free: &[Free]) -> Hypothesis {
        let Some(phase) = hypothesis.effects.iter().find_map(|effect| effect.phase) else {
            return hypothesis;
        };
        let known = |place: usize| {
            let quantity = phase.quantity().of(place);
            free.iter().any(|f| f.quantity.is(&quantity))
        };
        let first = (0..self.evidence.recordings.len()).find(|place| known(*place));
        let new: Vec<usize> = (first.unwrap_or(1)..self.evidence.recordings.len())
            .filter(|place| !known(*place))
            .collect();
        let mut free = free.to_vec();
        let mut plant = hypothesis.fit.prediction.plant.clone();
        let term = hypothesis.unlisted().map_or(0, Latent::numbers);
        for place in new {
            let quantity = phase.quantity().of(place);
            let cost = |plant: &PlantParameters| {
                robust_sum(&self.evidence.predict(plant, false, None).residuals)
            };
            let at = |turn: usize| {
                let angle = TAU * turn as f64 / PHASES as f64;
                let mut tried = plant.clone();
                quantity.set(&mut tried, angle);
                (cost(&tried), angle)
            };
            let best = (0..PHASES).map(at).min_by(|a, b| a.0.total_cmp(&b.0));
            let start = best.map_or(0.0, |(_, angle)| angle);
            quantity.set(&mut plant, start);
            free.insert(
                free.len() - term,
                Free {
                    quantity,
                    start,
                    ..PHASE
                },
            );
        }
        Hypothesis {
            fit: self
                .fitted(Vec::new(), (&plant, None), &free, FINEST, Limit::of(0))
                .fit,
            ..hypothesis
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ruled_out::variant;
    use super::*;
    use crate::diagnosis::test_evidence::{evidence_of, plant, search};
    use crate::effects::every;

    /// What is kept is read back as it was, number for number, and predicts the same.
    #[test]
    fn an_explanation_is_read_back_as_it_was() {
        let effect = every()
            .find(|e| e.name == "coulomb_viscous_friction")
            .unwrap();
        let mut truth = plant();
        truth.device.seal_friction.viscous = 60.0;
        let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
        let mut search = search(&evidence);
        search.candidates = vec![effect];
        let fitted = Hypothesis {
            effects: vec![effect],
            fit: variant(&search, &[effect], FINEST).unwrap(),
            depends_on: Vec::new(),
        };
        let kept = KeptExplanation::of(&fitted).unwrap();
        let text = serde_json::to_string(&kept).unwrap();
        let read: KeptExplanation = serde_json::from_str(&text).unwrap();
        assert_eq!(read, kept);
        let (restored, free) = read.restored(&search).unwrap();
        assert_eq!(restored.names(), fitted.names());
        assert_eq!(free.len(), fitted.fit.free.len());
        assert_eq!(restored.fit.values, fitted.fit.values);
        let same = restored.fit.prediction.residuals.iter();
        let same = same.zip(&fitted.fit.prediction.residuals);
        assert!(same.into_iter().all(|(a, b)| (a - b).abs() < 1e-9));
        // Of another search it is none.
        search.candidates.clear();
        assert!(read.restored(&search).is_none());
    }
}
