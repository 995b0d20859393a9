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
pub(super) const BEHIND: f64 = 60.0;
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
        let is_known =
            |effects: &[&'static Effect]| found.iter().chain(more).any(|h| h.is_of(effects));
        let all = exchanges(self, best);
        let reach = self.rough_score(best) + BEHIND;
        (all.iter().filter(|effects| !is_known(effects)))
            .take_while(|_| !self.is_spent())
            .filter_map(|effects| self.at_each_start(effects, best, reach))
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

#[cfg(test)]
mod tests {
    use super::super::ruled_out::variant;
    use crate::diagnosis::fit::FULL;
    use crate::diagnosis::fit::free::{Free, Prior};
    use crate::diagnosis::fit::hypothesis::Hypothesis;
    use crate::diagnosis::test_evidence::{evidence_of, plant, search};
    use crate::effects::{CATALOGUE, Coordinate, NUMBERS_OFF};
    use crate::plant::registry::{EXHAUST_ORIFICE, SUPPLY_ORIFICE};

    /// Where the tolerances explain what there is, a look gives no effect a gain: a supply restriction was stated at 93 % where the temperature of the sheet was off, for
    /// the discharge coefficient, which acts as that does, was not among the seven effects that the look kept.
    #[test]
    fn laws_of_one_kind_are_rivals_though_a_look_promises_them_nothing() {
        let mut truth = plant();
        truth.device.supply_orifice *= 0.97;
        let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
        let mut search = search(&evidence);
        let tolerated = [&SUPPLY_ORIFICE, &EXHAUST_ORIFICE].map(|number| {
            let mean = number.quantity().get(&plant());
            Free {
                quantity: number.quantity(),
                start: mean,
                coordinate: Coordinate::Logarithmic,
                bounds: [0.9 * mean, 1.1 * mean],
                prior: Prior::Normal {
                    mean,
                    deviation: 0.05 * mean,
                },
            }
        });
        search.tolerated = tolerated.to_vec();
        search.candidates = CATALOGUE.iter().chain(&NUMBERS_OFF).collect();
        let effect = |name: &str| {
            let mut all = search.candidates.iter().copied();
            all.find(|effect| effect.name == name).unwrap()
        };
        let best = vec![effect("supply_restriction")];
        let mut found = vec![Hypothesis {
            fit: variant(&search, &best, FULL).unwrap(),
            effects: best,
            depends_on: Vec::new(),
        }];
        search.add_rivals(&mut found, &mut |_| ());
        let names: Vec<Vec<&str>> = found.iter().map(Hypothesis::names).collect();
        for own in [
            "exhaust_restriction",
            "number_off (valve.discharge_coefficient)",
        ] {
            assert!(names.contains(&vec![own]), "{own}: {names:?}");
        }
        // Both are fitted: the coefficient with the exhaust's tolerance does what the smaller orifice does.
        let rival = found.iter().find(|h| h.names()[0].contains("discharge"));
        let behind = search.score(rival.unwrap()) - search.score(&found[0]);
        assert!(behind < 6.0, "{behind}");
    }
}
