//! The search: effects one after the other, each the one that gains most for its numbers, until none gains more than chance would.
//!
//! ```text
//! worth = (decrease of the cost) - k ln N
//! ```
//!
//! k numbers that it frees, N rows of the channels (Schwarz 1978, Annals of Statistics 6, 461).

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::effect::{ArmEffect, Candidate, candidates};
use super::evidence::Evidence;
use super::extent::{changes, largest};
use super::fit::{Columns, Fit, Scales, correlation_of, products, scales_of, weighed};
use super::hypothesis::{Hypothesis, screen};
use super::laws::laws;
use super::pushed::pushes;
use crate::diagnosis::search::progress::{Observer, Step};
use crate::recorded_arm::Quantity;
use crate::recorded_arm::law::{JointLaw, Shape};

/// Worth from which an effect is taken in [1].
const WORTH: f64 = 16.0;
/// What a law without a name must gain beyond one that has one, since it is one of thousands [1].
const UNNAMED: f64 = 35.0;
/// Share of the first effect's gain below which a further one may be what its textbook form leaves [1].
const REMAINDER: f64 = 0.004;
/// Share of an effect's gain with which one that it contains says it all [1].
const ENOUGH: f64 = 0.93;
/// Standard deviations of the noise by which an effect must move a channel somewhere [1].
const SEEN: f64 = 2.0;
/// Candidates that are fitted wholly at a stage.
const FITTED: usize = 4;
/// Effects at most.
const MOST: usize = 24;

/// A candidate, fitted beside those taken in before.
#[derive(Debug, Clone)]
pub struct Tried {
    /// The effect.
    pub effect: ArmEffect,
    /// Decrease of the cost [1].
    pub gain: f64,
    /// That less what its numbers cost [1].
    pub worth: f64,
    /// The hypothesis.
    pub hypothesis: Hypothesis,
}

/// Result of a search.
#[derive(Debug, Clone)]
pub struct Found {
    /// The description within its tolerances.
    pub nominal: Hypothesis,
    /// The best.
    pub best: Hypothesis,
    /// Scales of its residuals.
    pub scales: Scales,
    /// What was tried, stage by stage.
    pub stages: Vec<Stage>,
}

/// A stage of a search.
#[derive(Debug, Clone)]
pub struct Stage {
    /// What was tried, best first.
    pub tried: Vec<Tried>,
    /// The one that was taken in, if one was.
    pub accepted: Option<usize>,
}

impl Stage {
    /// The one that was taken in.
    #[must_use]
    pub fn accepted(&self) -> Option<&Tried> {
        self.accepted.map(|place| &self.tried[place])
    }
}

/// What a search works with.
struct Search<'a> {
    evidence: &'a Evidence<'a>,
    listed: Vec<Candidate>,
    columns: Columns,
    scales: Scales,
}

/// Searches for what is missing; `observer` gets each stage.
#[must_use]
pub fn search(evidence: &Evidence, observer: &mut Observer<'_>) -> Found {
    let mut columns = Columns::default();
    let mut scales = vec![1.0; evidence.rows.len()];
    let mut nominal = Hypothesis::nominal(evidence, &scales, &mut columns);
    for _ in 0..2 {
        scales = scales_of(&nominal.fit.residuals);
        nominal = Hypothesis::nominal(evidence, &scales, &mut columns);
    }
    let mut search = Search {
        evidence,
        listed: candidates(evidence.input),
        columns,
        scales,
    };
    let mut best = nominal.clone();
    let mut stages: Vec<Stage> = Vec::new();
    for number in 0..MOST {
        let step = match number {
            0 => Step::RoughFit,
            1 => Step::FullFit,
            _ => Step::Variation,
        };
        observer(&step.with(format!("stage {}", number + 1)));
        let (tried, accepted) = search.stage(&best, &stages);
        let next = accepted.map(|i| tried[i].hypothesis.clone());
        stages.push(Stage { tried, accepted });
        let Some(next) = next else { break };
        best = search.settled(&next);
    }
    best = search.without_needless(best);
    Found {
        nominal,
        best,
        scales: search.scales,
        stages,
    }
}

