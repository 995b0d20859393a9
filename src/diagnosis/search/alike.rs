//! Laws that are alike, from each of their starts, where the best explanation leaves more than noise: of friction that sticks a fit from one start comes to rest where
//! its dry part stands in for the breakaway force, and a formula would be found for the rest.

use rayon::prelude::*;

use super::progress::{Observer, Step};
use super::ruled_out::exchanges;
use super::scale::Scale;
use super::{Search, same};
use crate::diagnosis::fit::free::{Free, free_of};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{FULL, Limit};
use crate::effects::Effect;

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
            let Some(fitted) = self.at_each_start(&effects, &best) else {
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

    /// The best of the fits from each start of the law that is not the other's; none of one that has no start.
    pub(super) fn at_each_start(
        &self,
        effects: &[&'static Effect],
        other: &Hypothesis,
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
            .map(|start| self.at_start(effects, other, (index, start)))
            .collect();
        let best = fitted.into_iter();
        best.min_by(|a, b| self.score(a).total_cmp(&self.score(b)))
    }

    fn at_start(
        &self,
        effects: &[&'static Effect],
        other: &Hypothesis,
        (index, start): (usize, &[f64]),
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
        self.fitted(effects.to_vec(), from, &free, FULL, Limit::FULL)
    }
}
