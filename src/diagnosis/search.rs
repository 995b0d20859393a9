//! Which effects explain what the believed model leaves.

use super::evidence::{Evidence, Prediction};
use super::fit::{Effort, FULL, Fit, ROUGH, Stage, fit, rough_noise};
use super::free::{Free, Prior, free_of};
use crate::effects::{CATALOGUE, Clues, Effect};
use crate::plant::PlantParameters;
use rayon::prelude::*;

/// Iterations of the first look at an effect.
const GLANCE: usize = 1;
/// Iterations of the second look at those that promise most.
const LOOK: usize = 3;
/// How many get a second look.
const LOOKED_AT: usize = 7;
/// Iterations of a full fit.
const FULL_ITERATIONS: usize = 40;
/// Effects at most.
const MOST_EFFECTS: usize = 3;
/// Hypotheses that are carried on from each number of effects.
const PARENTS: usize = 2;
/// Candidates of each that are fitted in full.
const REFINED: usize = 4;
/// Cost of having looked at so many effects: twice the logarithm of their number [1].
const LOOK_ELSEWHERE: f64 = 7.0;

/// A set of effects, fitted together with what is tolerated.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    /// The effects.
    pub effects: Vec<&'static Effect>,
    /// The fit: tolerated quantities first, then the effects' in order.
    pub fit: Fit,
}

/// Everything a search needs.
pub struct Search<'a> {
    /// The recordings.
    pub evidence: &'a Evidence,
    /// The rig as believed.
    pub believed: PlantParameters,
    /// What is tolerated.
    pub tolerated: Vec<Free>,
}

