//! A law that a user tries: fitted in full whatever the search comes to, and held against its answer.

use super::Search;
use super::progress::{Observer, Step};
use super::ranking::Ranked;
use crate::diagnosis::answer::estimate::{Number, estimates};
use crate::diagnosis::difference::extent::Largest;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{ROUGH, Refit};
use crate::diagnosis::recordings::evidence::Evidence;
use crate::effects::Effect;
use crate::plant::PlantParameters;

/// What became of a law that was tried.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Place among the explanations of the first that has it.
    pub place: usize,
    /// Its numbers there.
    pub numbers: Vec<Number>,
    /// Largest departure of that explanation from the recordings.
    pub largest: Option<Largest>,
}

impl Tried {
    /// Of the explanations; none where no fit with it came to an end.
    pub(in crate::diagnosis) fn of(
        effect: &'static Effect,
        nominal: &PlantParameters,
        (ranked, evidence): (&[Ranked], &Evidence),
    ) -> Option<Self> {
        let place = (ranked.iter()).position(|r| has(&r.hypothesis, effect))?;
        let own = &ranked[place];
        let all = estimates(nominal, std::slice::from_ref(own), evidence).effects;
        let numbers = all.into_iter().find(|(other, _)| other.name == effect.name);
        Some(Self {
            place,
            numbers: numbers.map_or_else(Vec::new, |(_, numbers)| numbers),
            largest: Largest::of(evidence, own, None),
        })
    }
}

fn has(hypothesis: &Hypothesis, effect: &Effect) -> bool {
    (hypothesis.effects.iter()).any(|other| other.name == effect.name)
}

impl Search<'_> {
    /// Adds a law to explanations none of which has it: beside the known effects of one that has a formula beside them, otherwise alone.
    pub(in crate::diagnosis) fn add_tried(
        &self,
        found: &mut Vec<Hypothesis>,
        effect: &'static Effect,
        observer: &mut Observer<'_>,
    ) {
        if found.iter().any(|known| has(known, effect)) {
            return;
        }
        let base = match found.first() {
            Some(best) if best.unlisted().is_some() => self.where_its_term_was(best),
            _ => self.baseline(),
        };
        let only = Search {
            candidates: vec![effect],
            ..self.clone()
        };
        let Some(rough) = only.screen(&base, ROUGH, f64::INFINITY).into_iter().next() else {
            return;
        };
        let full = self.refit(&rough, Refit::FULL);
        let score = self.score(&full);
        observer(&Step::FullFit.of(&full, format!("tried, score {score:.1}")));
        // As with the search's own explanations, what is put first for another reason is overtaken only beyond doubt.
        let doubt = -2.0 * self.settings.least_odds.ln();
        let first = |h: &Hypothesis| self.score(h) > score + doubt;
        match found.first().is_none_or(first) {
            true => found.insert(0, full),
            false => {
                let behind = found[1..].iter().position(|h| self.score(h) > score);
                found.insert(behind.map_or(found.len(), |place| place + 1), full);
            }
        }
    }
}
