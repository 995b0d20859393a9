//! How sure a diagnosis is of its effects and of the families that they are of.

use super::details::{FamilyMember, FamilyReport};
use super::doubt::Doubt;
use super::estimate::{Estimate, estimates};
use super::family::{FAMILIES, Family, family_of, is_alike, scaling};
use super::finding::Diagnosis;
use super::statements::{doubts_of, stated};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::robust_sum;
use crate::diagnosis::search::ranking::Ranked;
use crate::diagnosis::search::ruled_out::RuledOut;
use crate::diagnosis::search::scale::IMMATERIAL;
use crate::effects::{Effect, LINK_EFFECTS, NUMBERS_OFF, UNLISTED, every};
use crate::plant::Channel;

/// Ratio of what two laws leave up to which one does as well as the other [1]: a hundredth is what a law of the catalogue is good to.
const AS_WELL: f64 = 1.01;
/// Probability from which a law of a family is named [1].
const NAMED: f64 = 0.01;

/// Whether an explanation has an effect, by its name.
fn has(hypothesis: &Hypothesis, name: &str) -> bool {
    match name {
        UNLISTED => hypothesis.unlisted().is_some(),
        _ => hypothesis.effects.iter().any(|e| e.name == name),
    }
}

impl Diagnosis {
    /// Probability that is stated of an effect, by its name.
    #[must_use]
    pub fn confidence(&self, name: &str) -> f64 {
        stated(self.probability(name), &self.doubts(name))
    }

    /// Doubts about an effect of the best explanation.
    #[must_use]
    pub fn doubts(&self, name: &str) -> Vec<Doubt> {
        let mut doubts = doubts_of(&self.numbers_of(name));
        if self.costs_nothing(name) {
            doubts.push(Doubt::CostsNothing);
        }
        if self.another_does_as_well(name) {
            doubts.push(Doubt::AnotherDoesAsWell);
        }
        if !self.untried().is_empty() {
            doubts.push(Doubt::NotTriedBeyond);
        }
        if self.far_above().is_some() {
            doubts.push(Doubt::LeavesMuch);
        }
        doubts
    }

    /// Numbers of an effect of the best explanation that are a part of the answer.
    fn numbers_of(&self, name: &str) -> Vec<Estimate> {
        let own = self.estimates.effects.iter();
        let numbers = match name {
            UNLISTED => Some(&self.estimates.formula),
            _ => own
                .into_iter()
                .find(|(e, _)| e.name == name)
                .map(|(_, n)| n),
        };
        let numbers = numbers.into_iter().flatten();
        numbers
            .filter(|n| n.reported || self.is_of_link())
            .map(Estimate::from)
            .collect()
    }

    /// Probability that an effect is at work by the evidence: that of the explanations with it, times G / (G + L), G what it gains over the best one of the
    /// others alone and L what all effects together leave beyond noise, of which what it gains may be a part; or times (R + M) / (R + 2 M), R what it gains
    /// over another effect in its place, where that is less: M, what is left and what laws leave by being idealised, may tip the balance between the two.
    fn probability(&self, name: &str) -> f64 {
        let own = self.best().effects.iter().find(|e| e.name == name);
        // A law that excludes it or is of its family is no explanation without what it stands for: the probability weighs that.
        let in_place =
            |h: &Hypothesis| own.is_some_and(|own| h.effects.iter().any(|e| is_alike(e, own)));
        self.probability_of(&|h| has(h, name), &in_place)
    }

    /// The same of explanations of a kind; those `in_place` of them are not held against them.
    fn probability_of(
        &self,
        has: &dyn Fn(&Hypothesis) -> bool,
        in_place: &dyn Fn(&Hypothesis) -> bool,
    ) -> f64 {
        let with = self.ranked.iter().filter(|r| has(&r.hypothesis));
        let probability = with.map(|r| r.probability).sum::<f64>().min(1.0);
        let left = self.left_of_laws();
        let another = |h: &Hypothesis| !has(h) && !in_place(h) && !self.is_within_best(h);
        let gain = self.gain_over(&another);
        let beside = match left > 0.0 && gain.is_finite() {
            true => (gain + left) / (gain + 2.0 * left),
            false => 1.0,
        };
        probability * self.not_left(has).min(beside)
    }

    /// Probability that what an effect of the best explanation gains is no part of what all of them leave [1], with its doubts: what is said of it where no other
    /// explanation stands beside.
    pub(in crate::diagnosis) fn certain_alone(&self, name: &str) -> f64 {
        stated(self.not_left(&|h| has(h, name)), &self.doubts(name))
    }

    /// G / (G + L).
    fn not_left(&self, has: &dyn Fn(&Hypothesis) -> bool) -> f64 {
        let gain = self.gain_over(&|h| !has(h) && self.is_within_best(h));
        let left = self.left_beside(has);
        match left > 0.0 && gain.is_finite() {
            true => gain / (gain + left),
            false => 1.0,
        }
    }

