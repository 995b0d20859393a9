//! Laws that are alike, from each of their starts, where the best explanation leaves more than noise: of friction that sticks a fit from one start comes to rest where
//! its dry part stands in for the breakaway force, and a formula would be found for the rest.

use rayon::prelude::*;

use super::finish::LIGHTER;
use super::progress::{Observer, Step};
use super::rivals::{BEHIND, HOPELESS};
use super::ruled_out::exchanges;
use super::scale::Scale;
use super::{Search, same};
use crate::diagnosis::fit::free::{Free, free_of};
use crate::diagnosis::fit::hypothesis::{Hypothesis, is_equivalent};
use crate::diagnosis::fit::{FULL, Limit, ROUGH, Stage};
use crate::effects::Effect;
use crate::plant::DeviceParts;

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
        for effects in exchanges(self, &best) {
            if self.is_spent() {
                break;
            }
            let to = (FULL, Limit::FULL);
            let Some(fitted) = self.at_each_start(&effects, &best, to, Self::score) else {
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

    /// Adds what has another law of its kind in the place of one of the best explanation's, where that was not fitted and a rough fit does not rule it out: where tolerances explain as much as the law
    /// gains, a rough look promises its like nothing, and the law would be stated for certain beside nothing.
    pub(super) fn add_unfitted_alike(
        &self,
        found: &mut Vec<Hypothesis>,
        observer: &mut Observer<'_>,
    ) {
        let whole = self.nominal.parts == DeviceParts::Whole;
        let Some(best) = found.first().filter(|h| whole && h.unlisted().is_none()) else {
            return;
        };
        let is_fitted = |effects: &[&'static Effect]| {
            let mut names: Vec<&str> = effects.iter().map(|effect| effect.name).collect();
            names.sort_unstable();
            let mut fitted = found.iter();
            fitted.any(|h| h.unlisted().is_none() && h.names() == names)
        };
        let all = exchanges(self, best);
        let reach = self.rough_score(best) + BEHIND;
        let roughly = (ROUGH, Limit::of(LIGHTER));
        let more: Vec<Hypothesis> = (all.iter().filter(|effects| !is_fitted(effects)))
            .take_while(|_| !self.is_spent())
            .filter_map(|effects| self.at_each_start(effects, best, roughly, Self::rough_score))
            .filter(|alike| self.rough_score(alike) < reach)
            .map(|alike| self.rival(&alike, self.score(best), HOPELESS))
            .collect();
        for h in &more {
            observer(&Step::Variation.of(h, format!("alike {:.1}", self.score(h))));
        }
        self.beside_best(found, more);
    }

    /// Puts explanations beside the best one, or before it what scores better and says something else: the search has weighed the best one with more than its score.
    pub(super) fn beside_best(&self, found: &mut Vec<Hypothesis>, more: Vec<Hypothesis>) {
        let Some(best) = found.first() else { return };
        let score = self.score(best);
        let better = (more.iter())
            .filter(|h| self.score(h) < score && !is_equivalent(h, best))
            .min_by(|a, b| self.score(a).total_cmp(&self.score(b)))
            .map(Hypothesis::names);
        found.extend(more);
        let place = better.and_then(|names| found.iter().position(|h| h.names() == names));
        if let Some(place) = place {
            let better = found.remove(place);
            found.insert(0, better);
        }
        found[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// The best of the fits from each start of the law that is not the other's; none of one that has no start.
    fn at_each_start(
        &self,
        effects: &[&'static Effect],
        other: &Hypothesis,
        to: (&[Stage], Limit),
        score: fn(&Self, &Hypothesis) -> f64,
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
            .map(|start| self.at_start(effects, other, (index, start), to))
            .collect();
        let best = fitted.into_iter();
        best.min_by(|a, b| score(self, a).total_cmp(&score(self, b)))
    }

    fn at_start(
        &self,
        effects: &[&'static Effect],
        other: &Hypothesis,
        (index, start): (usize, &[f64]),
        (stages, limit): (&[Stage], Limit),
    ) -> Hypothesis {
        let there = &other.fit.prediction.plant;
        let mut free: Vec<Free> = self.tolerated.iter().map(|f| f.from_where(there)).collect();
        for (place, effect) in effects.iter().enumerate() {
            let start: Vec<f64> = match place == index {
                true => start.to_vec(),
                false => (effect.parameters(&self.nominal).iter())
                    .map(|parameter| parameter.quantity.get(there))
                    .collect(),
            };
            let own = free_of(effect, &self.nominal, &start);
            free.retain(|f| !own.iter().any(|o| same(o, f, &self.nominal)));
            free.extend(own);
        }
        let from = (&self.nominal, None);
        self.fitted(effects.to_vec(), from, &free, stages, limit)
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnosis::fit::hypothesis::Hypothesis;
    use crate::diagnosis::test_evidence::{evidence_of, orifices_within_tolerances, plant, search};
    use crate::effects::{CATALOGUE, NUMBERS_OFF};

    /// A restriction was stated at 99.7 % where the sheet's temperature was off: the discharge coefficient, of one number too, had not been fitted, for what one orifice's
    /// tolerance takes up a look cannot promise.
    #[test]
    fn of_laws_of_one_kind_none_is_stated_before_the_others_are_fitted() {
        let mut truth = plant();
        truth.device.supply_orifice *= 0.85;
        truth.device.exhaust_orifice *= 0.95;
        let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
        let mut search = search(&evidence);
        search.tolerated = orifices_within_tolerances();
        search.candidates = CATALOGUE.iter().chain(&NUMBERS_OFF).collect();
        let found = search.run(&mut |_| ());
        let names: Vec<Vec<&str>> = found.iter().map(Hypothesis::names).collect();
        for own in [
            "supply_restriction",
            "exhaust_restriction",
            "number_off (valve.discharge_coefficient)",
        ] {
            assert!(names.contains(&vec![own]), "{own}: {names:?}");
        }
    }
}
