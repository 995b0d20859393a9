//! Numbers that stand at the end of their tolerance, tried beyond it: beside the best explanation, and alone. A law may stand in for a number of the rig file that
//! is wrong by more than its tolerance.

use super::Search;
use super::finish::LAST;
use super::progress::{Observer, Step};
use crate::diagnosis::answer::estimate::Limit as EndOfRange;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{FINEST, ROUGH, Refit, Start};
use crate::effects::Effect;
use crate::plant::DeviceParts;

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
        if self.nominal.parts != DeviceParts::Whole || self.is_in_cell() {
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
                if let Some(h) = h {
                    full.insert(if leads { 0 } else { full.len() }, h);
                }
            }
            full[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
            // A number beside the best one's effects may stand in for half of what one law does.
            if leads_beside {
                self.add_one_for_two(full, observer);
            }
        }
    }

    /// Effects that free the best explanation's numbers at the end of their tolerance, the plainest of each, where no explanation has such.
    fn untried(&self, full: &[Hypothesis], rough: &[Hypothesis]) -> Vec<&'static Effect> {
        let Some(best) = full.first() else {
            return Vec::new();
        };
        let numbers = best.fit.free.iter().zip(&best.fit.values);
        let at_end = numbers
            .take(best.tolerated(&self.nominal))
            .filter(|(free, value)| EndOfRange::of(free, **value).is_some());
        let untried = at_end.filter_map(|(free, _)| {
            let is_tried = |h: &Hypothesis| {
                h.effects
                    .iter()
                    .any(|e| e.frees(&self.nominal, &free.quantity))
            };
            if full.iter().chain(rough).any(is_tried) {
                return None;
            }
            let candidates = self.candidates.iter().copied();
            let able = candidates.filter(|effect| effect.frees(&self.nominal, &free.quantity));
            able.min_by_key(|effect| effect.parameters(&self.nominal).len())
        });
        untried.take(MOST).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::free::{Free, Prior};
    use crate::diagnosis::test_evidence::{evidence_of, plant, search};
    use crate::effects::{CATALOGUE, Coordinate, NUMBERS_OFF};
    use crate::plant::registry::{EXHAUST_ORIFICE, Quantity, SUPPLY_ORIFICE};

    /// One orifice was stated at "above 99.9 %" where the air's temperature was off, which changes the flow through both: the other had come to it from the end of its
    /// tolerance, after one law had been tried in the place of two.
    #[test]
    fn a_law_takes_the_place_of_two_where_the_second_is_a_number_beyond_its_tolerance() {
        let mut truth = plant();
        truth.device.discharge_coefficient *= 0.85;
        let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
        let mut search = search(&evidence);
        search.tolerated = vec![within(EXHAUST_ORIFICE.quantity(), 0.05)];
        search.candidates = CATALOGUE.iter().chain(&NUMBERS_OFF).collect();
        let supply = search.candidates.iter().copied();
        let supply = supply.filter(|e| e.name == "supply_restriction").collect();
        let only = Search {
            candidates: supply,
            ..search.clone()
        };
        let nominal = search.baseline();
        let rough = only.screen(&nominal, ROUGH, f64::INFINITY).swap_remove(0);
        let mut full = vec![search.refit(&rough, Refit::FULL)];
        search.add_beyond(&mut full, (&nominal, &[]), &mut |_| ());
        let names: Vec<Vec<&str>> = full.iter().map(Hypothesis::names).collect();
        let both = vec!["exhaust_restriction", "supply_restriction"];
        assert!(names.contains(&both), "{names:?}");
        assert_eq!(
            names[0],
            ["number_off (valve.discharge_coefficient)"],
            "{names:?}"
        );
    }

    /// A number known to within a share of itself.
    fn within(quantity: Quantity, share: f64) -> Free {
        let mean = quantity.get(&plant());
        Free {
            quantity,
            start: mean,
            coordinate: Coordinate::Logarithmic,
            bounds: [(1.0 - share) * mean, (1.0 + share) * mean],
            prior: Prior::Normal {
                mean,
                deviation: 0.5 * share * mean,
            },
        }
    }

    /// A law of the list was stated beside an orifice at the end of its tolerance, "and nothing beyond it was tried": at no more than 90 % where it was right, and at that where the
    /// orifice alone was off.
    #[test]
    fn a_number_at_the_end_of_its_tolerance_is_tried_beyond_it() {
        for (factor, tried) in [(0.85, true), (0.99, false)] {
            let mut truth = plant();
            truth.device.supply_orifice *= factor;
            let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
            let mut search = search(&evidence);
            search.tolerated = vec![within(SUPPLY_ORIFICE.quantity(), 0.05)];
            search.candidates = CATALOGUE.iter().chain(&NUMBERS_OFF).collect();
            let spring = search.candidates.iter().copied();
            let spring = spring.filter(|e| e.name == "return_spring_load").collect();
            let only = Search {
                candidates: spring,
                ..search.clone()
            };
            let nominal = search.baseline();
            let rough = only.screen(&nominal, ROUGH, f64::INFINITY).swap_remove(0);
            let mut full = vec![search.refit(&rough, Refit::FULL)];
            search.add_beyond(&mut full, (&nominal, &[]), &mut |_| ());
            let names: Vec<Vec<&str>> = full.iter().map(Hypothesis::names).collect();
            match tried {
                true => {
                    assert_eq!(names[0], ["supply_restriction"], "{names:?}");
                    let orifice = full[0].fit.values[0] / truth.device.supply_orifice;
                    assert!((orifice - 1.0).abs() < 1e-3, "{orifice}");
                    assert_eq!(names.len(), 3, "{names:?}");
                }
                false => assert_eq!(names, [["return_spring_load"]]),
            }
        }
    }
}
