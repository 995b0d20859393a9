//! From full fits to an answer: what is not needed is taken out, what only the finest measure shows is put in, of equals the plainest comes first.

use super::super::fit::{FINEST, FULL, Limit, ROUGH, Refit, Stage, Start, rough_noise};
use super::progress::{Observer, Step};
use super::scale::Scale;
use super::{Search, same};
use crate::diagnosis::fit::cross_validation::{Depth, left_out};
use crate::diagnosis::fit::free::{Free, free_of};
use crate::diagnosis::fit::hypothesis::{Hypothesis, covers, is_equivalent};
use crate::effects::Effect;
use crate::plant::{DeviceParts, PlantParameters};

/// Standard deviations by which two fits' costs differ by chance in a measure that they were not fitted to, of a chi-square of as many numbers as are free [1].
const CHANCE: f64 = 6.0;
/// Close rivals that are fitted in full beside those that the search has fitted, at most.
const MOST_CLOSE: usize = 6;
/// Effects that only the finest measure shows which are fitted, of those that promise most.
const MOST_SMALL: usize = 3;
/// Iterations of a rough fit without one of the effects.
pub(super) const LIGHTER: usize = 8;
/// The last stages of a full fit, for what is all but there.
pub(super) const LAST: &[Stage] = FULL.split_at(FULL.len() - 2).1;

/// A fit again from where a richer hypothesis stands.
fn again(richer: &Hypothesis) -> Refit<'_> {
    Refit {
        start: Start::Where(&richer.fit.prediction.plant),
        stages: LAST,
        ..Refit::FULL
    }
}

/// Whether two hypotheses have the same term beside their effects, or neither has one: formulas by their text, curves by where they act and over what.
fn same_term(one: &Hypothesis, other: &Hypothesis) -> bool {
    let described = |h: &Hypothesis| {
        let formula = h
            .formula()
            .map(|formula| formula.law.expression.text().to_owned());
        h.unlisted().map(|term| (term.port, term.variable, formula))
    };
    described(one) == described(other)
}

