//! Which effects explain what the believed model leaves.

use super::evidence::Evidence;
use super::fit::{Effort, Fit, fit};
use super::free::{Free, free_of};
use crate::effects::{CATALOGUE, Clues, Effect};
use crate::plant::PlantParameters;

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
        let numbers = hypothesis.fit.free.len() - self.tolerated.len();
        numbers as f64 * (self.evidence.count() as f64).ln()
    }

    /// Cost with its penalty.
    pub fn score(&self, hypothesis: &Hypothesis) -> f64 {
        hypothesis.fit.cost() + self.penalty(hypothesis)
    }

    /// What more each effect could explain, roughly: columns of what is free already are taken as they are.
    pub fn screen(&self, from: &Hypothesis, iterations: usize) -> Vec<Hypothesis> {
        let periodic = super::spectrum::strongest(self.evidence, &from.fit.prediction);
        let readings = self.evidence.recordings.iter().flat_map(|m| m.readings[2].iter());
        let clues = Clues {
            plant: &from.fit.prediction.plant,
            largest_force: readings.filter(|f| f.is_finite()).fold(0.0, |a, b| b.max(a)),
            periodic: &periodic,
        };
        let mut found: Vec<Hypothesis> = Vec::new();
        for effect in CATALOGUE {
            let excluded = from.effects.iter().any(|e| e.name == effect.name || (e.group.is_some() && e.group == effect.group));
            if excluded { continue; }
            let mut best: Option<Hypothesis> = None;
            for start in (effect.starts)(&clues) {
                let mut free: Vec<Free> = from.fit.free.iter().zip(&from.fit.values).map(|(f, v)| Free { start: *v, ..*f }).collect();
                let new = free_of(effect, &self.believed, &start);
                // What an effect frees is no longer held to its tolerance.
                let mut frozen: Vec<Vec<f64>> = Vec::new();
                let mut kept = Vec::new();
                for (f, column) in free.drain(..).zip(&from.fit.columns) {
                    if new.iter().any(|n| same(n, &f, &self.believed)) { continue; }
                    kept.push(f);
                    frozen.push(column.clone());
                }
                kept.extend(new);
                let mut plant = from.fit.prediction.plant.clone();
                for f in &kept { (f.quantity.set)(&mut plant, f.start); }
                let fitted = fit(self.evidence, &plant, &kept, Effort { iterations, frozen: &frozen, longest_step: 3.0 }, Some(&from.fit.prediction));
                if best.as_ref().is_none_or(|b| fitted.cost() < b.fit.cost()) {
                    let mut effects = from.effects.clone();
                    effects.push(effect);
                    best = Some(Hypothesis { effects, fit: fitted });
                }
            }
            found.extend(best);
        }
        found.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        found
    }

    /// Fits everything that is free in a hypothesis from where it is.
    pub fn refine(&self, hypothesis: &Hypothesis, iterations: usize) -> Hypothesis {
        let free: Vec<Free> = hypothesis.fit.free.iter().zip(&hypothesis.fit.values).map(|(f, v)| Free { start: *v, ..*f }).collect();
        Hypothesis {
            effects: hypothesis.effects.clone(),
            fit: fit(self.evidence, &hypothesis.fit.prediction.plant, &free, Effort { iterations, frozen: &[], longest_step: 3.0 }, Some(&hypothesis.fit.prediction)),
        }
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