impl Search<'_> {
    /// A hypothesis with the scales that it leaves.
    fn settled(&mut self, hypothesis: &Hypothesis) -> Hypothesis {
        self.scales = scales_of(&hypothesis.fit.residuals);
        Hypothesis::of_same(self.evidence, hypothesis, &self.scales, &mut self.columns)
    }

    /// What is tried beside a hypothesis, best first, and the one that is taken in. Laws without a name are tried where a listed effect would be taken in, to
    /// see whether they do better, or everywhere if there is none.
    fn stage(&mut self, best: &Hypothesis, before: &[Stage]) -> (Vec<Tried>, Option<usize>) {
        let mut listed = self.listed.clone();
        listed.extend(pushes(self.evidence, &best.fit, &self.scales));
        let mut tried = self.try_each(best, listed);
        let first = self.acceptable(&tried, before);
        let joints: Vec<usize> = match first {
            Some(place) => tried[place].effect.joint().into_iter().collect(),
            None => (0..self.evidence.input.nominal.joints()).collect(),
        };
        let laws = joints
            .iter()
            .flat_map(|joint| laws(self.evidence, &best.fit, *joint));
        // One periodic torque of a gear has a name.
        let known = best.names();
        let named = |law: &JointLaw| {
            law.shape == Shape::Sine && !known.contains(&ArmEffect::GearRipple(law.joint))
        };
        let laws: Vec<Candidate> = laws
            .filter(|c| !c.law.as_ref().is_some_and(named))
            .collect();
        tried.extend(self.try_each(best, laws));
        tried.sort_by(|a, b| b.worth.total_cmp(&a.worth));
        let accepted = self.acceptable(&tried, before);
        (tried, accepted)
    }

    /// The first of those tried that is worth it, seen in the readings, and not more than a simpler one that says as much.
    fn acceptable(&self, tried: &[Tried], before: &[Stage]) -> Option<usize> {
        // One that is contained in another, or has a name where the other has none, is the answer where it says as much.
        let simple_enough = |of: &Tried| {
            let unnamed = |effect| matches!(effect, ArmEffect::Unlisted(_));
            let is_simpler = |other: ArmEffect| {
                of.effect.simpler() == Some(other)
                    || unnamed(of.effect) && !unnamed(other) && other.joint() == of.effect.joint()
            };
            // Both weighed alike: what the simpler one lacks of the other.
            let lacks = |other: &Tried| gain(&other.hypothesis.fit, &of.hypothesis.fit);
            let enough =
                |other: &Tried| is_simpler(other.effect) && lacks(other) < (1.0 - ENOUGH) * of.gain;
            !tried.iter().any(enough)
        };
        let most = |effect: ArmEffect| {
            let accepted = before.iter().filter_map(Stage::accepted);
            let alike = accepted.filter(|t| {
                t.effect.joint().is_none()
                    || effect.joint().is_none()
                    || t.effect.joint() == effect.joint()
            });
            alike.map(|t| t.gain).fold(0.0, f64::max)
        };
        tried.iter().position(|tried| {
            tried.worth > WORTH.max(REMAINDER * most(tried.effect))
                && simple_enough(tried)
                && !is_at_its_bound(&tried.hypothesis)
                && is_seen(self.evidence, &tried.hypothesis)
        })
    }

    /// A hypothesis without the effects that those found later have made needless.
    fn without_needless(&mut self, mut best: Hypothesis) -> Hypothesis {
        let mut place = 0;
        while best.effects.len() > 1 && place + 1 < best.effects.len() {
            let mut fewer = best.effects.clone();
            let dropped = fewer.remove(place);
            if dropped.push.is_some() || dropped.law.is_some() {
                place += 1;
                continue;
            }
            let without = best.without(self.evidence, place, &self.scales, &mut self.columns);
            if gain(&without.fit, &best.fit) - self.price(&dropped) < WORTH {
                best = self.settled(&without);
            } else {
                place += 1;
            }
        }
        best
    }

    /// What an effect must gain for its numbers.
    fn price(&self, candidate: &Candidate) -> f64 {
        let size = (self.evidence.count() as f64).ln();
        let unnamed = matches!(candidate.effect, ArmEffect::Unlisted(_));
        size * candidate.free.len() as f64 + if unnamed { UNNAMED } else { 0.0 }
    }
}