impl Search<'_> {
    /// Fits in full what says the same as the best hypothesis with plainer laws, where that has not been done: what the best was taken from may have had
    /// an effect more, that no plain law was tried without.
    pub(super) fn add_plainer(
        &self,
        full: &mut Vec<Hypothesis>,
        rough: &[Hypothesis],
        observer: &mut Observer<'_>,
    ) {
        let Some(best) = full.first().filter(|_| !self.is_spent()) else {
            return;
        };
        let has_term = best.unlisted().is_some();
        let plainer = |h: &&Hypothesis| {
            !has_term
                && h.fit.free.len() < best.fit.free.len()
                && is_equivalent(h, best)
                && !full.iter().any(|known| known.names() == h.names())
        };
        let mut more: Vec<Hypothesis> = rough
            .iter()
            .filter(plainer)
            .map(|h| self.refit(h, Refit::FULL))
            .collect();
        // Of a part of the device all such variants are fitted and reported (`super::ruled_out`).
        let own = match self.nominal.parts {
            DeviceParts::Whole => self.shown.len()..best.effects.len(),
            _ => 0..0,
        };
        for index in own {
            let effect = best.effects[index];
            let numbers = |e: &Effect| e.parameters(&self.nominal).len();
            let plain = |e: &&&'static Effect| e.excludes(effect) && numbers(e) < numbers(effect);
            for plain in self.candidates.iter().filter(plain) {
                let Some(other) = self.exchanged(best, index, plain) else {
                    continue;
                };
                let known = |known: &Hypothesis| {
                    known.names() == other.names() && known.unlisted().is_some() == has_term
                };
                if !(full.iter().chain(&more)).any(known) {
                    more.push(other);
                }
            }
        }
        for h in &more {
            observer(&Step::Variation.of(h, format!("plainer {:.1}", self.score(h))));
        }
        full.extend(more);
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// A hypothesis with a plainer law in the place of one of its own, its numbers from there where both have them; none where the plainer
    /// one has no start, as a periodic one has none where nothing periodic is left.
    fn exchanged(
        &self,
        best: &Hypothesis,
        index: usize,
        plain: &'static Effect,
    ) -> Option<Hypothesis> {
        let there = &best.fit.prediction.plant;
        let mut effects = best.effects.clone();
        effects[index] = plain;
        let mut free: Vec<Free> = self.tolerated.iter().map(|f| f.from_where(there)).collect();
        for (place, effect) in effects.iter().enumerate() {
            let start: Vec<f64> = match place == index {
                true => effect
                    .starts(&self.clues(best, &[], &[]))
                    .into_iter()
                    .next()?,
                false => (effect.parameters(&self.nominal).iter())
                    .map(|parameter| parameter.quantity.get(there))
                    .collect(),
            };
            let own = free_of(effect, &self.nominal, &start).into_iter().map(|f| {
                let same = |other: &&Free| other.quantity.is(&f.quantity);
                match best.fit.free.iter().find(same) {
                    Some(_) => f.from_where(there),
                    None => f,
                }
            });
            let own: Vec<Free> = own.collect();
            free.retain(|f| !own.iter().any(|o| same(o, f, &self.nominal)));
            free.extend(own);
        }
        let here = best.fit.free_from_here();
        let phases = here.iter().copied();
        free.extend(phases.filter(|f| effects.iter().any(|e| e.has_phase(&f.quantity))));
        let mut nominal = self.nominal.clone();
        if let Some(term) = best.unlisted() {
            nominal.latent = Some(term.clone());
            free.extend_from_slice(&here[here.len() - term.numbers()..]);
        }
        let limit = Limit::FULL;
        Some(Hypothesis {
            depends_on: best.depends_on.clone(),
            ..self.fitted(effects, (&nominal, None), &free, FULL, limit)
        })
    }

    /// Fits in full the explanations that a rough fit cannot rule out beside the best one: nothing is said of a close rival by a rough fit. Where the best
    /// explains too little, a model discrepancy is to stand in its place, and these are no rivals. The best one with an effect more is none either: such
    /// must also predict what was left out, which [`Self::add_small`] asks of it.
    pub(super) fn add_close(
        &self,
        full: &mut Vec<Hypothesis>,
        rough: &[Hypothesis],
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let reached = |best: &&Hypothesis| scale.is_explained(best) && !self.is_spent();
        let Some(best) = full.first().filter(reached) else {
            return;
        };
        let limit = self.rough_reference(best, rough) - 2.0 * self.settings.least_odds.ln();
        let is_fitted = |h: &Hypothesis| full.iter().any(|known| known.names() == h.names());
        let is_richer = |h: &Hypothesis| covers(h, best) && h.effects.len() > best.effects.len();
        let mut close: Vec<&Hypothesis> = rough
            .iter()
            .filter(|h| self.rough_score(h) < limit && !is_fitted(h) && !is_richer(h))
            .collect();
        close.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        let more: Vec<Hypothesis> = (close.into_iter().take(MOST_CLOSE))
            .take_while(|_| !self.is_spent())
            .map(|h| self.rival(h, self.score(best), self.settings.given_up))
            .collect();
        for h in &more {
            observer(&Step::Variation.of(h, format!("close {:.1}", self.score(h))));
        }
        full.extend(more);
        // The search has weighed the first one with more than its score.
        full[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// A rival fitted in full; one that is hopelessly behind the best score before the finest measure is left there.
    pub(super) fn rival(&self, rough: &Hypothesis, best: f64, hopeless: f64) -> Hypothesis {
        let coarse = Refit {
            stages: FULL.split_at(FULL.len() - 1).0,
            ..Refit::FULL
        };
        let fitted = self.refit(rough, coarse);
        match self.score(&fitted) < best + hopeless {
            true => self.refit(&fitted, Refit::FINEST.from(Start::Here)),
            false => fitted,
        }
    }

    /// Rough cost that others are compared with: of the same effects as the best explanation, fitted roughly where that was done.
    pub(super) fn rough_reference(&self, best: &Hypothesis, rough: &[Hypothesis]) -> f64 {
        let own = self.rough_score(best);
        let same = rough
            .iter()
            .filter(|h| best.unlisted().is_none() && h.names() == best.names());
        same.map(|h| self.rough_score(h)).fold(own, f64::min)
    }

    /// Of laws that exclude one another puts the plainest first that explains as much but for what idealisation leaves: a richer law bends to the errors
    /// of a plain one.
    pub(super) fn prefer_plain(&self, full: &mut Vec<Hypothesis>, scale: &Scale) {
        let Some(best) = full.first() else { return };
        let left = self.model_error.left(self.evidence, &best.fit);
        let allowed = scale.material_in_full(best.fit.cost()).max(left);
        let plainer = |h: &&Hypothesis| {
            h.fit.free.len() < best.fit.free.len()
                && h.fit.cost() - best.fit.cost() < allowed
                && is_equivalent(h, best)
        };
        let plainest = (full.iter().enumerate())
            .filter(|(_, h)| plainer(h))
            .min_by_key(|(_, h)| h.fit.free.len());
        if let Some((index, _)) = plainest {
            let chosen = full.remove(index);
            full.insert(0, chosen);
        }
    }

    /// Takes effects out of the best hypothesis as long as it scores better without, the last one too: a rough fit of the nominal model may have come to
    /// rest where an effect of no size let a full one go on, and an effect beside which a term was found may have done no more than lead to it. Beside a
    /// model error an effect must also gain more than what all of them leave: less may be a part of that error.
    pub(in crate::diagnosis) fn eliminate(
        &self,
        full: &mut Vec<Hypothesis>,
        observer: &mut Observer<'_>,
    ) {
        while let Some(best) = full.first()
            && best.effects.len() > self.shown.len()
            && !self.is_spent()
        {
            let score = self.score(best);
            // Beside a model error a fit from another minimum says nothing new.
            let weighed = !self.model_error.is_none();
            let known = |names: &[&str]| {
                let mut full = full.iter().filter(|h| weighed && same_term(h, best));
                full.find(|known| known.names() == names).cloned()
            };
            let mut fewer: Vec<Hypothesis> = (self.shown.len()..best.effects.len())
                .filter_map(|index| {
                    let mut names = best.effects.iter().map(|e| e.name).collect::<Vec<_>>();
                    names.remove(index);
                    names.sort_unstable();
                    known(&names).or_else(|| self.without(best, index))
                })
                .collect();
            fewer.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            let Some(lighter) = fewer.first() else { break };
            let detail = format!("lighter {:.1}, before {score:.1}", self.score(lighter));
            observer(&Step::Variation.of(lighter, detail));
            let better = self.score(lighter) < score;
            let gain = lighter.fit.cost() - best.fit.cost();
            let immaterial = !better && gain < self.model_error.left(self.evidence, &best.fit);
            if immaterial {
                // With it goes what has all of its effects and scores worse still: taken apart, that would lead to it again.
                let dropped = full.remove(0);
                let has_all =
                    |h: &Hypothesis| dropped.names().iter().all(|name| h.names().contains(name));
                full.retain(|h| !has_all(h));
            }
            // Each says how much its effect is needed. One fitted before may have come to rest in another minimum: the better fit counts.
            for one in fewer {
                let is_same =
                    |known: &Hypothesis| known.names() == one.names() && same_term(known, &one);
                match full.iter().position(is_same) {
                    None => full.push(one),
                    Some(at) if self.score(&one) < self.score(&full[at]) => full[at] = one,
                    Some(_) => {}
                }
            }
            full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            if !better && !immaterial {
                break;
            }
        }
    }

    /// A hypothesis without one of its effects, fitted in full from where it was; what the effect freed is held to its tolerance again. Nothing where a
    /// rough fit is hopeless already.
    pub(super) fn without(&self, hypothesis: &Hypothesis, index: usize) -> Option<Hypothesis> {
        let (effects, mut free) = self.without_effect(hypothesis, index);
        let nominal = PlantParameters {
            latent: hypothesis.unlisted().cloned(),
            ..self.nominal.clone()
        };
        // What was not needed is missed at no sample.
        let from = (&nominal, None);
        let depends_on = |h| Hypothesis {
            depends_on: hypothesis.depends_on.clone(),
            ..h
        };
        let limit = Limit::of(LIGHTER);
        let mut near = self.fitted(effects.clone(), from, &free, LAST, limit);
        if hypothesis.unlisted().is_some() {
            // Beside what is not there a term may have come to rest elsewhere.
            let again = self.refit(&near, Refit::FULL.from(Start::Here));
            if self.score(&again) < self.score(&near) {
                near = again;
            }
        }
        if self.score(&near) < self.score(hypothesis) {
            return Some(depends_on(near));
        }
        let rough = self.fitted(effects, from, &free, ROUGH, limit);
        // Beside a model error a rough fit is wrong by as much as that.
        let left = (hypothesis.fit.rough - rough_noise(self.evidence)).max(0.0);
        let reach = match self.model_error.is_none() {
            true => self.settings.given_up,
            false => self.settings.given_up + left,
        };
        if self.rough_score(&rough) > self.rough_score(hypothesis) + reach {
            return None;
        }
        for (f, value) in free.iter_mut().zip(&rough.fit.values) {
            f.start = *value;
        }
        let effects = rough.effects;
        Some(depends_on(self.fitted(
            effects,
            from,
            &free,
            FULL,
            Limit::FULL,
        )))
    }

    /// Effects without one of them, and what they leave free, from where it was; what the effect freed is held to its tolerance again.
    pub(super) fn without_effect(
        &self,
        hypothesis: &Hypothesis,
        index: usize,
    ) -> (Vec<&'static Effect>, Vec<Free>) {
        let fit = &hypothesis.fit;
        let plant = &fit.prediction.plant;
        let own = hypothesis.tolerated(&self.nominal);
        let numbers = hypothesis.numbers_of(&self.nominal, index);
        let phase = |f: &Free| hypothesis.effects[index].has_phase(&f.quantity);
        let kept = fit.free_from_here().into_iter().enumerate();
        let others: Vec<Free> = kept
            .filter(|(i, f)| *i >= own && !numbers.contains(i) && !phase(f))
            .map(|(_, f)| f)
            .collect();
        let mut free: Vec<Free> = self
            .tolerated
            .iter()
            .filter(|f| !others.iter().any(|o| same(o, f, &self.nominal)))
            .map(|f| f.from_where(plant))
            .collect();
        free.extend(others);
        let mut effects = hypothesis.effects.clone();
        effects.remove(index);
        (effects, free)
    }

    /// Adds effects that only the finest measure shows, where the best hypothesis is otherwise good. What a law is a little wrong by at an impact, an effect
    /// that has nothing to do with it may fit by chance: so it must predict recordings that were left out, and where the piston is held to its measured
    /// motion it must not be worse by more than chance.
    pub(super) fn add_small(
        &self,
        full: &mut Vec<Hypothesis>,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let noise = rough_noise(self.evidence);
        while let Some(best) = full.first()
            && best.effects.len() < self.most_effects + self.shown.len()
            && (scale.is_adequate(best) || best.fit.rough - noise < scale.rough_spread())
            && !self.is_spent()
        {
            let score = self.score(best);
            let least = scale.material_in_full(best.fit.cost());
            // What derivatives promise is not exact: half of what is needed is worth a look.
            let needed = least + self.settings.look_elsewhere + (self.evidence.count() as f64).ln();
            let most = best.fit.misfit - 0.5 * needed;
            let raw = |h: &Hypothesis| h.fit.cost() + self.penalty(h);
            let gain = |from: &Hypothesis, to: &Hypothesis| {
                let weighed = self.score(from) - self.score(to);
                weighed.min(raw(from) - raw(to) - least)
            };
            // From where it is: what the finest measure alone shows lies in the minimum that the fit is in.
            let refit = Refit::FINEST.from(Start::Here);
            let promising = self.screen(best, FINEST, most).into_iter();
            let refitted = promising
                .filter(|more| gain(best, more) > 0.0)
                .take(MOST_SMALL)
                .map(|more| self.refit(&more, refit))
                .max_by(|a, b| gain(best, a).total_cmp(&gain(best, b)));
            let Some(more) = refitted else { return };
            let own = gain(best, &more);
            observer(&Step::Variation.of(&more, format!("small, gain {own:.1}")));
            if own <= 0.0 {
                return;
            }
            let again = self.refit(best, again(&more));
            let own = gain(&again, &more);
            let held = again.fit.rough - more.fit.rough;
            let detail = format!("of which its own {own:.1}, held {held:.1}");
            observer(&Step::Variation.of(&more, detail));
            let contradicted = held < -CHANCE * (2.0 * more.fit.free.len() as f64).sqrt();
            let kept = own > 0.0 && !contradicted && self.predicts_better(&more, &again, observer);
            if self.score(&again) < score {
                full[0] = again;
            }
            if !kept {
                return;
            }
            full.insert(0, more);
        }
    }

    /// Whether a hypothesis predicts recordings that were left out better than a simpler one. Where there are none, nothing speaks against it.
    pub(super) fn predicts_better(
        &self,
        more: &Hypothesis,
        simpler: &Hypothesis,
        observer: &mut Observer<'_>,
    ) -> bool {
        let cost = |h: &Hypothesis| {
            let left = left_out(self.evidence, &h.fit, Depth::OneStep)?;
            Some(left.sum(&self.model_error))
        };
        let (Some(without), Some(with)) = (cost(simpler), cost(more)) else {
            return true;
        };
        let detail = format!("and {:.1} of what was left out", without - with);
        observer(&Step::Variation.with(detail));
        with < without
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::free::Prior;
    use crate::diagnosis::test_evidence::{evidence_of, plant, search};
    use crate::effects::{Coordinate, every};
    use crate::plant::{Basis, Latent, Port, Variable, registry};

    /// A rod that is 6 % off, beside which a law of the supply was found, stood in an answer at 49 %, and the truth, the law alone, was not among the explanations:
    /// effects beside a term were never taken out.
    #[test]
    fn an_effect_that_led_to_a_term_is_taken_out_and_one_that_is_there_stays() {
        for (bias, expected) in [(0.0, vec![]), (6.0, vec!["force_sensor_bias_drift"])] {
            let term = |rise: f64| Latent {
                port: Port::PistonForce,
                variable: Variable::Stroke,
                directed: false,
                basis: Basis::Hats { ends: [0.0, 0.05] },
                coefficients: vec![0.0, rise],
            };
            let mut truth = plant();
            truth.latent = Some(term(60.0));
            registry::FORCE_BIAS.quantity().set(&mut truth, bias);
            let evidence = evidence_of(&truth, vec![vec![1.5e5; 200], vec![2.5e5; 200]]);
            let search = search(&evidence);
            let effect = every()
                .find(|e| e.name == "force_sensor_bias_drift")
                .unwrap();
            let mut from = plant();
            from.latent = Some(term(40.0));
            let coefficient = |index: usize| Free {
                quantity: registry::LATENT_COEFFICIENT.quantity().of(index),
                start: [0.0, 40.0][index],
                coordinate: Coordinate::Linear(10.0),
                bounds: [-500.0, 500.0],
                prior: Prior::Flat,
            };
            let mut free = free_of(effect, &search.nominal, &[1.0, 0.0]);
            free.extend([0, 1].map(coefficient));
            let mut both = search.fitted(vec![effect], (&from, None), &free, FULL, Limit::FULL);
            both.depends_on = vec!["stroke_m"];
            let mut full = vec![both];
            search.eliminate(&mut full, &mut |_| ());
            assert_eq!(full[0].names(), expected);
            assert_eq!(full[0].depends_on, ["stroke_m"]);
            let rise = full[0].fit.values.last().unwrap();
            assert!((rise - 60.0).abs() < 0.5, "{rise}");
        }
    }
}
