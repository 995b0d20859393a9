//! Which effects explain what the nominal model leaves.

mod alike;
mod beyond;
pub mod detectable;
pub(super) mod finish;
mod formulas;
pub(super) mod influence;
pub mod kept;
pub mod known;
mod modular;
pub mod progress;
pub mod ranking;
mod rivals;
pub mod ruled_out;
pub(super) mod scale;
mod screen;
pub(super) mod tried;

use self::progress::{Observer, Step};
use self::scale::Scale;
use super::fit::free::Free;
use super::fit::hypothesis::{Hypothesis, is_equivalent};
use super::fit::model_error::ModelError;
use super::fit::{Limit, ROUGH, Refit, Stage, fit, rough_noise};
use super::recordings::evidence::{Evidence, Prediction};
use super::settings::Settings;
use crate::effects::Effect;
use crate::plant::{DeviceParts, PlantInputs, PlantParameters};
use rayon::prelude::*;

/// Everything a search needs.
#[derive(Clone)]
pub struct Search<'a> {
    /// The recordings.
    pub evidence: &'a Evidence,
    /// The nominal rig.
    pub nominal: PlantParameters,
    /// Tolerated quantities.
    pub tolerated: Vec<Free>,
    /// Effects that may be at work.
    pub candidates: Vec<&'static Effect>,
    /// Effects that a link of its own has shown, with their numbers.
    pub shown: Vec<EstablishedEffect>,
    /// Iterations of the second look at an effect that promises most.
    pub look: usize,
    /// Effects at most, beside those shown.
    pub most_effects: usize,
    /// What explanations leave beyond noise, by which their scores are weighed.
    pub model_error: ModelError,
    /// Inputs of the recording that is to be predicted: an explanation must be finite there too.
    pub unseen: Option<&'a PlantInputs>,
    /// Thresholds.
    pub settings: Settings,
}

/// An effect that a link of its own has shown, such as a servo's in commands and encoders: what it found is nominal for its numbers.
#[derive(Debug, Clone)]
pub struct EstablishedEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// All its numbers.
    pub numbers: Vec<Free>,
}

/// An explanation that was fitted roughly: the piston held to its measured motion, errors in time forgiven.
#[derive(Debug, Clone)]
pub struct RoughFit {
    /// Names of its effects.
    pub effects: Vec<&'static str>,
    /// Cost beyond that of the best explanation by the same rough measure, penalties included [1].
    pub behind: f64,
    /// Share of the mismatch that it explains [1].
    pub explained_share: Option<f64>,
}

