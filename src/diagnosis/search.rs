//! Which effects explain what the believed model leaves.

use super::evidence::{Evidence, Prediction};
use super::fit::{
    Effort, FULL, Fit, ROUGH, Stage, fit, foretold, jacobian, rough_noise, with_values,
};
use super::free::{Free, Prior, free_of};
use super::latent;
use super::scale::Scale;
use crate::effects::{Clues, Effect};
use crate::plant::{Latent, PlantParameters};
use rayon::prelude::*;

/// Iterations of the second look at those that promise most.
const LOOK: usize = 3;
/// How many get a second look.
const LOOKED_AT: usize = 7;
/// Iterations of a full fit.
const FULL_ITERATIONS: usize = 40;
/// Iterations of a rough fit without one of the effects.
const LIGHTER: usize = 8;
/// Rough cost over the leading one beyond which a hypothesis is not built upon [1].
const FAR_BEHIND: f64 = 2.0;
/// Effects at most.
const MOST_EFFECTS: usize = 3;
/// Hypotheses that are carried on from each number of effects.
const PARENTS: usize = 2;
/// Candidates of each that are fitted in full.
const REFINED: usize = 4;
/// Rough cost behind the best at which a hypothesis is given up [1].
const HOPELESS: f64 = 300.0;
/// Share of what a hypothesis leaves unexplained that one more effect must explain, or the search stagnates [1].
const STAGNATION: f64 = 0.5;
/// Cost of having looked at so many effects: twice the logarithm of their number [1].
pub const LOOK_ELSEWHERE: f64 = 7.0;

/// A set of effects, fitted together with what is tolerated.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    /// The effects.
    pub effects: Vec<&'static Effect>,
    /// The fit: tolerated quantities first, then the effects' in order.
    pub fit: Fit,
    /// Variables on which a term without a name depends, the surest first; empty where there is none. The term is in the description, its
    /// coefficients come last among what is free.
    pub depends_on: Vec<&'static str>,
}

impl Hypothesis {
    /// The term without a name, if there is one.
    pub fn unlisted(&self) -> Option<&Latent> {
        self.fit.prediction.plant.latent.as_ref()
    }

    /// Is the believed model all that it takes?
    pub fn finds_nothing(&self) -> bool {
        self.effects.is_empty() && self.unlisted().is_none()
    }

    /// How many of the free quantities are tolerated ones; the effects' and those of a term without a name follow.
    pub fn tolerated(&self, believed: &PlantParameters) -> usize {
        let own: usize = self
            .effects
            .iter()
            .map(|effect| (effect.parameters)(believed).len())
            .sum();
        self.fit.free.len() - own - latent::count(&self.fit.prediction.plant)
    }
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
    /// Effects that a link of its own has shown, with their numbers.
    pub shown: Vec<Shown>,
}

/// An effect that a link of its own has shown, such as a servo's in commands and encoders: what it found is what is believed of its numbers.
#[derive(Debug, Clone)]
pub struct Shown {
    /// The effect.
    pub effect: &'static Effect,
    /// All its numbers.
    pub numbers: Vec<Free>,
}