impl Search<'_> {
    /// The believed model within its tolerances, roughly.
    pub fn baseline(&self) -> Hypothesis {
        self.fitted(vec![], &self.believed, &self.tolerated, ROUGH, 12, None)
    }

    fn fitted(&self, effects: Vec<&'static Effect>, plant: &PlantParameters, free: &[Free], stages: &[Stage], iterations: usize, known: Option<&Prediction>) -> Hypothesis {
        let effort = Effort { iterations, stages, frozen: &[], longest_step: 3.0 };
        Hypothesis { effects, fit: fit(self.evidence, plant, free, effort, known) }
    }

    /// Penalty for the numbers of an effect: Schwarz's.
    pub fn penalty(&self, hypothesis: &Hypothesis) -> f64 {
        let count = |effect: &&'static Effect| (effect.parameters)(&self.believed).len();
        let numbers: usize = hypothesis.effects.iter().map(count).sum();
        numbers as f64 * (self.evidence.count() as f64).ln() + LOOK_ELSEWHERE * hypothesis.effects.len() as f64
    }

    /// Cost of a rough fit with its penalty.
    pub fn rough_score(&self, hypothesis: &Hypothesis) -> f64 {
        hypothesis.fit.rough + self.penalty(hypothesis)
    }

    /// Cost with its penalty.
    pub fn score(&self, hypothesis: &Hypothesis) -> f64 {
        hypothesis.fit.cost() + self.penalty(hypothesis)
    }

    /// What more each effect could explain, roughly: columns of what is free already are taken as they are. Best first.
    pub fn screen(&self, from: &Hypothesis, stages: &[Stage]) -> Vec<Hypothesis> {
        let periodic = super::spectrum::strongest(self.evidence, &from.fit.prediction);
        let readings = self.evidence.recordings.iter().flat_map(|m| m.readings[2].iter());
        let clues = Clues {
            plant: &from.fit.prediction.plant,
            largest_force: readings.filter(|f| f.is_finite()).fold(0.0, |a, b| b.max(a)),
            periodic: &periodic,
        };
        let starts: Vec<(&'static Effect, Vec<f64>)> = CATALOGUE
            .iter()
            .filter(|effect| !from.effects.iter().any(|e| e.excludes(effect)))
            .flat_map(|effect| (effect.starts)(&clues).into_iter().map(move |start| (effect, start)))
            .collect();
        let mut best: Vec<(usize, Hypothesis)> = Vec::new();
        let glances: Vec<Hypothesis> = starts
            .par_iter()
            .map(|(effect, start)| self.add(from, effect, start, stages, GLANCE))
            .collect();
        for (index, hypothesis) in glances.into_iter().enumerate() {
            let name = starts[index].0.name;
            match best.iter_mut().find(|(known, _)| starts[*known].0.name == name) {
                Some((_, known)) if known.fit.rough <= hypothesis.fit.rough => {}
                Some(known) => *known = (index, hypothesis),
                None => best.push((index, hypothesis)),
            }
        }
        best.sort_by(|a, b| self.rough_score(&a.1).total_cmp(&self.rough_score(&b.1)));
        best.truncate(LOOKED_AT);
        let mut looked: Vec<Hypothesis> = best
            .par_iter()
            .map(|(index, glance)| {
                let (effect, _) = starts[*index];
                let reached = &glance.fit.values[glance.fit.values.len() - (effect.parameters)(&self.believed).len()..];
                self.add(from, effect, reached, stages, LOOK)
            })
            .collect();
        looked.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        looked
    }

    /// A hypothesis with one more effect from a start, fitted roughly.
    fn add(&self, from: &Hypothesis, effect: &'static Effect, start: &[f64], stages: &[Stage], iterations: usize) -> Hypothesis {
        let new = free_of(effect, &self.believed, start);
        let mut kept = Vec::new();
        let mut frozen = Vec::new();
        for ((f, value), column) in from.fit.free.iter().zip(&from.fit.values).zip(&from.fit.columns) {
            // What an effect frees is no longer held to its tolerance.
            if !new.iter().any(|n| same(n, f, &self.believed)) {
                kept.push(Free { start: *value, ..*f });
                frozen.push(column.clone());
            }
        }
        kept.extend(new);
        let effort = Effort { iterations, stages, frozen: &frozen, longest_step: 3.0 };
        let mut effects = from.effects.clone();
        effects.push(effect);
        Hypothesis { effects, fit: fit(self.evidence, &from.fit.prediction.plant, &kept, effort, Some(&from.fit.prediction)) }
    }

    /// The explanation that costs least, and those that come near: first roughly, then in full.
    pub fn run(&self, say: &mut dyn FnMut(&str)) -> Vec<Hypothesis> {
        let noise = rough_noise(self.evidence);
        let mut rough = vec![self.baseline()];
        say(&format!("baseline {:.0}, noise {noise:.0}", rough[0].fit.rough));
        let mut tried: Vec<Vec<&'static str>> = vec![vec![]];
        for depth in 0..MOST_EFFECTS {
            let best = self.rough_score(&rough[0]);
            let parents: Vec<Hypothesis> = rough.iter().filter(|h| h.effects.len() == depth).take(PARENTS).cloned().collect();
            for parent in &parents {
                let score = self.rough_score(parent);
                for candidate in self.screen(parent, ROUGH) {
                    let gain = score - self.rough_score(&candidate);
                    say(&format!("  {:?} rough gain {gain:.1}", candidate.effects));
                    let names = names(&candidate);
                    if gain > 0.0 && !tried.contains(&names) {
                        tried.push(names);
                        rough.push(candidate);
                    }
                }
            }
            rough.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
            // The few that lead are fitted roughly with everything free.
            for leading in rough.iter_mut().filter(|h| h.effects.len() == depth + 1).take(REFINED) {
                let refitted = self.refine(leading, ROUGH, 8);
                if refitted.fit.rough < leading.fit.rough {
                    *leading = refitted;
                }
                say(&format!("  {:?} rough {:.1}", leading.effects, self.rough_score(leading)));
            }
            rough.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
            if best - self.rough_score(&rough[0]) <= 0.0 {
                break;
            }
        }
        let mut full: Vec<Hypothesis> = Vec::new();
        for candidate in rough.iter().take(REFINED) {
            let refined = self.refine(candidate, FULL, FULL_ITERATIONS);
            say(&format!("  {:?} full {:.1} left {:.0}", refined.effects, self.score(&refined), refined.fit.cost() - self.evidence.count() as f64));
            full.push(refined);
        }
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        full
    }

    /// Fits everything that is free in a hypothesis: the effects from where they are, what is tolerated from what was believed, because a model that
    /// lacks something bends it out of shape.
    pub fn refine(&self, hypothesis: &Hypothesis, stages: &[Stage], iterations: usize) -> Hypothesis {
        let fitted = &hypothesis.fit;
        let free: Vec<Free> = fitted.free.iter().zip(&fitted.values).map(|(f, value)| match f.prior {
            Prior::Normal { mean, .. } => Free { start: mean, ..*f },
            Prior::Flat => Free { start: *value, ..*f },
        }).collect();
        self.fitted(hypothesis.effects.clone(), &fitted.prediction.plant, &free, stages, iterations, Some(&fitted.prediction))
    }
}

fn names(hypothesis: &Hypothesis) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = hypothesis.effects.iter().map(|e| e.name).collect();
    names.sort_unstable();
    names
}

/// Do two free quantities change the same number?
fn same(a: &Free, b: &Free, plant: &PlantParameters) -> bool {
    let value = (b.quantity.get)(plant);
    let mut changed = plant.clone();
    (a.quantity.set)(&mut changed, 1.7 * (a.quantity.get)(plant) + 1e-3);
    let after = (b.quantity.get)(&changed);
    !(value == after || (value.is_nan() && after.is_nan()))
}
