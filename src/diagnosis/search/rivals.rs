//! Every explanation that could stand in the place of the best, fitted in full: what an experiment is to tell apart must be there with its odds.

use rayon::prelude::*;

use super::Search;
use super::progress::{Observer, Step};
use super::ruled_out::exchanges;
use crate::diagnosis::fit::hypothesis::{Hypothesis, is_equivalent};
use crate::diagnosis::fit::{Limit, ROUGH, jacobian};
use crate::effects::Effect;
use crate::plant::DeviceParts;

/// Rough score behind the best at which a rival is not fitted in full [1]: a full fit may gain that.
const BEHIND: f64 = 60.0;
/// Rivals that are fitted in full, at most.
const MOST: usize = 14;
/// Score behind the best at which a rival is given up before the finest measure [1].
const HOPELESS: f64 = 60.0;

impl Search<'_> {
    /// Adds what has another effect in the place of one of the best explanation's, or one effect where it has none; the best may change.
    pub(in crate::diagnosis) fn add_rivals(
        &self,
        found: &mut Vec<Hypothesis>,
        observer: &mut Observer<'_>,
    ) {
        let Some(best) = found.first().filter(|_| !self.is_spent()) else {
            return;
        };
        if self.nominal.parts != DeviceParts::Whole {
            return;
        }
        let mut rough: Vec<Hypothesis> = Vec::new();
        for base in self.bases(best) {
            let reference = self.rough_score(&base);
            for candidate in self.screen(&base, ROUGH, f64::INFINITY) {
                let known = |h: &Hypothesis| {
                    h.names() == candidate.names()
                        && h.unlisted().is_some() == candidate.unlisted().is_some()
                };
                if !found.iter().chain(&rough).any(known) {
                    let detail = format!(
                        "rival, gain {:.1}",
                        reference - self.rough_score(&candidate)
                    );
                    observer(&Step::Variation.of(&candidate, detail));
                    rough.push(candidate);
                }
            }
        }
        rough.sort_by(|a, b| self.rough_score(a).total_cmp(&self.rough_score(b)));
        let least = rough.iter().map(|h| self.rough_score(h));
        let near = least.fold(self.rough_score(best), f64::min) + BEHIND;
        let score = self.score(best);
        let close: Vec<&Hypothesis> = (rough.iter().take(MOST))
            .take_while(|h| self.rough_score(h) < near)
            .collect();
        let mut full: Vec<Hypothesis> = close
            .par_iter()
            .map(|h| self.rival(h, score, HOPELESS))
            .collect();
        full.extend(self.alike_rivals(best, found, &full));
        for h in &full {
            observer(&Step::Variation.of(h, format!("rival {:.1}", self.score(h))));
        }
        let better = (full.iter())
            .filter(|h| self.score(h) < score && !is_equivalent(h, best))
            .min_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        let better = better.map(Hypothesis::names);
        found.extend(full);
        if let Some(place) = better.and_then(|names| found.iter().position(|h| h.names() == names))
        {
            let better = found.remove(place);
            found.insert(0, better);
        }
        found[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// What has another law of its kind in the place of one of the best explanation's, but for what is known already: a look at what the best does not explain cannot see
    /// what would explain as much.
    fn alike_rivals(
        &self,
        best: &Hypothesis,
        found: &[Hypothesis],
        more: &[Hypothesis],
    ) -> Vec<Hypothesis> {
        if best.unlisted().is_some() {
            return Vec::new();
        }
        let is_known = |effects: &[&'static Effect]| {
            let mut known = found.iter().chain(more);
            known.any(|h| {
                h.effects.len() == effects.len()
                    && effects
                        .iter()
                        .all(|own| h.effects.iter().any(|e| e.name == own.name))
            })
        };
        let all = exchanges(self, best);
        let fitted = all.iter().filter(|effects| !is_known(effects));
        let fitted = fitted.take_while(|_| !self.is_spent());
        fitted
            .filter_map(|effects| self.at_each_start(effects, best))
            .collect()
    }

    /// Explanations of one effect less, beside which others are looked for: roughly, with their derivatives.
    fn bases(&self, best: &Hypothesis) -> Vec<Hypothesis> {
        // One law may do what two do, or one and a formula.
        let alone = self.baseline();
        let term = best.unlisted().map(|_| self.where_its_term_was(best));
        let own = match (&term, best.effects.len() - self.shown.len()) {
            (None, 2..) => self.shown.len()..best.effects.len(),
            _ => 0..0,
        };
        let fewer = own.map(|index| {
            let (effects, free) = self.without_effect(best, index);
            self.fitted(effects, (&self.nominal, None), &free, ROUGH, Limit::of(8))
        });
        let mut bases: Vec<Hypothesis> = [alone].into_iter().chain(term).chain(fewer).collect();
        for base in &mut bases {
            self.with_columns(base);
        }
        bases
    }

    fn with_columns(&self, base: &mut Hypothesis) {
        let at = &base.fit;
        base.fit.columns = jacobian(self.evidence, &at.prediction, &at.free, &at.values, 0);
    }
}
