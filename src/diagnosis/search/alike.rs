//! Laws that are alike, from each of their starts: where the best explanation leaves more than noise, for of friction that sticks a fit from one start comes to rest where
//! its dry part stands in for the breakaway force, and a formula would be found for the rest; and in the place of two, for a search that goes effect by effect comes to
//! two orifices where the discharge coefficient of both is off.

use rayon::prelude::*;

use super::finish::LIGHTER;
use super::progress::{Observer, Step};
use super::rivals::BEHIND;
use super::ruled_out::exchanges;
use super::scale::Scale;
use super::{Search, same};
use crate::diagnosis::answer::family::is_alike;
use crate::diagnosis::fit::free::{Free, free_of};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{FULL, Limit, ROUGH};
use crate::effects::Effect;

/// Iterations after which a law that is near scores so roughly, once its own numbers were fitted.
const FEW: usize = 3;

impl Search<'_> {
    /// Adds what has another law of its kind in the place of one of the best explanation's, fitted in full from where that law may start, or puts it in the place of a
    /// fit of the same effects that scores worse.
    pub(super) fn add_alike(
        &self,
        full: &mut Vec<Hypothesis>,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let is_left = |best: &&Hypothesis| best.unlisted().is_none() && !scale.is_adequate(best);
        let Some(best) = full.first().filter(is_left).cloned() else {
            return;
        };
        // What the best leaves is the most that another could gain.
        let reach = self.rough_score(&best) + scale.left(&best).max(BEHIND);
        for effects in exchanges(self, &best) {
            if self.is_spent() {
                break;
            }
            let Some(fitted) = self.at_each_start(&effects, &best, reach) else {
                continue;
            };
            let score = self.score(&fitted);
            let known = full.iter().position(|h| h.names() == fitted.names());
            let before = known.map_or(f64::INFINITY, |place| self.score(&full[place]));
            if score >= before {
                continue;
            }
            let detail = format!("alike {score:.1}, before {before:.1}");
            observer(&Step::Variation.of(&fitted, detail));
            match known {
                Some(place) => full[place] = fitted,
                None => full.push(fitted),
            }
        }
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        if full[0].names() != best.names() {
            self.eliminate(full, observer);
        }
    }

    /// Adds what has one law in the place of two of the best explanation's, of the kind of either, as long as that scores better.
    pub(super) fn add_one_for_two(&self, full: &mut Vec<Hypothesis>, observer: &mut Observer<'_>) {
        loop {
            let best = full.first().filter(|best| best.unlisted().is_none());
            let Some(best) = best.cloned() else { return };
            let (reach, score) = (self.rough_score(&best) + BEHIND, self.score(&best));
            let mut fitted: Vec<Hypothesis> = Vec::new();
            for effects in self.one_for_two(&best) {
                let is_known = full.iter().any(|h| h.is_of(&effects));
                if is_known || self.is_spent() {
                    continue;
                }
                if let Some(one) = self.at_each_start(&effects, &best, reach) {
                    let detail = format!("one for two {:.1}", self.score(&one));
                    observer(&Step::Variation.of(&one, detail));
                    fitted.push(one);
                }
            }
            fitted.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            let leads = fitted.first().is_some_and(|one| self.score(one) < score);
            // The search has weighed the first one with more than its score.
            full.splice(usize::from(!leads)..usize::from(!leads), fitted);
            full[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            if !leads {
                return;
            }
        }
    }

    /// The effects of an explanation with one law in the place of two, which is like one of them and goes with the rest.
    fn one_for_two(&self, best: &Hypothesis) -> Vec<Vec<&'static Effect>> {
        let mut sets: Vec<Vec<&'static Effect>> = Vec::new();
        for last in self.shown.len()..best.effects.len() {
            for first in self.shown.len()..last {
                let pair = [best.effects[first], best.effects[last]];
                let mut rest = best.effects.clone();
                rest.remove(last);
                rest.remove(first);
                let may_replace = |own: &&&'static Effect| {
                    let is_like = |one: &&'static Effect| is_alike(own, one);
                    let is_new = |one: &&'static Effect| one.name != own.name;
                    let goes_with = |one: &&'static Effect| !own.excludes(one);
                    pair.iter().any(is_like)
                        && best.effects.iter().all(is_new)
                        && rest.iter().all(goes_with)
                };
                for own in self.candidates.iter().filter(may_replace) {
                    let mut effects = rest.clone();
                    effects.insert(first, own);
                    sets.push(effects);
                }
            }
        }
        sets
    }

    /// The best of the full fits from each start of the law that is not the other's from where a rough fit scores less than `reach`; none of one that has no such start.
    /// A full fit of a law that is far off costs more than all others.
    pub(super) fn at_each_start(
        &self,
        effects: &[&'static Effect],
        other: &Hypothesis,
        reach: f64,
    ) -> Option<Hypothesis> {
        let pairs = effects.iter().zip(&other.effects);
        let index = pairs
            .into_iter()
            .position(|(own, known)| own.name != known.name)?;
        if effects[index].phase.is_some() {
            return None;
        }
        let starts = effects[index].starts(&self.clues(other, &[], &[]));
        let fitted: Vec<Hypothesis> = (starts.par_iter())
            .map(|start| self.free_at(effects, other, (index, start)))
            .filter(|free| self.is_near(effects, free, reach))
            .map(|[tolerated, own]| {
                let from = (&self.nominal, None);
                self.fitted(
                    effects.to_vec(),
                    from,
                    &[tolerated, own].concat(),
                    FULL,
                    Limit::FULL,
                )
            })
            .collect();
        let best = fitted.into_iter();
        best.min_by(|a, b| self.score(a).total_cmp(&self.score(b)))
    }

    /// Whether a rough fit scores less than `reach`: of the laws' numbers alone, and then of all in a few steps.
    fn is_near(
        &self,
        effects: &[&'static Effect],
        [tolerated, own]: &[Vec<Free>; 2],
        reach: f64,
    ) -> bool {
        let mut plant = self.nominal.clone();
        for free in tolerated {
            free.quantity.set(&mut plant, free.start);
        }
        let roughly = |from, free: &[Free], iterations| {
            let limit = Limit::of(iterations);
            self.fitted(effects.to_vec(), (from, None), free, ROUGH, limit)
        };
        let alone = roughly(&plant, own, LIGHTER);
        let there = &alone.fit.prediction.plant;
        let all = tolerated.iter().chain(own);
        let all: Vec<Free> = all.map(|free| free.from_where(there)).collect();
        self.rough_score(&roughly(&self.nominal, &all, FEW)) < reach
    }

    /// What is free, from another explanation's tolerated numbers and from a start of one law: tolerated numbers, and the laws' own.
    fn free_at(
        &self,
        effects: &[&'static Effect],
        other: &Hypothesis,
        (index, start): (usize, &[f64]),
    ) -> [Vec<Free>; 2] {
        let there = &other.fit.prediction.plant;
        let mut tolerated: Vec<Free> = self.tolerated.iter().map(|f| f.from_where(there)).collect();
        let mut laws: Vec<Free> = Vec::new();
        for (place, effect) in effects.iter().enumerate() {
            let start: Vec<f64> = match place == index {
                true => start.to_vec(),
                false => (effect.parameters(&self.nominal).iter())
                    .map(|parameter| parameter.quantity.get(there))
                    .collect(),
            };
            let own = free_of(effect, &self.nominal, &start);
            for free in [&mut tolerated, &mut laws] {
                free.retain(|f| !own.iter().any(|o| same(o, f, &self.nominal)));
            }
            laws.extend(own);
        }
        [tolerated, laws]
    }
}

#[cfg(test)]
mod tests {
    use super::super::rivals::BEHIND;
    use super::super::ruled_out::variant;
    use crate::diagnosis::fit::FULL;
    use crate::diagnosis::fit::hypothesis::Hypothesis;
    use crate::diagnosis::test_evidence::{evidence_of, plant, search};
    use crate::effects::{CATALOGUE, Effect, NUMBERS_OFF};

    fn effect(name: &str) -> &'static Effect {
        CATALOGUE.iter().find(|own| own.name == name).unwrap()
    }

    /// Score of another law behind that of the law that is there, at its usual size; none where a rough fit rules the other out.
    fn behind(there: &str, other: &str) -> Option<f64> {
        let there = effect(there);
        let mut truth = plant();
        for (parameter, value) in there.parameters(&plant()).iter().zip(there.usual(&plant())) {
            parameter.quantity.set(&mut truth, value);
        }
        let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
        let search = search(&evidence);
        let best = Hypothesis {
            fit: variant(&search, &[there], FULL).unwrap(),
            effects: vec![there],
            depends_on: Vec::new(),
        };
        let fitted = |reach| search.at_each_start(&[effect(other)], &best, reach);
        assert!(fitted(f64::INFINITY).is_some(), "{other}");
        let own = fitted(search.rough_score(&best) + BEHIND);
        own.map(|alike| search.score(&alike) - search.score(&best))
    }

    /// Where the discharge coefficient was off, both orifices were stated at 99 %: beside either alone something is left, and what each of them does not
    /// explain no look at the coefficient saw.
    #[test]
    fn one_law_takes_the_place_of_two_where_it_does_what_both_do() {
        // The best explanation, of two orifices so many times as large.
        let best = |[supply, exhaust]: [f64; 2]| {
            let mut truth = plant();
            truth.device.supply_orifice *= supply;
            truth.device.exhaust_orifice *= exhaust;
            let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
            let mut search = search(&evidence);
            search.candidates = CATALOGUE.iter().chain(&NUMBERS_OFF).collect();
            let two = vec![effect("supply_restriction"), effect("exhaust_restriction")];
            let mut found = vec![Hypothesis {
                fit: variant(&search, &two, FULL).unwrap(),
                effects: two,
                depends_on: Vec::new(),
            }];
            search.add_one_for_two(&mut found, &mut |_| ());
            found.swap_remove(0)
        };
        let both = best([0.9, 0.9]);
        assert_eq!(both.names(), ["number_off (valve.discharge_coefficient)"]);
        let off = both.fit.values[0] / plant().device.discharge_coefficient;
        assert!((off - 0.9).abs() < 0.01, "{off}");
        // Of two that one law does not do none takes the place.
        assert_eq!(best([0.9, 1.1]).effects.len(), 2);
    }

    /// Full fits of laws that were far off took four fifths of a diagnosis that they could not change: a late regulator does nothing of what a large dead volume does. A law that
    /// a rough fit brings near is fitted in full.
    #[test]
    fn a_law_that_a_rough_fit_rules_out_is_not_fitted_in_full() {
        assert_eq!(behind("transport_delay", "extra_dead_volume"), None);
        let near = behind("coulomb_viscous_friction", "stribeck_friction");
        assert!(near.is_some_and(|near| near > -10.0), "{near:?}");
    }
}