/// Whether a number of the last effect of a hypothesis ends where it may not go on, other than at zero: then it stands for something else.
fn is_at_its_bound(hypothesis: &Hypothesis) -> bool {
    let last = hypothesis.effects.iter().rev().take(1);
    let mut numbers = last.flat_map(|effect| &effect.free);
    numbers.any(|p| {
        let value = p.quantity.value(&hypothesis.fit.arm);
        let near = 1e-3 * (p.bounds[1] - p.bounds[0]);
        let at = |bound: f64| bound != 0.0 && (value - bound).abs() < near;
        matches!(
            p.quantity,
            Quantity::LinkMass(_) | Quantity::InverseGain(_) | Quantity::LoadFriction(_)
        ) && p.bounds.iter().any(|bound| at(*bound))
    })
}

/// Whether the last effect of a hypothesis moves some channel beyond its noise.
fn is_seen(evidence: &Evidence, hypothesis: &Hypothesis) -> bool {
    let last = &hypothesis.effects[hypothesis.effects.len() - 1..];
    largest(
        evidence,
        &changes(evidence.input, &hypothesis.fit.arm, last),
    ) > SEEN
}

impl Search<'_> {
    /// Candidates beside a hypothesis, the promising ones fitted, best first.
    fn try_each(&mut self, hypothesis: &Hypothesis, mut all: Vec<Candidate>) -> Vec<Tried> {
        let known = hypothesis.names();
        all.retain(|c| {
            matches!(c.effect, ArmEffect::Push(_) | ArmEffect::Unlisted(_))
                || !known.contains(&c.effect)
        });
        let (evidence, scales) = (self.evidence, self.scales.clone());
        let promised = screen(evidence, hypothesis, &all, &scales, &mut self.columns);
        let worth = |i: usize| promised[i] - self.price(&all[i]);
        // The best way of each effect.
        let mut ways: BTreeMap<ArmEffect, usize> = BTreeMap::new();
        for (i, candidate) in all.iter().enumerate() {
            let way = ways.entry(candidate.effect).or_insert(i);
            if worth(i) > worth(*way) {
                *way = i;
            }
        }
        let mut order: Vec<usize> = ways.values().copied().collect();
        order.sort_by(|a, b| worth(*b).total_cmp(&worth(*a)));
        order.truncate(FITTED);
        let mut promising: Vec<usize> = order
            .iter()
            .enumerate()
            .filter(|(place, i)| *place < 2 || worth(**i) > 0.0)
            .map(|(_, i)| *i)
            .collect();
        // What another contains is held against it, whatever it promised.
        for i in promising.clone() {
            let contained = all[i].effect.simpler().and_then(|effect| ways.get(&effect));
            if let Some(contained) = contained.filter(|contained| !promising.contains(contained)) {
                promising.push(*contained);
            }
        }
        let fitted = |i: usize| {
            let mut columns = self.columns.clone();
            let found = hypothesis.with(evidence, &all[i], &scales, &mut columns);
            let gain = gain(&hypothesis.fit, &found.fit);
            Tried {
                effect: all[i].effect,
                gain,
                worth: gain - self.price(&all[i]),
                hypothesis: found,
            }
        };
        let mut tried: Vec<Tried> = promising.into_par_iter().map(fitted).collect();
        tried.sort_by(|a, b| b.worth.total_cmp(&a.worth));
        tried
    }
}

/// Decrease of the cost from one fit to another, by what the other leaves: over its scales, and where that goes on from sample to sample counted as often as it
/// is new.
fn gain(before: &Fit, after: &Fit) -> f64 {
    let squares = |fit: &Fit| products(&fit.residuals, &fit.residuals);
    let (scales, alike) = (
        scales_of(&after.residuals),
        correlation_of(&after.residuals),
    );
    let weights: Vec<f64> = (scales.iter().zip(&alike))
        .map(|(s, t)| s * t.sqrt())
        .collect();
    weighed(&squares(before), &weights) - weighed(&squares(after), &weights) + before.prior_cost()
        - after.prior_cost()
}
