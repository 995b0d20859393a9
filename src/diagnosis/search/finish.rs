//! From full fits to an answer: what is not needed is taken out, what only the finest measure shows is put in, of equals the plainest comes first.

use super::super::cross_validation::{Depth, left_out};
use super::super::evidence::by_channel;
use super::super::fit::{
    FULL, Limit, ROUGH, Refit, Stage, Start, jacobian, robust_sum, rough_noise,
};
use super::super::free::{Free, free_of};
use super::super::hypothesis::{Hypothesis, covers, stands_for};
use super::super::progress::{Observer, Step};
use super::super::scale::Scale;
use super::{Climb, Search, same};
use crate::effects::Effect;
use crate::plant::{CHANNELS, Chain, Latent, PlantParameters, Quantity};

/// Standard deviations by which two fits' costs differ by chance in a measure that they were not fitted to, of a chi-square of as many numbers as are free [1].
const CHANCE: f64 = 6.0;
/// Close rivals that are fitted in full beside those that the search has fitted, at most.
const MOST_CLOSE: usize = 6;
/// Effects that only the finest measure shows which are fitted, of those that promise most.
const MOST_SMALL: usize = 3;
/// Influence of an effect on the channel that it moves most below which it is not named, in standard deviations of that channel's noise [1].
pub(in crate::diagnosis) const BELOW_NOISE: f64 = 0.5;
/// Error in time that is forgiven where that is judged [s].
const FORGIVEN: f64 = 1e-3;
/// Iterations of a rough fit without one of the effects.
const LIGHTER: usize = 8;
/// The last stages of a full fit, for what is all but there.
const LAST: &[Stage] = FULL.split_at(FULL.len() - 2).1;

/// Known effects that are fitted from where a formula stands, at most.
const MOST_DIRECT: usize = 2;
/// Share of the mismatch that the best effect must leave for a formula to be asked for at once [1].
const ONE_LEAVES: f64 = 0.25;
/// Sets of effects beside which a formula is asked for at a time, at most.
const MOST_BASES: usize = 3;