impl Search<'_> {
    /// The nominal model within its tolerances, roughly.
    pub fn baseline(&self) -> Hypothesis {
        let effects = self.shown.iter().map(|shown| shown.effect).collect();
        let own = self.shown.iter().flat_map(|shown| &shown.numbers);
        let free: Vec<Free> = self.tolerated.iter().chain(own).copied().collect();
        self.fitted(effects, (&self.nominal, None), &free, ROUGH, Limit::of(15))
    }

    pub(super) fn fitted(
        &self,
        effects: Vec<&'static Effect>,
        from: (&PlantParameters, Option<&Prediction>),
        free: &[Free],
        stages: &[Stage],
        limit: Limit,
    ) -> Hypothesis {
        Hypothesis {
            effects,
            fit: fit(self.evidence, from, (free, &[]), stages, limit),
            depends_on: Vec::new(),
        }
    }

    /// Whether the recordings are of a cell, in which a simulation takes long.
    pub(super) fn is_in_cell(&self) -> bool {
        let mut recordings = self.evidence.recordings.iter();
        recordings.any(|recording| recording.inputs.cell.is_some())
    }

    /// A checkpoint: whether the search is to end with the best that it has ([`super::effort`]).
    pub(super) fn is_spent(&self) -> bool {
        self.evidence.effort.is_spent()
    }

    /// Fits everything that is free in a hypothesis once more.
    pub fn refit(&self, hypothesis: &Hypothesis, refit: Refit<'_>) -> Hypothesis {
        let fitted = &hypothesis.fit;
        let from = (&fitted.prediction.plant, Some(&fitted.prediction));
        let effects = hypothesis.effects.clone();
        Hypothesis {
            depends_on: hypothesis.depends_on.clone(),
            ..self.fitted(
                effects,
                from,
                &self.settled(refit.free(fitted)),
                refit.stages,
                refit.limit,
            )
        }
    }

    /// Penalty for the numbers of an effect: Schwarz's.
    pub fn penalty(&self, hypothesis: &Hypothesis) -> f64 {
        let numbers = hypothesis.fit.free.len() - hypothesis.tolerated(&self.nominal);
        numbers as f64 * (self.evidence.count() as f64).ln()
            + self.settings.look_elsewhere * hypothesis.effects.len() as f64
    }

    /// Cost of a rough fit with its penalty.
    pub fn rough_score(&self, hypothesis: &Hypothesis) -> f64 {
        hypothesis.fit.rough + self.penalty(hypothesis)
    }

    /// Cost with its penalty.
    pub fn score(&self, hypothesis: &Hypothesis) -> f64 {
        let fit = &hypothesis.fit;
        let misfit = match self.model_error.is_none() {
            true => fit.misfit,
            false => (self.model_error).cost(self.evidence, &fit.prediction.residuals),
        };
        misfit + fit.prior + self.penalty(hypothesis)
    }

    /// The explanation that costs least, and those that come near: first roughly, then in full.
    ///
    /// Forward, one effect after the other, as long as one more explains what it must; backward, whatever the rest does as well without; at last
    /// once more forward with the finest measure, for effects too small to be seen roughly.
    pub fn run(&self, observer: &mut Observer<'_>) -> Vec<Hypothesis> {
        self.run_with_rough(observer).0
    }

    /// The same, with what was fitted roughly on the way, and the model error by which they were weighed.
    pub fn run_with_rough(
        &self,
        observer: &mut Observer<'_>,
    ) -> (Vec<Hypothesis>, Vec<RoughFit>, ModelError) {
        let noise = rough_noise(self.evidence);
        let baseline = self.baseline();
        let detail = format!("cost {:.0}, noise {noise:.0}", baseline.fit.rough);
        observer(&Step::Baseline.of(&baseline, detail));
        let unexplained = baseline.clone();
        let scale = Scale::of(self.evidence, &baseline, noise);
        let mut climb = self.climb(baseline, &scale, observer);
        let mut all: Vec<Hypothesis> = climb.levels.into_iter().flatten().collect();
        all.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        let mut full = climb.full;
        if full.is_empty() {
            full = self.in_full(&all, &scale, &mut climb.done, observer);
        }
        self.eliminate(&mut full, observer);
        self.add_plainer(&mut full, &all, observer);
        let found = (full, all);
        self.concluded(found, (&unexplained, &scale), &mut climb.asked, observer)
    }

    /// From full fits to an answer.
    fn concluded(
        &self,
        (mut full, all): (Vec<Hypothesis>, Vec<Hypothesis>),
        (unexplained, scale): (&Hypothesis, &Scale),
        asked: &mut Vec<Vec<&'static str>>,
        observer: &mut Observer<'_>,
    ) -> (Vec<Hypothesis>, Vec<RoughFit>, ModelError) {
        // Before what they leave is a model error, by which all of them would do.
        self.add_alike(&mut full, scale, observer);
        let noise = rough_noise(self.evidence);
        let shows_when_held = |h: &Hypothesis| h.fit.rough - noise > scale.rough_spread();
        if (full.first()).is_some_and(|best| !shows_when_held(best) && !scale.is_adequate(best)) {
            self.add_small(&mut full, scale, observer);
        }
        let weighed = self.weighed(&mut full, observer);
        weighed.add_small(&mut full, scale, observer);
        full.sort_by(|a, b| weighed.score(a).total_cmp(&weighed.score(b)));
        weighed.prefer_plain(&mut full, scale);
        weighed.add_unlisted(&mut full, (unexplained, &all[..], asked), scale, observer);
        weighed.simplify_beside_term(&mut full, scale, observer);
        weighed.add_nominal(&mut full, observer);
        weighed.drop_below_noise(&mut full, scale, observer);
        weighed.add_one_for_two(&mut full, observer);
        weighed.add_close(&mut full, &all, scale, observer);
        weighed.add_beyond(&mut full, (unexplained, &all), observer);
        let roughly = self.tried_roughly(&full, &all, (unexplained, noise));
        (full, roughly, weighed.model_error)
    }

    /// Forward, one effect after the other, until an explanation is adequate, or one more explains no more. Where effects do not leave noise alone, a formula
    /// is asked for beside fewer of them before a further one is: two laws of the list are no more likely than one that it does not hold, and a full fit of
    /// laws that are not there costs most of all.
    fn climb(&self, baseline: Hypothesis, scale: &Scale, observer: &mut Observer<'_>) -> Climb {
        let noise = rough_noise(self.evidence);
        let mut climb = Climb {
            levels: vec![vec![baseline]],
            full: Vec::new(),
            done: Vec::new(),
            asked: Vec::new(),
        };
        let mut tried: Vec<Vec<&'static str>> = vec![vec![]];
        while climb.levels.len() <= self.most_effects && climb.full.is_empty() && !self.is_spent() {
            let parents = &climb.levels[climb.levels.len() - 1];
            let before = parents[0].fit.rough - noise;
            // Beside one that leaves noise alone, no other need be carried on.
            let carried = if before < scale.rough_spread() {
                1
            } else {
                self.settings.carried_on
            };
            let near = self.settings.far_behind * self.rough_score(&parents[0]);
            let carried: Vec<&Hypothesis> = parents
                .iter()
                .take(carried)
                .filter(|h| self.rough_score(h) <= near)
                .collect();
            let mut children = self.children(&carried, &mut tried, observer);
            // Derivatives are asked for once more of those that may be carried on.
            for h in children.iter_mut().skip(self.settings.carried_on) {
                h.fit.columns = Vec::new();
            }
            let place = climb.levels.len() - 1;
            for h in &mut climb.levels[place] {
                h.fit.columns = Vec::new();
            }
            let parents = &climb.levels[place];
            let Some(best) = children.first() else { break };
            if self.rough_score(best) >= self.rough_score(&parents[0]) {
                break;
            }
            if self.is_spent() {
                climb.levels.push(children);
                break;
            }
            let after = best.fit.rough - noise;
            let stuck = climb.levels.len() > 1 && after > self.settings.stagnation * before;
            let leaves_noise = after < scale.rough_spread();
            if leaves_noise {
                climb.full = self.in_full(&children, scale, &mut climb.done, observer);
                climb.full.retain(|h| scale.is_adequate(h));
            }
            let asks = climb.levels.len() > 1 || self.asks_early(best, scale);
            if climb.full.is_empty() && asks && !scale.is_idealised(best) {
                self.formulas_beside_fewer(&mut climb, &children, scale, observer);
            } else if climb.full.first().is_some_and(|best| self.found(best) > 1) {
                self.add_one_law(&mut climb, scale, observer);
            }
            if climb.full.is_empty() && stuck && !leaves_noise && !self.is_spent() {
                // Nothing more helps: perhaps what there is explains all but what a held piston cannot show.
                let parents = &climb.levels[climb.levels.len() - 1];
                climb.full = self.in_full(parents, scale, &mut climb.done, observer);
                if !climb.full.iter().any(|h| scale.is_adequate(h)) {
                    climb.full = self.anew(parents, scale, observer);
                }
                climb.full.retain(|h| scale.is_adequate(h));
            }
            climb.levels.push(children);
        }
        climb
    }

    /// Effects of a hypothesis beside those that a link of its own has shown.
    fn found(&self, hypothesis: &Hypothesis) -> usize {
        hypothesis.effects.len() - self.shown.len()
    }

    /// What was fitted roughly, beside the best explanation and the rough cost of the nominal model and of noise.
    fn tried_roughly(
        &self,
        full: &[Hypothesis],
        all: &[Hypothesis],
        (unexplained, noise): (&Hypothesis, f64),
    ) -> Vec<RoughFit> {
        let before = unexplained.fit.rough - noise;
        let reference = full
            .first()
            .map_or(0.0, |best| self.rough_reference(best, all));
        let roughly = all.iter().map(|hypothesis| RoughFit {
            effects: hypothesis.effects.iter().map(|e| e.name).collect(),
            behind: self.rough_score(hypothesis) - reference,
            explained_share: (before > 0.0)
                .then(|| ((unexplained.fit.rough - hypothesis.fit.rough) / before).clamp(0.0, 1.0)),
        });
        roughly.collect()
    }

    /// The search with scores weighed by what the best explanation leaves beyond noise: where that is much, effects that follow it are taken out again. Of
    /// a part of the device that is the noise already.
    fn weighed(&self, full: &mut Vec<Hypothesis>, observer: &mut Observer<'_>) -> Self {
        let mut weighed = self.clone();
        if self.nominal.parts != DeviceParts::Whole {
            return weighed;
        }
        for round in 0..self.settings.rounds {
            let Some(best) = full.first().filter(|_| !self.is_spent()) else {
                break;
            };
            let mut left = ModelError::of(self.evidence, &best.fit.prediction);
            if round == 0 && !left.is_none() {
                weighed.settle_regulator(full, observer);
                left = ModelError::of(self.evidence, &full[0].fit.prediction);
            }
            if left == weighed.model_error {
                break;
            }
            weighed.model_error = left;
            full.sort_by(|a, b| weighed.score(a).total_cmp(&weighed.score(b)));
            weighed.eliminate(full, observer);
        }
        weighed
    }

    /// Hypotheses of one effect more, those that lead fitted roughly with everything free; best first.
    fn children(
        &self,
        parents: &[&Hypothesis],
        tried: &mut Vec<Vec<&'static str>>,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let mut children = Vec::new();
        for (place, parent) in parents.iter().enumerate() {
            if place > 0 && self.is_spent() {
                break;
            }
            let score = self.rough_score(parent);
            for candidate in self.screen(parent, ROUGH, f64::INFINITY) {
                let gain = score - self.rough_score(&candidate);
                observer(&Step::RoughFit.of(&candidate, format!("gain {gain:.1}")));
                let names = candidate.names();
                if gain > 0.0 && !tried.contains(&names) {
                    tried.push(names);
                    children.push(candidate);
                }
            }
        }
        children.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        let near = children.first().map_or(0.0, |h| self.rough_score(h));
        for leading in children.iter_mut().take(self.settings.fitted_in_full) {
            if leading.effects.len() > 1 && self.rough_score(leading) > 3.0 * near
                || self.is_spent()
            {
                break;
            }
            let refitted = self.refit(leading, Refit::ROUGH);
            if refitted.fit.rough < leading.fit.rough {
                *leading = refitted;
            }
            let detail = format!("score {:.1}", self.rough_score(leading));
            observer(&Step::RoughFit.of(leading, detail));
        }
        children.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        // What is far behind stays there.
        let near = self.settings.far_behind * children.first().map_or(0.0, |h| self.rough_score(h));
        for leading in children.iter_mut().take(self.settings.fitted_in_full) {
            if self.rough_score(leading) < near && !self.is_spent() {
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
        done: &mut Vec<Refined>,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let leading = rough.first().map_or(0.0, |h| self.rough_score(h));
        let mut candidates: Vec<&Hypothesis> = rough
            .iter()
            .take(self.settings.fitted_in_full)
            .take_while(|h| self.rough_score(h) <= leading + self.settings.given_up)
            .collect();
        if self.is_spent() {
            candidates.truncate(1);
        }
        // The plainest first.
        candidates.sort_by_key(|h| h.fit.free.len());
        let mut full: Vec<Hypothesis> = Vec::new();
        for candidate in candidates {
            let spared = |plain: &Hypothesis| {
                is_equivalent(plain, candidate) && scale.leaves_nothing_material(plain)
            };
            if full.iter().any(spared) {
                continue;
            }
            if !full.is_empty() && self.is_spent() {
                break;
            }
            let before = |known: &&Refined| {
                known.rough == candidate.fit.rough && known.full.names() == candidate.names()
            };
            if let Some(known) = done.iter().find(before) {
                full.push(known.full.clone());
                continue;
            }
            let refined = self.refit(candidate, Refit::FULL);
            let left = refined.fit.cost() - self.evidence.count() as f64;
            let detail = format!("score {:.1}, left {left:.0}", self.score(&refined));
            observer(&Step::FullFit.of(&refined, detail));
            done.push(Refined {
                rough: candidate.fit.rough,
                full: refined.clone(),
            });
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
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let leading = rough.first().map_or(0.0, |h| self.rough_score(h));
        let near = |h: &&Hypothesis| self.rough_score(h) <= leading + self.settings.given_up;
        let mut candidates: Vec<&Hypothesis> = rough
            .iter()
            .take(self.settings.fitted_in_full)
            .take_while(near)
            .collect();
        // The richest law first: it has most to lose.
        candidates.sort_by_key(|h| std::cmp::Reverse(h.fit.free.len()));
        let starts = candidates.into_iter().flat_map(|candidate| {
            let effect = candidate.effects.last();
            let starts = effect.map(|effect| effect.starts(&self.clues(candidate, &[], &[])));
            starts
                .into_iter()
                .flatten()
                .map(move |start| (candidate, start))
        });
        for (candidate, start) in starts.take(MOST_ANEW) {
            if self.is_spent() {
                break;
            }
            let mut other = candidate.clone();
            let own = other.numbers_of(&self.nominal, other.effects.len() - 1);
            other.fit.values[own].copy_from_slice(&start);
            let refined = self.refit(&other, Refit::FULL);
            let left = refined.fit.cost() - self.evidence.count() as f64;
            observer(&Step::FullFit.of(&refined, format!("from the start, left {left:.0}")));
            if scale.is_adequate(&refined) {
                return vec![refined];
            }
        }
        Vec::new()
    }

    /// Where an effect has a number without values between, takes the one that fits best roughly, from where the fit is: what is tolerated too, which is
    /// bent by the other effects no more than before.
    fn choose(&self, hypothesis: &mut Hypothesis) {
        let parameters = hypothesis
            .effects
            .iter()
            .flat_map(|effect| effect.parameters(&self.nominal));
        let parameters: Vec<_> = parameters.collect();
        let own = hypothesis.tolerated(&self.nominal);
        for (index, parameter) in parameters.iter().enumerate() {
            let present = hypothesis.fit.values[own + index];
            let mut tried: Vec<Hypothesis> = parameter
                .choices
                .par_iter()
                .filter(|choice| **choice != present)
                .map(|choice| {
                    let fit = &hypothesis.fit;
                    let mut free = fit.free_from_here();
                    free[own + index].start = *choice;
                    let from = (&fit.prediction.plant, Some(&fit.prediction));
                    let effects = hypothesis.effects.clone();
                    self.fitted(effects, from, &free, ROUGH, Limit::of(6))
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
}

/// Full fits from where an effect may start, at most.
const MOST_ANEW: usize = 4;

/// What going forward has come to.
struct Climb {
    /// Explanations that were fitted roughly, by their number of effects, the best of each number first.
    levels: Vec<Vec<Hypothesis>>,
    /// Those that are adequate, fitted in full, best first.
    full: Vec<Hypothesis>,
    /// Full fits that were made.
    done: Vec<Refined>,
    /// Names of the effects beside which formulas were asked for.
    asked: Vec<Vec<&'static str>>,
}

/// A full fit made before.
struct Refined {
    /// Cost of the rough fit that it began with [1].
    rough: f64,
    full: Hypothesis,
}

/// Whether two free quantities change the same number.
pub fn same(a: &Free, b: &Free, plant: &PlantParameters) -> bool {
    let value = b.quantity.get(plant);
    let mut changed = plant.clone();
    a.quantity
        .set(&mut changed, 1.7 * a.quantity.get(plant) + 1e-3);
    let after = b.quantity.get(&changed);
    !(value == after || (value.is_nan() && after.is_nan()))
}
