//! Formulas beside the known effects of a search, and known effects in the place of a formula.

use super::super::fit::{Limit, ROUGH, Refit, Start, jacobian, rough_noise};
use super::finish::LAST;
use super::progress::{Observer, Step};
use super::scale::Scale;
use super::{Climb, Search};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::plant::{DeviceParts, Latent};

/// Known effects that are fitted from where a formula stands, at most.
const MOST_DIRECT: usize = 2;
/// Share of the mismatch that the best effect must leave for a formula to be asked for at once [1].
const ONE_LEAVES: f64 = 0.25;
/// Sets of effects beside which a formula is asked for at a time, at most.
const MOST_BASES: usize = 3;

impl Search<'_> {
    /// Whether one effect leaves so much of the mismatch that formulas are asked for at once.
    pub(super) fn asks_early(&self, best: &Hypothesis, scale: &Scale) -> bool {
        let noise = rough_noise(self.evidence) + scale.rough_spread();
        best.fit.rough > noise && scale.left_roughly(best) > ONE_LEAVES
    }

    /// Puts formulas that leave noise alone in a climb, beside fewer of the leading child's effects, with those of the children that do so too.
    pub(super) fn formulas_beside_fewer(
        &self,
        climb: &mut Climb,
        children: &[Hypothesis],
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let fewer: Vec<Hypothesis> = climb.levels.iter().flatten().cloned().collect();
        let fewer = (&fewer[..], &mut climb.asked);
        let formulas = self.beside_fewer(&children[0], fewer, scale, observer);
        let Some(first) = formulas.first() else {
            return;
        };
        // A full fit has never gained as much as a hopeless one would have to.
        let most = self.rough_score(first) + self.settings.given_up;
        let near = children.iter().filter(|h| self.rough_score(h) < most);
        let near: Vec<Hypothesis> = near.cloned().collect();
        let mut full = self.in_full(&near, scale, &mut climb.done, observer);
        full.retain(|h| scale.is_adequate(h));
        full.extend(formulas);
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        climb.full = full;
    }

    /// Adds formulas that leave noise alone by themselves where two named effects do: two of the list may stand in for one law that it does not hold. As
    /// many are looked at, a formula must score better by what two effects cost for that.
    pub(super) fn add_one_law(
        &self,
        climb: &mut Climb,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let (none, single) = (
            &climb.levels[0][0],
            climb.levels.get(1).map(|level| &level[0]),
        );
        // In a cell a curve costs minutes.
        let asks = !self.is_in_cell() && !climb.asked.contains(&none.names()) && !self.is_spent();
        let Some(single) = single.filter(|_| asks) else {
            return;
        };
        climb.asked.push(none.names());
        let mut found = self.adequate_formulas(none, single.fit.rough, scale, observer);
        let allowed = self.score(&climb.full[0]) - 2.0 * self.settings.look_elsewhere;
        found.retain(|h| h.formula().is_some() && self.score(h) < allowed);
        climb.full.extend(found);
        (climb.full).sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// Formulas that leave noise alone beside fewer of an explanation's effects, none of them first; of the first of these sets that has such. What was asked
    /// for before is not asked for again.
    fn beside_fewer(
        &self,
        best: &Hypothesis,
        (rough, asked): (&[Hypothesis], &mut Vec<Vec<&'static str>>),
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        if self.nominal.parts != DeviceParts::Whole {
            return Vec::new();
        }
        let within = |h: &&Hypothesis| {
            let mut own = h.effects.iter();
            h.effects.len() < best.effects.len()
                && own.all(|effect| best.effects.iter().any(|e| e.name == effect.name))
        };
        let mut bases: Vec<&Hypothesis> = rough.iter().filter(within).collect();
        bases.sort_by(|a, b| {
            let fewer = a.effects.len().cmp(&b.effects.len());
            fewer.then(self.rough_score(a).total_cmp(&self.rough_score(b)))
        });
        bases.retain(|h| !asked.contains(&h.names()));
        for base in bases.into_iter().take(MOST_BASES) {
            if self.is_spent() {
                break;
            }
            asked.push(base.names());
            let found = self.adequate_formulas(base, best.fit.rough, scale, observer);
            if !found.is_empty() {
                return found;
            }
        }
        Vec::new()
    }

    /// Where no known effects explain the mismatch to the noise, puts a model discrepancy first if it does so, beside fewer of them or none; where they do
    /// not explain it at all, if it explains more.
    pub(super) fn add_unlisted(
        &self,
        full: &mut Vec<Hypothesis>,
        (unexplained, rough, asked): (&Hypothesis, &[Hypothesis], &mut Vec<Vec<&'static str>>),
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let Some(best) = full.first() else { return };
        if scale.is_adequate(best)
            || best.unlisted().is_some()
            || self.nominal.parts != DeviceParts::Whole
            || self.is_spent()
        {
            return;
        }
        let rival = best.fit.rough;
        let mut found = self.beside_fewer(best, (rough, asked), scale, observer);
        if found.is_empty() && !scale.is_explained(best) && !self.is_spent() {
            found = self.adequate_formulas(best, rival, scale, observer);
        }
        if found.is_empty() && !scale.is_explained(best) && !self.is_spent() {
            found = self.latent(unexplained, rival, scale, observer);
            if scale.is_half_explained(best) && !self.is_spent() {
                found.extend(self.within_effort(|| self.latent(best, rival, scale, observer)));
            }
            found.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        }
        let mut found = found.into_iter();
        if let Some(first) = found.next()
            && self.score(&first) < self.score(&full[0])
        {
            let spared =
                |h: &Hypothesis| scale.is_adequate(h) || self.score(h) <= self.score(&first);
            let without = (first.unlisted().is_some()).then(|| self.without_term(&first));
            match without.filter(spared) {
                Some(without) => {
                    let detail = format!("without a term {:.1}", self.score(&without));
                    observer(&Step::Variation.of(&without, detail));
                    full.insert(0, without);
                }
                None => {
                    full.insert(0, first);
                    full.extend(found);
                    full[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
                }
            }
        }
    }

    /// Takes the effects out that have done no more than lead to the best one's term, and asks for formulas in the place of a curve from where that leaves it: beside
    /// what is not there no formula does what a curve can.
    pub(super) fn simplify_beside_term(
        &self,
        full: &mut Vec<Hypothesis>,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let has_term = |h: &&Hypothesis| h.unlisted().is_some();
        let Some(before) = full.first().filter(has_term).map(|h| h.effects.len()) else {
            return;
        };
        self.eliminate(full, observer);
        let is_lighter = |h: &&Hypothesis| has_term(h) && h.effects.len() < before;
        let Some(curve) = full.first().filter(is_lighter) else {
            return;
        };
        if curve.formula().is_some() || self.is_spent() {
            return;
        }
        let base = self.where_its_term_was(curve);
        let rough = self.refit(curve, Refit::ROUGH.from(Start::Here));
        let mut found = self.formulas(&base, &[rough], scale, observer);
        found.retain(|h| self.term_shows(h) && self.is_finite(h));
        for one in &mut found {
            one.depends_on.clone_from(&curve.depends_on);
        }
        full.extend(found);
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// Puts a known effect in the place of the best formula where it leaves noise alone too: a rough fit of the nominal model may have been bent so far
    /// that no known effect promised anything beside it, and where the formula has put what is tolerated one does. A law of the list is the likelier one.
    pub(in crate::diagnosis) fn put_named_first(
        &self,
        found: &mut Vec<Hypothesis>,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        let Some(formula) = found.first().filter(|_| !self.is_spent()) else {
            return;
        };
        let from = self.where_its_term_was(formula);
        let most = self.settings.far_behind * self.left_alone(scale);
        let mut named = self.screen(&from, ROUGH, most);
        named.retain(|h| self.rough_score(h) < most);
        named.truncate(self.settings.fitted_in_full);
        // From where the formula has put the rest: a held piston may draw that elsewhere.
        let there = Refit {
            start: Start::Here,
            stages: LAST,
            ..Refit::FULL
        };
        let mut direct: Vec<Hypothesis> = (named.iter().take(MOST_DIRECT))
            .map(|h| self.refit(h, there))
            .filter(|h| scale.is_adequate(h))
            .collect();
        direct.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        if direct.is_empty() {
            for h in &mut named {
                *h = self.refit(h, Refit::ROUGH.from(Start::Here));
            }
            // One that leaves more than noise where the piston is held does so in full.
            named.retain(|h| h.fit.rough < self.left_alone(scale));
            direct = self.in_full(&named, scale, &mut Vec::new(), observer);
            direct.retain(|h| scale.is_adequate(h));
        }
        let allowed = self.score(&found[0]) + self.settings.look_elsewhere;
        if let Some(first) = direct.into_iter().next()
            && self.score(&first) < allowed
        {
            found.insert(0, first);
        }
    }

    /// The known effects of a hypothesis with a term, where they are beside it, with the piston held and without the term.
    pub(in crate::diagnosis) fn where_its_term_was(&self, formula: &Hypothesis) -> Hypothesis {
        let own = formula.unlisted().map_or(0, Latent::numbers);
        let mut free = formula.fit.free_from_here();
        free.truncate(free.len() - own);
        let mut plant = formula.fit.prediction.plant.clone();
        plant.latent = None;
        let effects = formula.effects.clone();
        let mut from = self.fitted(effects, (&plant, None), &free, ROUGH, Limit::of(0));
        let at = &from.fit;
        from.fit.columns = jacobian(self.evidence, &at.prediction, &free, &at.values, 0);
        from
    }

    /// A hypothesis without its term, fitted again from where it is.
    fn without_term(&self, hypothesis: &Hypothesis) -> Hypothesis {
        let own = hypothesis.unlisted().map_or(0, Latent::numbers);
        let mut free = hypothesis.fit.free_from_here();
        free.truncate(free.len() - own);
        let mut plant = hypothesis.fit.prediction.plant.clone();
        plant.latent = None;
        let effects = hypothesis.effects.clone();
        let free = self.settled(free);
        self.fitted(effects, (&plant, None), &free, LAST, Limit::FULL)
    }
}