impl Search<'_> {
    /// The believed model within its tolerances, roughly.
    pub fn baseline(&self) -> Hypothesis {
        let effects = self.shown.iter().map(|shown| shown.effect).collect();
        let own = self.shown.iter().flat_map(|shown| &shown.numbers);
        let free: Vec<Free> = self.tolerated.iter().chain(own).copied().collect();
        self.fitted(effects, &self.believed, &free, ROUGH, 15, None)
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
            depends_on: Vec::new(),
        }
    }

    /// Penalty for the numbers of an effect: Schwarz's.
    pub fn penalty(&self, hypothesis: &Hypothesis) -> f64 {
        let numbers = hypothesis.fit.free.len() - hypothesis.tolerated(&self.believed);
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
        let clues = self.clues(from, &periodic, &bumps);
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
            .map(|(effect, start)| self.glance(from, effect, start, &stages[0]))
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
        let score = |hypothesis: &Hypothesis| match stages[0].guided {
            true => self.rough_score(hypothesis),
            false => self.score(hypothesis),
        };
        looked.sort_by(|a, b| score(a).total_cmp(&score(b)));
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

    /// Cost that a hypothesis with one more effect could come to by one step from a start.
    fn glance(
        &self,
        from: &Hypothesis,
        effect: &'static Effect,
        start: &[f64],
        stage: &Stage,
    ) -> f64 {
        let new = free_of(effect, &self.believed, start);
        let (mut free, mut columns) = self.beside(from, &new);
        let own = free.len();
        free.extend(new);
        let values: Vec<f64> = free.iter().map(|f| f.start).collect();
        let plant = with_values(&from.fit.prediction.plant, &free, &values);
        let there = self
            .evidence
            .predict(&plant, stage.guided, Some(&from.fit.prediction));
        columns.extend(jacobian(self.evidence, &there, &free, &values, own));
        foretold(self.evidence, &there, &free, &values, &columns, stage)
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
            depends_on: Vec::new(),
        }
    }

    /// The explanation that costs least, and those that come near: first roughly, then in full.
    ///
    /// Forward, one effect after the other, as long as one more explains what it must; backward, whatever the rest does as well without; at last
    /// once more forward with the finest measure, for effects too small to be seen roughly.
    pub fn run(&self, say: &mut dyn FnMut(&str)) -> Vec<Hypothesis> {
        let noise = rough_noise(self.evidence);
        let baseline = self.baseline();
        say(&format!(
            "baseline {:.0}, noise {noise:.0}",
            baseline.fit.rough
        ));
        let unexplained = baseline.clone();
        let scale = Scale::of(self.evidence, &baseline, noise);
        let mut levels = vec![vec![baseline]];
        let mut full: Vec<Hypothesis> = Vec::new();
        let mut tried: Vec<Vec<&'static str>> = vec![vec![]];
        while levels.len() <= MOST_EFFECTS && full.is_empty() {
            let parents = &levels[levels.len() - 1];
            let before = parents[0].fit.rough - noise;
            // Beside one that leaves noise alone, no other need be carried on.
            let carried = if before < scale.rough_spread() {
                1
            } else {
                PARENTS
            };
            let near = FAR_BEHIND * self.rough_score(&parents[0]);
            let carried: Vec<&Hypothesis> = parents
                .iter()
                .take(carried)
                .filter(|h| self.rough_score(h) <= near)
                .collect();
            let children = self.children(&carried, &mut tried, say);
            let Some(best) = children.first() else { break };
            if self.rough_score(best) >= self.rough_score(&parents[0]) {
                break;
            }
            let after = best.fit.rough - noise;
            let stuck = levels.len() > 1 && after > STAGNATION * before;
            if after < scale.rough_spread() {
                full = self.in_full(&children, &scale, say);
                full.retain(|h| scale.is_adequate(h));
            } else if stuck {
                // Nothing more helps: perhaps what there is explains all but what a held piston cannot show.
                full = self.in_full(parents, &scale, say);
                if !full.iter().any(|h| scale.is_adequate(h)) {
                    full = self.anew(parents, &scale, say);
                }
                full.retain(|h| scale.is_adequate(h));
            }
            levels.push(children);
        }
        if full.is_empty() {
            let mut all: Vec<Hypothesis> = levels.into_iter().flatten().collect();
            all.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
            full = self.in_full(&all, &scale, say);
        }
        self.eliminate(&mut full, say);
        self.add_small(&mut full, &scale, say);
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        self.prefer_plain(&mut full, &scale);
        self.add_unlisted(&mut full, &unexplained, &scale, say);
        full
    }

    /// Of laws that exclude one another puts the plainest first that explains as much but for what idealisation leaves: a richer law bends to the errors
    /// of a plain one.
    fn prefer_plain(&self, full: &mut Vec<Hypothesis>, scale: &Scale) {
        let Some(best) = full.first() else { return };
        let allowed = scale.material_in_full(best.fit.cost());
        let plainer = |h: &&Hypothesis| {
            h.fit.free.len() < best.fit.free.len()
                && h.fit.cost() - best.fit.cost() < allowed
                && stands_for(h, best)
        };
        let plainest = (full.iter().enumerate())
            .filter(|(_, h)| plainer(h))
            .min_by_key(|(_, h)| h.fit.free.len());
        if let Some((index, _)) = plainest {
            let chosen = full.remove(index);
            full.insert(0, chosen);
        }
    }

    /// Where no known effect explains the mismatch, puts a term without a name first if it explains more.
    fn add_unlisted(
        &self,
        full: &mut Vec<Hypothesis>,
        baseline: &Hypothesis,
        scale: &Scale,
        say: &mut dyn FnMut(&str),
    ) {
        let Some(best) = full.first() else { return };
        if scale.is_explained(best) {
            return;
        }
        let mut bases = vec![baseline.clone()];
        if scale.is_half_explained(best) {
            bases.push(best.clone());
        }
        let mut found: Vec<Hypothesis> = bases
            .iter()
            .filter_map(|base| self.latent(base, say))
            .collect();
        found.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        if let Some(first) = found.into_iter().next()
            && self.score(&first) < self.score(&full[0])
        {
            full.insert(0, first);
        }
    }

    /// Hypotheses of one effect more, those that lead fitted roughly with everything free; best first.
    fn children(
        &self,
        parents: &[&Hypothesis],
        tried: &mut Vec<Vec<&'static str>>,
        say: &mut dyn FnMut(&str),
    ) -> Vec<Hypothesis> {
        let mut children = Vec::new();
        for parent in parents {
            let score = self.rough_score(parent);
            for candidate in self.screen(parent, ROUGH) {
                let gain = score - self.rough_score(&candidate);
                say(&format!("  {:?} rough gain {gain:.1}", candidate.effects));
                let names = names(&candidate);
                if gain > 0.0 && !tried.contains(&names) {
                    tried.push(names);
                    children.push(candidate);
                }
            }
        }
        children.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        let near = children.first().map_or(0.0, |h| self.rough_score(h));
        for leading in children.iter_mut().take(REFINED) {
            if leading.effects.len() > 1 && self.rough_score(leading) > 3.0 * near {
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
        children.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        // What is far behind stays there.
        let near = FAR_BEHIND * children.first().map_or(0.0, |h| self.rough_score(h));
        for leading in children.iter_mut().take(REFINED) {
            if self.rough_score(leading) < near {
                self.choose(leading);
            }
        }
        children.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        children
    }

    /// Full fits of those that are not hopeless, best first. Of laws that exclude one another the richer ones are spared where a plain one leaves nothing
    /// that would be worth a mention.
    fn in_full(
        &self,
        rough: &[Hypothesis],
        scale: &Scale,
        say: &mut dyn FnMut(&str),
    ) -> Vec<Hypothesis> {
        let leading = rough.first().map_or(0.0, |h| self.rough_score(h));
        let mut candidates: Vec<&Hypothesis> = rough
            .iter()
            .take(REFINED)
            .take_while(|h| self.rough_score(h) <= leading + HOPELESS)
            .collect();
        // The plainest first.
        candidates.sort_by_key(|h| h.fit.free.len());
        let mut full: Vec<Hypothesis> = Vec::new();
        for candidate in candidates {
            let spared = |done: &Hypothesis| {
                stands_for(done, candidate) && scale.leaves_nothing_material(done)
            };
            if full.iter().any(spared) {
                continue;
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

    /// Full fits of those that are not hopeless from where their last effect may start instead of from their rough fits, until one is adequate: what a
    /// held piston does not show, such as sticking, a rough fit may have driven out.
    fn anew(
        &self,
        rough: &[Hypothesis],
        scale: &Scale,
        say: &mut dyn FnMut(&str),
    ) -> Vec<Hypothesis> {
        let leading = rough.first().map_or(0.0, |h| self.rough_score(h));
        let near = |h: &&Hypothesis| self.rough_score(h) <= leading + HOPELESS;
        let mut candidates: Vec<&Hypothesis> =
            rough.iter().take(REFINED).take_while(near).collect();
        // The richest law first: it has most to lose.
        candidates.sort_by_key(|h| std::cmp::Reverse(h.fit.free.len()));
        for candidate in candidates {
            let Some(effect) = candidate.effects.last() else {
                continue;
            };
            for start in (effect.starts)(&self.clues(candidate, &[], &[])) {
                let mut other = candidate.clone();
                let own = other.fit.values.len() - start.len();
                other.fit.values[own..].copy_from_slice(&start);
                let refined = self.refine(&other, FULL, FULL_ITERATIONS);
                let left = refined.fit.cost() - self.evidence.count() as f64;
                say(&format!("  {:?} anew left {left:.0}", refined.effects));
                if scale.is_adequate(&refined) {
                    return vec![refined];
                }
            }
        }
        Vec::new()
    }

    /// What an effect may be told when it is asked where to start.
    fn clues<'b>(&self, from: &'b Hypothesis, periodic: &'b [f64], bumps: &'b [f64]) -> Clues<'b> {
        let readings = self
            .evidence
            .recordings
            .iter()
            .flat_map(|m| m.readings[2].iter());
        Clues {
            plant: &from.fit.prediction.plant,
            largest_force: readings
                .filter(|f| f.is_finite())
                .fold(0.0, |a, b| b.max(a)),
            periodic,
            bumps,
        }
    }

    /// Takes effects out of the best hypothesis as long as it scores better without.
    fn eliminate(&self, full: &mut Vec<Hypothesis>, say: &mut dyn FnMut(&str)) {
        while let Some(best) = full.first()
            && best.effects.len() > 1 + self.shown.len()
        {
            let score = self.score(best);
            let mut fewer: Vec<Hypothesis> = (self.shown.len()..best.effects.len())
                .filter_map(|index| self.without(best, index))
                .collect();
            fewer.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            if fewer.is_empty() {
                break;
            }
            let lighter = fewer.swap_remove(0);
            say(&format!(
                "  without: {:?} {:.1} against {score:.1}",
                lighter.effects,
                self.score(&lighter)
            ));
            let better = self.score(&lighter) < score;
            full.push(lighter);
            full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            if !better {
                break;
            }
        }
    }

    /// A hypothesis without one of its effects, fitted in full from where it was; what the effect freed is held to its tolerance again. Nothing where a
    /// rough fit is hopeless already.
    fn without(&self, hypothesis: &Hypothesis, index: usize) -> Option<Hypothesis> {
        let fit = &hypothesis.fit;
        let plant = &fit.prediction.plant;
        let counts: Vec<usize> = hypothesis
            .effects
            .iter()
            .map(|e| (e.parameters)(&self.believed).len())
            .collect();
        let own = fit.free.len() - counts.iter().sum::<usize>();
        let start = own + counts[..index].iter().sum::<usize>();
        let kept = fit.free.iter().zip(&fit.values).enumerate();
        let others: Vec<Free> = kept
            .filter(|(i, _)| *i >= own && !(start..start + counts[index]).contains(i))
            .map(|(_, (f, value))| Free {
                start: *value,
                ..*f
            })
            .collect();
        let mut free: Vec<Free> = self
            .tolerated
            .iter()
            .filter(|f| !others.iter().any(|o| same(o, f, &self.believed)))
            .map(|f| Free {
                start: f.clamp((f.quantity.get)(plant)),
                ..*f
            })
            .collect();
        free.extend(others);
        let mut effects = hypothesis.effects.clone();
        effects.remove(index);
        let rough = self.fitted(effects, &self.believed, &free, ROUGH, LIGHTER, None);
        if self.rough_score(&rough) > self.rough_score(hypothesis) + HOPELESS {
            return None;
        }
        for (f, value) in free.iter_mut().zip(&rough.fit.values) {
            f.start = *value;
        }
        let effects = rough.effects;
        Some(self.fitted(effects, &self.believed, &free, FULL, FULL_ITERATIONS, None))
    }

    /// Adds effects that only the finest measure shows, where the best hypothesis is otherwise good.
    fn add_small(&self, full: &mut Vec<Hypothesis>, scale: &Scale, say: &mut dyn FnMut(&str)) {
        while let Some(best) = full.first()
            && best.effects.len() < MOST_EFFECTS + self.shown.len()
            && scale.is_adequate(best)
        {
            let score = self.score(best);
            let least = scale.material_in_full(best.fit.cost());
            let precise = &FULL[FULL.len() - 1..];
            let Some(more) = self.screen(best, precise).into_iter().next() else {
                return;
            };
            if score - self.score(&more) <= least {
                return;
            }
            let more = self.refine(&more, precise, FULL_ITERATIONS);
            let gain = score - self.score(&more);
            say(&format!("  small: {:?} gain {gain:.1}", more.effects));
            if gain <= least {
                return;
            }
            full.insert(0, more);
        }
    }

    /// Where an effect has a number without values between, takes the one that fits best roughly, from where the fit is: what is tolerated too, which is
    /// bent by the other effects no more than before.
    fn choose(&self, hypothesis: &mut Hypothesis) {
        let parameters = hypothesis
            .effects
            .iter()
            .flat_map(|effect| (effect.parameters)(&self.believed));
        let parameters: Vec<_> = parameters.collect();
        let own = hypothesis.fit.free.len() - parameters.len();
        for (index, parameter) in parameters.iter().enumerate() {
            let present = hypothesis.fit.values[own + index];
            let mut tried: Vec<Hypothesis> = parameter
                .choices
                .par_iter()
                .filter(|choice| **choice != present)
                .map(|choice| {
                    let fit = &hypothesis.fit;
                    let mut free = fit.free.clone();
                    for (f, value) in free.iter_mut().zip(&fit.values) {
                        f.start = *value;
                    }
                    free[own + index].start = *choice;
                    let (plant, effects) = (&fit.prediction.plant, hypothesis.effects.clone());
                    self.fitted(effects, plant, &free, ROUGH, 6, Some(&fit.prediction))
                })
                .collect();
            tried.sort_by(|a, b| a.fit.rough.total_cmp(&b.fit.rough));
            if let Some(best) = tried.into_iter().next()
                && best.fit.rough < hypothesis.fit.rough
            {
                *hypothesis = best;
            }
        }
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

/// Are the effects of two hypotheses the same but for laws that exclude one another?
pub(super) fn stands_for(one: &Hypothesis, other: &Hypothesis) -> bool {
    let covered = |a: &Hypothesis, b: &Hypothesis| {
        a.effects
            .iter()
            .all(|effect| b.effects.iter().any(|known| known.excludes(effect)))
    };
    one.effects.len() == other.effects.len() && covered(one, other) && covered(other, one)
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