    /// L, with what the idealisation of the other effects may leave.
    fn left_beside(&self, has: &dyn Fn(&Hypothesis) -> bool) -> f64 {
        let gain = self.gain_over(&|h| !has(h) && self.is_within_best(h));
        self.left_beyond_noise() + self.idealised_beside(gain)
    }

    /// Odds of another explanation against the best that what is left may come to [1], L / (R + L), times what each effect that it has more costs beforehand: none of one
    /// that has effects of the best alone, or laws in their places that are of their kind.
    pub(in crate::diagnosis) fn odds_by_what_is_left(&self, other: &Hypothesis) -> f64 {
        let lacks = |own: &&&Effect| !other.effects.iter().any(|e| e.excludes(own));
        let replaced: Vec<&str> = (self.best().effects.iter().filter(lacks))
            .map(|own| own.name)
            .collect();
        if replaced.is_empty() || self.is_within_best(other) {
            return 0.0;
        }
        let left = self.left_of_laws();
        let gain = (other.fit.cost() - self.best().fit.cost()).max(0.0);
        let more = other
            .effects
            .len()
            .saturating_sub(self.best().effects.len());
        let beforehand = (-0.5 * self.settings.look_elsewhere * more as f64).exp();
        match left > 0.0 {
            true => beforehand * left / (gain + left),
            false => 0.0,
        }
    }

    /// What is left beyond noise, with what the idealisation of the laws may leave of all that they explain: between two laws either may be a little wrong by that.
    fn left_of_laws(&self) -> f64 {
        self.left_beyond_noise() + self.idealised_beside(0.0)
    }

    /// Whether an explanation has effects of the best one alone.
    fn is_within_best(&self, other: &Hypothesis) -> bool {
        let best = self.best();
        let known = |e: &&Effect| best.effects.iter().any(|own| own.name == e.name);
        other.effects.iter().all(known) && (other.unlisted().is_none() || best.unlisted().is_some())
    }

    /// Gain of the best explanation over the best one of a kind; infinite where none was fitted.
    fn gain_over(&self, of: &dyn Fn(&Hypothesis) -> bool) -> f64 {
        let own = &self.best().fit;
        let those = self.ranked.iter().filter(|r| of(&r.hypothesis));
        let least = those.map(|r| match self.remaining {
            // Those far behind were not fitted to all samples; scores are of the same ones.
            Some(_) => r.score - self.ranked[0].score,
            None => r.hypothesis.fit.cost() - own.cost(),
        });
        least.fold(f64::INFINITY, f64::min).max(0.0)
    }

    /// Cost that the best explanation leaves beyond noise [1].
    fn left_beyond_noise(&self) -> f64 {
        let own = &self.best().fit;
        match &self.remaining {
            // What no law explains of a part counts as its noise: all of that but the sensor's own is left by the laws.
            Some(remaining) => {
                remaining.beyond_noise() * own.misfit / remaining.autocorrelation_samples
            }
            None => self.model_error.left(&self.evidence, own),
        }
    }

    /// Part of what else is explained that the idealisation of its laws may leave, and an effect of a gain take up [1].
    fn idealised_beside(&self, gain: f64) -> f64 {
        if self.remaining.is_some() {
            return 0.0;
        }
        let before = robust_sum(&self.baseline.prediction.residuals);
        let others = before - self.best().fit.misfit - gain;
        IMMATERIAL * others.max(0.0)
    }

    /// Whether an explanation without an effect, fitted, leaves as little.
    fn costs_nothing(&self, name: &str) -> bool {
        let others: Vec<&str> = self.best().effects.iter().map(|e| e.name).collect();
        let others: Vec<&str> = others.into_iter().filter(|n| *n != name).collect();
        let same = |names: &[&str]| {
            names.len() == others.len() && names.iter().all(|n| others.contains(n))
        };
        self.leaves_as_little(&same)
    }

    /// Whether an explanation with another law in an effect's place, fitted, leaves as little.
    fn another_does_as_well(&self, name: &str) -> bool {
        let best = &self.best().effects;
        let Some(own) = best.iter().find(|e| e.name == name) else {
            return false;
        };
        let instead = |names: &[&str]| {
            let kept = best.iter().filter(|e| names.contains(&e.name)).count();
            let excluded = LINK_EFFECTS.iter().chain(every());
            names.len() == best.len()
                && kept + 1 == best.len()
                && !names.contains(&name)
                && excluded
                    .into_iter()
                    .any(|e| names.contains(&e.name) && e.excludes(own))
        };
        self.leaves_as_little(&instead)
    }

    /// Whether a variant of a kind leaves as little of a part's channel as the best explanation.
    fn leaves_as_little(&self, kind: &dyn Fn(&[&str]) -> bool) -> bool {
        let Some(channel) = self.nominal.parts.output() else {
            return false;
        };
        // A whole device's variants were compared by their evidence, and an effect that is not worth its numbers was taken out.
        let mut variants = self.ruled_out.iter().filter(|v| kind(&v.effects));
        variants.any(|variant| self.does_as_well(variant, channel))
    }

