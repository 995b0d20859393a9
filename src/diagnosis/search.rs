//! Which effects explain what the believed model leaves.

use super::evidence::{Evidence, Prediction};
use super::fit::{
    Effort, FULL, Fit, ROUGH, Stage, fit, foretold_rough, jacobian, rough_noise, with_values,
};
use super::free::{Free, Prior, free_of};
use crate::effects::{Clues, Effect};
use crate::plant::PlantParameters;
use rayon::prelude::*;

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
/// Rough cost behind the best at which a hypothesis is given up [1].
const HOPELESS: f64 = 300.0;
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
    /// Effects that may be at work.
    pub candidates: Vec<&'static Effect>,
}

impl Search<'_> {
    /// The believed model within its tolerances, roughly.
    pub fn baseline(&self) -> Hypothesis {
        self.fitted(vec![], &self.believed, &self.tolerated, ROUGH, 15, None)
    }

    fn fitted(
        &self,
        effects: Vec<&'static Effect>,
        plant: &PlantParameters,
        free: &[Free],
        stages: &[Stage],
        iterations: usize,
        known: Option<&Prediction>,
    ) -> Hypothesis {
        let effort = Effort {
            iterations,
            stages,
            frozen: &[],
            longest_step: 3.0,
        };
        Hypothesis {
            effects,
            fit: fit(self.evidence, plant, free, effort, known),
        }
    }

    /// Penalty for the numbers of an effect: Schwarz's.
    pub fn penalty(&self, hypothesis: &Hypothesis) -> f64 {
        let count = |effect: &&'static Effect| (effect.parameters)(&self.believed).len();
        let numbers: usize = hypothesis.effects.iter().map(count).sum();
        numbers as f64 * (self.evidence.count() as f64).ln()
            + LOOK_ELSEWHERE * hypothesis.effects.len() as f64
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
        let bumps = super::bumps::strongest(self.evidence, &from.fit.prediction);
        let readings = self
            .evidence
            .recordings
            .iter()
            .flat_map(|m| m.readings[2].iter());
        let clues = Clues {
            plant: &from.fit.prediction.plant,
            largest_force: readings
                .filter(|f| f.is_finite())
                .fold(0.0, |a, b| b.max(a)),
            periodic: &periodic,
            bumps: &bumps,
        };
        let starts: Vec<(&'static Effect, Vec<f64>)> = self
            .candidates
            .iter()
            .copied()
            .filter(|effect| !from.effects.iter().any(|e| e.excludes(effect)))
            .flat_map(|effect| {
                (effect.starts)(&clues)
                    .into_iter()
                    .map(move |start| (effect, start))
            })
            .collect();
        let glances: Vec<f64> = starts
            .par_iter()
            .map(|(effect, start)| self.glance(from, effect, start))
            .collect();
        // The best start of each effect, then the effects that promise most.
        let mut best: Vec<usize> = Vec::new();
        for index in 0..starts.len() {
            match best
                .iter_mut()
                .find(|known| starts[**known].0.name == starts[index].0.name)
            {
                Some(known) if glances[*known] <= glances[index] => {}
                Some(known) => *known = index,
                None => best.push(index),
            }
        }
        best.sort_by(|a, b| glances[*a].total_cmp(&glances[*b]));
        best.truncate(LOOKED_AT);
        let mut looked: Vec<Hypothesis> = best
            .par_iter()
            .map(|index| self.add(from, starts[*index].0, &starts[*index].1, stages, LOOK))
            .collect();
        looked.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        looked
    }

    /// What was free and still is beside an effect, with its columns.
    fn beside(&self, from: &Hypothesis, new: &[Free]) -> (Vec<Free>, Vec<Vec<f64>>) {
        let fitted = from
            .fit
            .free
            .iter()
            .zip(&from.fit.values)
            .zip(&from.fit.columns);
        fitted
            // What an effect frees is no longer held to its tolerance.
            .filter(|((f, _), _)| !new.iter().any(|n| same(n, f, &self.believed)))
            .map(|((f, value), column)| {
                (
                    Free {
                        start: *value,
                        ..*f
                    },
                    column.clone(),
                )
            })
            .unzip()
    }

    /// Rough cost that a hypothesis with one more effect could come to by one step from a start.
    fn glance(&self, from: &Hypothesis, effect: &'static Effect, start: &[f64]) -> f64 {
        let new = free_of(effect, &self.believed, start);
        let (mut free, mut columns) = self.beside(from, &new);
        let own = free.len();
        free.extend(new);
        let values: Vec<f64> = free.iter().map(|f| f.start).collect();
        let plant = with_values(&from.fit.prediction.plant, &free, &values);
        let there = self
            .evidence
            .predict(&plant, true, Some(&from.fit.prediction));
        columns.extend(jacobian(self.evidence, &there, &free, &values, own));
        foretold_rough(self.evidence, &there, &free, &values, &columns)
    }

    /// A hypothesis with one more effect from a start, fitted roughly.
    fn add(
        &self,
        from: &Hypothesis,
        effect: &'static Effect,
        start: &[f64],
        stages: &[Stage],
        iterations: usize,
    ) -> Hypothesis {
        let new = free_of(effect, &self.believed, start);
        let (mut free, frozen) = self.beside(from, &new);
        free.extend(new);
        let mut plant = from.fit.prediction.plant.clone();
        for f in &free {
            (f.quantity.set)(&mut plant, f.start);
        }
        let effort = Effort {
            iterations,
            stages,
            frozen: &frozen,
            longest_step: 3.0,
        };
        let mut effects = from.effects.clone();
        effects.push(effect);
        Hypothesis {
            effects,
            fit: fit(
                self.evidence,
                &plant,
                &free,
                effort,
                Some(&from.fit.prediction),
            ),
        }
    }

    /// The explanation that costs least, and those that come near: first roughly, then in full.
    pub fn run(&self, say: &mut dyn FnMut(&str)) -> Vec<Hypothesis> {
        let noise = rough_noise(self.evidence);
        let mut rough = vec![self.baseline()];
        say(&format!(
            "baseline {:.0}, noise {noise:.0}",
            rough[0].fit.rough
        ));
        let mut tried: Vec<Vec<&'static str>> = vec![vec![]];
        for depth in 0..MOST_EFFECTS {
            let best = self.rough_score(&rough[0]);
            // Beside one that leaves noise alone, no other need be carried on.
            let spread = 6.0 * (2.0 * noise).sqrt();
            let settled = rough[0].fit.rough < noise + spread;
            let parents: Vec<Hypothesis> = rough
                .iter()
                .filter(|h| h.effects.len() == depth)
                .take(if settled { 1 } else { PARENTS })
                .cloned()
                .collect();
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
            let near = self.rough_score(&rough[0]).max(noise);
            for leading in rough
                .iter_mut()
                .filter(|h| h.effects.len() == depth + 1)
                .take(REFINED)
            {
                if depth > 0 && self.rough_score(leading) > 3.0 * near {
                    break;
                }
                let refitted = self.refine(leading, ROUGH, 15);
                if refitted.fit.rough < leading.fit.rough {
                    *leading = refitted;
                }
                say(&format!(
                    "  {:?} rough {:.1}",
                    leading.effects,
                    self.rough_score(leading)
                ));
            }
            rough.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
            if best - self.rough_score(&rough[0]) <= 0.0 {
                break;
            }
        }
        let mut full: Vec<Hypothesis> = Vec::new();
        let leading = self.rough_score(&rough[0]);
        for candidate in rough.iter().take(REFINED) {
            if self.rough_score(candidate) > leading + HOPELESS {
                break;
            }
            let refined = self.refine(candidate, FULL, FULL_ITERATIONS);
            say(&format!(
                "  {:?} full {:.1} left {:.0}",
                refined.effects,
                self.score(&refined),
                refined.fit.cost() - self.evidence.count() as f64
            ));
            full.push(refined);
        }
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        full
    }

    /// Fits everything that is free in a hypothesis: the effects from where they are, what is tolerated from what was believed, because a model that
    /// lacks something bends it out of shape.
    pub fn refine(
        &self,
        hypothesis: &Hypothesis,
        stages: &[Stage],
        iterations: usize,
    ) -> Hypothesis {
        let fitted = &hypothesis.fit;
        let free: Vec<Free> = fitted
            .free
            .iter()
            .zip(&fitted.values)
            .map(|(f, value)| match f.prior {
                Prior::Normal { mean, .. } => Free { start: mean, ..*f },
                Prior::Flat => Free {
                    start: *value,
                    ..*f
                },
            })
            .collect();
        self.fitted(
            hypothesis.effects.clone(),
            &fitted.prediction.plant,
            &free,
            stages,
            iterations,
            Some(&fitted.prediction),
        )
    }
}

fn names(hypothesis: &Hypothesis) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = hypothesis.effects.iter().map(|e| e.name).collect();
    names.sort_unstable();
    names
}

/// Do two free quantities change the same number?
pub fn same(a: &Free, b: &Free, plant: &PlantParameters) -> bool {
    let value = (b.quantity.get)(plant);
    let mut changed = plant.clone();
    (a.quantity.set)(&mut changed, 1.7 * (a.quantity.get)(plant) + 1e-3);
    let after = (b.quantity.get)(&changed);
    !(value == after || (value.is_nan() && after.is_nan()))
}