/// A fit again from where a richer hypothesis stands.
fn again(richer: &Hypothesis) -> Refit<'_> {
    Refit {
        start: Start::Where(&richer.fit.prediction.plant),
        stages: LAST,
        ..Refit::FULL
    }
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
                && stands_for(h, best)
                && !full.iter().any(|known| known.names() == h.names())
        };
        let mut more: Vec<Hypothesis> = rough
            .iter()
            .filter(plainer)
            .map(|h| self.refit(h, Refit::FULL))
            .collect();
        // Of a part of the device all such variants are fitted and told (`super::super::ruled_out`).
        let own = match self.believed.chain {
            Chain::Whole => self.shown.len()..best.effects.len(),
            _ => 0..0,
        };
        for index in own {
            let effect = best.effects[index];
            let numbers = |e: &Effect| e.parameters(&self.believed).len();
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
                false => (effect.parameters(&self.believed).iter())
                    .map(|parameter| parameter.quantity.get(there))
                    .collect(),
            };
            let own = free_of(effect, &self.believed, &start)
                .into_iter()
                .map(|f| {
                    let same = |other: &&Free| other.quantity.is(&f.quantity);
                    match best.fit.free.iter().find(same) {
                        Some(_) => f.from_where(there),
                        None => f,
                    }
                });
            let own: Vec<Free> = own.collect();
            free.retain(|f| !own.iter().any(|o| same(o, f, &self.believed)));
            free.extend(own);
        }
        let here = best.fit.free_from_here();
        let phases = here.iter().copied();
        free.extend(phases.filter(|f| effects.iter().any(|e| e.has_phase(&f.quantity))));
        let mut believed = self.believed.clone();
        if let Some(term) = best.unlisted() {
            believed.latent = Some(term.clone());
            free.extend_from_slice(&here[here.len() - term.numbers()..]);
        }
        let limit = Refit::FULL.limit;
        Some(Hypothesis {
            depends_on: best.depends_on.clone(),
            ..self.fitted(effects, (&believed, None), &free, FULL, limit)
        })
    }

    /// Fits in full the explanations that a rough fit cannot rule out beside the best one: nothing is said of a close rival by a rough fit. Where the best
    /// explains too little, a term without a name is to stand in its place, and these are no rivals. The best one with an effect more is none either: such
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
            .map(|h| self.rival(h, self.score(best)))
            .collect();
        for h in &more {
            observer(&Step::Variation.of(h, format!("close {:.1}", self.score(h))));
        }
        full.extend(more);
        // The search has weighed the first one with more than its score.
        full[1..].sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// A rival fitted in full; one that is hopelessly behind the best score before the finest measure is left there.
    fn rival(&self, rough: &Hypothesis, best: f64) -> Hypothesis {
        let coarse = Refit {
            stages: FULL.split_at(FULL.len() - 1).0,
            ..Refit::FULL
        };
        let fitted = self.refit(rough, coarse);
        match self.score(&fitted) < best + self.settings.given_up {
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
                && stands_for(h, best)
        };
        let plainest = (full.iter().enumerate())
            .filter(|(_, h)| plainer(h))
            .min_by_key(|(_, h)| h.fit.free.len());
        if let Some((index, _)) = plainest {
            let chosen = full.remove(index);
            full.insert(0, chosen);
        }
    }

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
        let in_cell = (self.evidence.recordings.iter()).any(|r| r.inputs.cell.is_some());
        let asks = !in_cell && !climb.asked.contains(&none.names()) && !self.is_spent();
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
        if self.believed.chain != Chain::Whole {
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

    /// Where no known effects explain the mismatch to the noise, puts a term without a name first if it does so, beside fewer of them or none; where they do
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
            || self.believed.chain != Chain::Whole
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
                found.extend(self.latent(best, rival, scale, observer));
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

    /// Puts a known effect in the place of the best formula where it leaves noise alone too: a rough fit of the believed model may have been bent so far
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
        self.fitted(effects, (&plant, None), &free, LAST, Refit::FULL.limit)
    }

    /// Takes effects out of the best hypothesis as long as it scores better without, the last one too: a rough fit of the believed model may have come to
    /// rest where an effect of no size let a full one go on. Beside a model error an effect must also gain more than what all of them leave: less may
    /// be a part of that error.
    pub(in crate::diagnosis) fn eliminate(
        &self,
        full: &mut Vec<Hypothesis>,
        observer: &mut Observer<'_>,
    ) {
        while let Some(best) = full.first()
            && best.effects.len() > self.shown.len()
            && best.unlisted().is_none()
            && !self.is_spent()
        {
            let score = self.score(best);
            // Beside a model error a fit from another minimum says nothing new.
            let weighed = !self.model_error.is_none();
            let known = |names: &[&str]| {
                let mut full = full.iter().filter(|_| weighed);
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
                match full.iter().position(|known| known.names() == one.names()) {
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
    fn without(&self, hypothesis: &Hypothesis, index: usize) -> Option<Hypothesis> {
        let fit = &hypothesis.fit;
        let plant = &fit.prediction.plant;
        let own = hypothesis.tolerated(&self.believed);
        let numbers = hypothesis.numbers_of(&self.believed, index);
        let phase = |f: &Free| hypothesis.effects[index].has_phase(&f.quantity);
        let kept = fit.free_from_here().into_iter().enumerate();
        let others: Vec<Free> = kept
            .filter(|(i, f)| *i >= own && !numbers.contains(i) && !phase(f))
            .map(|(_, f)| f)
            .collect();
        let mut free: Vec<Free> = self
            .tolerated
            .iter()
            .filter(|f| !others.iter().any(|o| same(o, f, &self.believed)))
            .map(|f| f.from_where(plant))
            .collect();
        free.extend(others);
        let mut effects = hypothesis.effects.clone();
        effects.remove(index);
        // What was not needed is missed at no sample.
        let from = (&self.believed, None);
        let limit = Limit::of(LIGHTER);
        let near = self.fitted(effects.clone(), from, &free, LAST, limit);
        if self.score(&near) < self.score(hypothesis) {
            return Some(near);
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
        Some(self.fitted(effects, from, &free, FULL, Refit::FULL.limit))
    }

    /// Takes out of the best hypothesis of a whole device what moves no channel by a share of its noise: recordings long enough show what nobody would miss.
    pub(super) fn drop_below_noise(&self, full: &mut Vec<Hypothesis>, observer: &mut Observer<'_>) {
        while let Some(best) = full.first()
            && best.unlisted().is_none()
            && self.believed.chain == Chain::Whole
            && !self.is_spent()
        {
            let own = self.shown.len()..best.effects.len();
            let sizes = own.map(|index| (index, self.influence(best, index)));
            let Some((index, size)) = sizes.min_by(|a, b| a.1.total_cmp(&b.1)) else {
                break;
            };
            if size >= BELOW_NOISE {
                break;
            }
            let name = best.effects[index].name;
            observer(&Step::Variation.of(best, format!("{name} moves {size:.2} sigmas at most")));
            let Some(lighter) = self.without(best, index) else {
                break;
            };
            full.retain(|h| !h.effects.iter().any(|effect| effect.name == name));
            full.retain(|h| h.names() != lighter.names());
            full.insert(0, lighter);
        }
    }

    /// Fits the nominal model from where the best hypothesis has its tolerated numbers, where that is not hopeless and was not done: what explains by no more than
    /// leading a fit to them is missing nothing.
    pub(super) fn add_nominal(&self, full: &mut Vec<Hypothesis>, observer: &mut Observer<'_>) {
        let is_nominal = |h: &Hypothesis| self.found(h) == 0 && h.unlisted().is_none();
        if full.iter().any(is_nominal) || self.is_spent() {
            return;
        }
        let Some(best) = full.first() else { return };
        let shown = self.shown.iter().flat_map(|shown| &shown.numbers);
        let free = self.tolerated.iter().chain(shown);
        let free: Vec<Free> = free
            .map(|f| f.from_where(&best.fit.prediction.plant))
            .collect();
        let mut bare = self.believed.clone();
        for f in &free {
            f.quantity
                .set(&mut bare, f.quantity.get(&best.fit.prediction.plant));
        }
        let there = self.evidence.predict(&bare, false, None);
        if robust_sum(&there.residuals) - best.fit.misfit > self.settings.given_up {
            return;
        }
        let effects = self.shown.iter().map(|shown| shown.effect).collect();
        let nominal = self.fitted(
            effects,
            (&self.believed, None),
            &free,
            LAST,
            Limit::of(LIGHTER),
        );
        observer(&Step::Variation.of(&nominal, format!("score {:.1}", self.score(&nominal))));
        full.push(nominal);
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// What an effect of a hypothesis does to the channel that it moves most ([`Self::moved_by`]).
    fn influence(&self, hypothesis: &Hypothesis, index: usize) -> f64 {
        let plant = &hypothesis.fit.prediction.plant;
        let own = hypothesis.effects[index].parameters(&self.believed);
        let nominal = |quantity: &Quantity| quantity.get(&self.believed);
        let mut bare = plant.clone();
        if own.iter().all(|p| nominal(&p.quantity).is_finite()) {
            for parameter in &own {
                parameter
                    .quantity
                    .set(&mut bare, nominal(&parameter.quantity));
            }
        } else {
            // Another law stands in its place, such as that of air at one temperature: no number of it puts that back.
            bare = self.believed.clone();
            bare.latent.clone_from(&plant.latent);
            let is_own = |f: &Free| own.iter().any(|p| p.quantity.is(&f.quantity));
            for f in hypothesis.fit.free.iter().filter(|f| !is_own(f)) {
                f.quantity.set(&mut bare, f.quantity.get(plant));
            }
        }
        self.moved_by(plant, &bare)
    }

    /// Whether a term moves a channel by a share of its noise that somebody would miss.
    pub(in crate::diagnosis) fn term_shows(&self, hypothesis: &Hypothesis) -> bool {
        let plant = &hypothesis.fit.prediction.plant;
        let mut bare = plant.clone();
        bare.latent = None;
        self.moved_by(plant, &bare) >= BELOW_NOISE
    }

    /// What tells a description from a bare one in the channel that it moves most, root mean square, in standard deviations of its noise, with an error in time
    /// of 1 ms forgiven: an impact that is met a little earlier is a spike, and no matter [1].
    fn moved_by(&self, plant: &PlantParameters, bare: &PlantParameters) -> f64 {
        let with = self.evidence.predict(plant, false, None);
        let without = self.evidence.predict(bare, false, None);
        let shares = self.evidence.shares(FORGIVEN, false);
        let moved: Vec<f64> = (with.residuals.iter().zip(&without.residuals))
            .zip(shares.iter())
            .map(|((with, without), share)| (with - without) * share)
            .collect();
        let mut sums = [[0.0; 2]; CHANNELS.len()];
        for (_, channel, moved) in by_channel(self.evidence, &moved) {
            let [squares, count] = &mut sums[channel as usize];
            for change in moved.iter().filter(|change| change.is_finite()) {
                *squares += change * change;
                *count += 1.0;
            }
        }
        let sizes = sums.map(|[squares, count]| (squares / f64::max(count, 1.0)).sqrt());
        sizes.into_iter().fold(0.0, f64::max)
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
            let promising = self.screen(best, Refit::FINEST.stages, most).into_iter();
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
    fn predicts_better(
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
