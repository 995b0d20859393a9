//! Which effects explain what the believed model leaves.

use super::evidence::Evidence;
use super::fit::{Effort, Fit, fit};
use super::free::{Free, Prior, free_of};
use crate::effects::{CATALOGUE, Clues, Effect};
use crate::plant::PlantParameters;
use rayon::prelude::*;

/// Iterations in a rough fit.
const SCREENING_ITERATIONS: usize = 3;
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
    /// The believed model within its tolerances.
    pub fn baseline(&self) -> Hypothesis {
        Hypothesis { effects: vec![], fit: fit(self.evidence, &self.believed, &self.tolerated, Effort { iterations: 8, frozen: &[], longest_step: 3.0 }, None) }
    }

    /// Penalty for the numbers of an effect: Schwarz's.
    pub fn penalty(&self, hypothesis: &Hypothesis) -> f64 {
        let count = |effect: &&'static Effect| (effect.parameters)(&self.believed).len();
        let numbers: usize = hypothesis.effects.iter().map(count).sum();
        numbers as f64 * (self.evidence.count() as f64).ln() + LOOK_ELSEWHERE * hypothesis.effects.len() as f64
    }

    /// Cost with its penalty.
    pub fn score(&self, hypothesis: &Hypothesis) -> f64 {
        hypothesis.fit.cost() + self.penalty(hypothesis)
    }

    /// What more each effect could explain, roughly: columns of what is free already are taken as they are. Best first.
    pub fn screen(&self, from: &Hypothesis) -> Vec<Hypothesis> {
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
        let first: Vec<Hypothesis> = starts.par_iter().map(|(effect, start)| self.add(from, effect, start, SCREENING_ITERATIONS)).collect();
        let mut best: Vec<Hypothesis> = Vec::new();
        for hypothesis in first {
            let name = hypothesis.effects.last().map(|e| e.name);
            match best.iter_mut().find(|b| b.effects.last().map(|e| e.name) == name) {
                Some(known) if known.fit.cost() <= hypothesis.fit.cost() => {}
                Some(known) => *known = hypothesis,
                None => best.push(hypothesis),
            }
        }
        best.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        best
    }

    /// A hypothesis with one more effect from a start, fitted roughly.
    fn add(&self, from: &Hypothesis, effect: &'static Effect, start: &[f64], iterations: usize) -> Hypothesis {
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
        let effort = Effort { iterations, frozen: &frozen, longest_step: 3.0 };
        let mut effects = from.effects.clone();
        effects.push(effect);
        Hypothesis { effects, fit: fit(self.evidence, &from.fit.prediction.plant, &kept, effort, Some(&from.fit.prediction)) }
    }

    /// The explanation that costs least, and those that come near.
    pub fn run(&self, say: &mut dyn FnMut(&str)) -> Vec<Hypothesis> {
        let mut ranked = vec![self.baseline()];
        say(&format!("baseline {:.0} of {}", ranked[0].fit.cost(), self.evidence.count()));
        let mut tried: Vec<Vec<&'static str>> = vec![vec![]];
        for depth in 0..MOST_EFFECTS {
            let before = self.score(&ranked[0]);
            let parents: Vec<Hypothesis> = ranked.iter().filter(|h| h.effects.len() == depth).take(PARENTS).cloned().collect();
            for parent in &parents {
                let screened = self.screen(parent);
                let parent_score = self.score(parent);
                for candidate in screened.iter().take(REFINED) {
                    let gain = parent_score - self.score(candidate);
                    say(&format!("  {:?} screened {gain:.1}", candidate.effects));
                    if gain < -LOOK_ELSEWHERE {
                        continue;
                    }
                    let mut names: Vec<&'static str> = candidate.effects.iter().map(|e| e.name).collect();
                    names.sort_unstable();
                    if tried.contains(&names) {
                        continue;
                    }
                    tried.push(names);
                    let refined = self.refine(candidate, 8);
                    say(&format!("  {:?} refined {:.1} left {:.0}", refined.effects, parent_score - self.score(&refined), refined.fit.cost() - self.evidence.count() as f64));
                    ranked.push(refined);
                }
            }
            ranked.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            if before - self.score(&ranked[0]) <= 0.0 {
                break;
            }
        }
        ranked
    }

    /// Fits everything that is free in a hypothesis: the effects from where they are, what is tolerated from what was believed, because a model that
    /// lacks something bends it out of shape.
    pub fn refine(&self, hypothesis: &Hypothesis, iterations: usize) -> Hypothesis {
        let fitted = &hypothesis.fit;
        let free: Vec<Free> = fitted.free.iter().zip(&fitted.values).map(|(f, value)| match f.prior {
            Prior::Normal { mean, .. } => Free { start: mean, ..*f },
            Prior::Flat => Free { start: *value, ..*f },
        }).collect();
        let effort = Effort { iterations, frozen: &[], longest_step: 3.0 };
        Hypothesis { effects: hypothesis.effects.clone(), fit: fit(self.evidence, &fitted.prediction.plant, &free, effort, Some(&fitted.prediction)) }
    }
}

/// Do two free quantities change the same number?
fn same(a: &Free, b: &Free, plant: &PlantParameters) -> bool {
    let value = (b.quantity.get)(plant);
    let mut changed = plant.clone();
    (a.quantity.set)(&mut changed, 1.7 * (a.quantity.get)(plant) + 1e-3);
    let after = (b.quantity.get)(&changed);
    !(value == after || (value.is_nan() && after.is_nan()))
}