    /// Whether a variant leaves as little of a part's channel as the best explanation.
    pub(in crate::diagnosis) fn does_as_well(&self, variant: &RuledOut, channel: Channel) -> bool {
        variant.rms <= AS_WELL * self.left_of(channel)
    }

    /// Numbers of the rig file that stand at an end of their tolerance, and that no explanation that was fitted has beyond it.
    #[must_use]
    pub fn untried(&self) -> Vec<&'static str> {
        let free = &self.best().fit.free;
        let at_end = self
            .estimates
            .tolerated
            .iter()
            .filter(|n| n.at_limit.is_some());
        let untried = at_end.filter(|number| {
            let mut own = free.iter().filter(|f| f.quantity.name == number.name);
            let Some(own) = own.next() else { return false };
            let frees = |e: &&Effect| e.frees(&self.nominal, &own.quantity);
            let beyond: Vec<&str> = (every().chain(LINK_EFFECTS).chain(&NUMBERS_OFF))
                .filter(frees)
                .map(|e| e.name)
                .collect();
            let fitted = self.ranked.iter().flat_map(|r| &r.hypothesis.effects);
            let roughly = self.roughly.iter().flat_map(|r| &r.effects);
            let mut tried = fitted.map(|e| e.name).chain(roughly.copied());
            // What no effect frees is no number of the sheet.
            !beyond.is_empty() && !tried.any(|name| beyond.contains(&name))
        });
        untried.map(|number| number.name).collect()
    }

    /// Families of the effects of the best explanation, with their laws.
    pub(in crate::diagnosis) fn families(&self) -> Vec<FamilyReport> {
        let of = |family: &&Family| {
            self.best()
                .effects
                .iter()
                .any(|e| family_of(e) == Some(*family))
        };
        FAMILIES
            .iter()
            .filter(of)
            .map(|family| self.family(family))
            .collect()
    }

    /// A family with its probability and those of its laws, the likeliest first.
    pub(in crate::diagnosis) fn family(&self, family: &'static Family) -> FamilyReport {
        let is_of = |e: &Effect| family_of(e) == Some(family);
        let has = |h: &Hypothesis| h.effects.iter().any(|e| is_of(e));
        let best = &self.best().effects;
        let mut members: Vec<FamilyMember> = Vec::new();
        for effect in self.ranked.iter().flat_map(|r| &r.hypothesis.effects) {
            let (name, key) = (effect.vocabulary().0.to_owned(), effect.number_key());
            let known = |m: &FamilyMember| m.name == name && m.key.as_deref() == key;
            if !is_of(effect) || members.iter().any(known) {
                continue;
            }
            let probability = match best.iter().any(|e| e.name == effect.name) {
                true => self.confidence(effect.name),
                false => {
                    let with =
                        |r: &&Ranked| r.hypothesis.effects.iter().any(|e| e.name == effect.name);
                    let with = self.ranked.iter().filter(with);
                    with.map(|r| r.probability).sum::<f64>().min(1.0)
                }
            };
            members.push(FamilyMember {
                number: scaling(&name, key).and_then(|_| self.number_with(effect)),
                name,
                key: key.map(str::to_owned),
                probability,
            });
        }
        let own = |m: &FamilyMember| {
            best.iter()
                .any(|e| e.vocabulary().0 == m.name && e.number_key() == m.key.as_deref())
        };
        members.retain(|m| m.probability >= NAMED || own(m));
        members.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        // A number of a law that is not known well is a doubt of that law, none that one of its family is at work.
        let mut doubts: Vec<Doubt> = (best.iter())
            .filter(|e| is_of(e))
            .flat_map(|e| self.doubts(e.name))
            .collect();
        doubts.retain(|d| {
            !matches!(
                d,
                Doubt::AnotherDoesAsWell | Doubt::AtEndOfRange | Doubt::SpansDecade
            )
        });
        let likeliest = members.iter().map(|m| m.probability).fold(0.0, f64::max);
        let probability = stated(self.probability_of(&has, &|_| false), &doubts);
        FamilyReport {
            name: family.name.to_owned(),
            words: family.words.to_owned(),
            probability: probability.max(likeliest),
            members,
        }
    }

    /// The number of an effect given the likeliest explanation with it: no other widens its interval.
    fn number_with(&self, effect: &Effect) -> Option<Estimate> {
        let has = |r: &&Ranked| r.hypothesis.effects.iter().any(|e| e.name == effect.name);
        let given = self.ranked.iter().find(has)?;
        let of_it = estimates(&self.nominal, std::slice::from_ref(given), &self.evidence);
        let mut own = of_it.effects.iter().filter(|(e, _)| e.name == effect.name);
        let mut numbers = own.next()?.1.iter().filter(|n| n.reported);
        numbers.next().map(Estimate::from)
    }
}
