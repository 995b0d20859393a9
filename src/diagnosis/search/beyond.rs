//! Numbers that stand at the end of their tolerance, tried beyond it: beside the best explanation, and alone. A law may stand in for a number of the rig file that
//! is wrong by more than its tolerance.

use super::Search;
use super::finish::LAST;
use super::progress::{Observer, Step};
use crate::diagnosis::answer::estimate::Limit as EndOfRange;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{FINEST, ROUGH, Refit, Start};
use crate::effects::Effect;
use crate::plant::{DeviceParts, Quantity};

/// Numbers that are tried beyond their tolerance, at most.
const MOST: usize = 3;
/// Score behind the best at which a number alone is given up before the finest measure [1].
const HOPELESS: f64 = 60.0;

impl Search<'_> {
    /// Adds what has the best explanation's numbers beyond their tolerance, of those that stand at its end and that nothing has freed; the best may change.
    pub(super) fn add_beyond(
        &self,
        full: &mut Vec<Hypothesis>,
        (nominal, rough): (&Hypothesis, &[Hypothesis]),
        observer: &mut Observer<'_>,
    ) {
        if self.nominal.parts != DeviceParts::Whole
            || self
                .evidence
                .recordings
                .iter()
                .any(|r| r.inputs.cell.is_some())
        {
            return;
        }
        for effect in self.untried(full, rough) {
            let Some(best) = full.first().filter(|_| !self.is_spent()).cloned() else {
                return;
            };
            let only = Search {
                candidates: vec![effect],
                ..self.clone()
            };
            let last = Refit {
                start: Start::Here,
                stages: LAST,
                ..Refit::FULL
            };
            let beside = only.screen(&best, FINEST, f64::INFINITY).into_iter().next();
            let beside = beside.map(|h| self.refit(&h, last));
            let alone = only
                .screen(nominal, ROUGH, f64::INFINITY)
                .into_iter()
                .next();
            let alone = alone.map(|h| self.rival(&h, self.score(&best), HOPELESS));
            for h in beside.iter().chain(&alone) {
                observer(&Step::Variation.of(h, format!("beyond {:.1}", self.score(h))));
            }
            let better = |h: &Hypothesis| self.score(h) < self.score(&best);
            let leads_alone = alone.as_ref().is_some_and(better);
            let leads_beside = !leads_alone
                && beside
                    .as_ref()
                    .is_some_and(|h| better(h) && self.predicts_better(h, &best, observer));
            for (h, leads) in [(beside, leads_beside), (alone, leads_alone)] {
                let at = if leads { 0 } else { full.len() };
                full.splice(at..at, h);
            }
            full[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        }
    }

    /// Effects that free the best explanation's numbers at the end of their tolerance, the plainest of each, where no explanation has such.
    fn untried(&self, full: &[Hypothesis], rough: &[Hypothesis]) -> Vec<&'static Effect> {
        let Some(best) = full.first() else {
            return Vec::new();
        };
        let frees = |effect: &Effect, quantity: &Quantity| {
            let parameters = effect.parameters(&self.nominal);
            parameters.iter().any(|p| p.quantity.is(quantity))
        };
        let numbers = best.fit.free.iter().zip(&best.fit.values);
        let at_end = numbers
            .take(best.tolerated(&self.nominal))
            .filter(|(free, value)| EndOfRange::of(free, **value).is_some());
        let untried = at_end.filter_map(|(free, _)| {
            let is_tried = |h: &Hypothesis| h.effects.iter().any(|e| frees(e, &free.quantity));
            if full.iter().chain(rough).any(is_tried) {
                return None;
            }
            let candidates = self.candidates.iter().copied();
            let able = candidates.filter(|effect| frees(effect, &free.quantity));
            able.min_by_key(|effect| effect.parameters(&self.nominal).len())
        });
        untried.take(MOST).collect()
    }
}
