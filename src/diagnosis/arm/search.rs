//! The search: effects one after the other, each the one that gains most for its numbers, until none gains more than chance would.
//!
//! ```text
//! worth = (decrease of the cost) - k ln N
//! ```
//!
//! k numbers that it frees, N rows of the channels (Schwarz 1978, Annals of Statistics 6, 461).

use std::collections::BTreeMap;

use super::effect::{ArmEffect, Candidate, candidates};
use super::evidence::Evidence;
use super::extent::{changes, largest};
use super::fit::{Columns, Scales, scales_of};
use super::hypothesis::{Hypothesis, screen};
use super::laws::laws;
use super::pushed::pushes;

/// Worth from which an effect is taken in [1].
const WORTH: f64 = 16.0;
/// What a law without a name must gain beyond one that has one, since it is one of thousands [1].
const UNNAMED: f64 = 35.0;
/// Share of the first effect's gain below which a further one may be what its textbook form leaves [1].
const REMAINDER: f64 = 0.01;
/// Standard deviations of the noise by which an effect must move a channel somewhere [1].
const SEEN: f64 = 2.0;
/// Candidates that are fitted wholly at a stage.
const FITTED: usize = 7;
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
    /// What was tried at each stage, best first.
    pub stages: Vec<Vec<Tried>>,
}

/// Searches for what is missing.
#[must_use]
pub fn search(evidence: &Evidence, observer: &mut dyn FnMut(usize)) -> Found {
    let mut columns = Columns::default();
    let mut scales = vec![1.0; evidence.rows.len()];
    let mut nominal = Hypothesis::nominal(evidence, &scales, &mut columns);
    for _ in 0..2 {
        scales = scales_of(&nominal.fit.residuals);
        nominal = Hypothesis::nominal(evidence, &scales, &mut columns);
    }
    let listed = candidates(evidence.input);
    let mut best = nominal.clone();
    let mut stages: Vec<Vec<Tried>> = Vec::new();
    let mut most: f64 = 0.0;
    for stage in 0..MOST {
        observer(stage);
        let tried = try_each(evidence, &best, &listed, &scales, &mut columns);
        let Some(first) = tried.first() else { break };
        let next = first.hypothesis.clone();
        let accepted = first.worth > WORTH.max(REMAINDER * most) && is_seen(evidence, &next);
        most = most.max(first.gain);
        stages.push(tried);
        if !accepted {
            break;
        }
        best = next;
        scales = scales_of(&best.fit.residuals);
        best = Hypothesis::of_same(evidence, &best, &scales, &mut columns);
    }
    Found {
        nominal,
        best,
        scales,
        stages,
    }
}

/// Whether the last effect of a hypothesis moves some channel beyond its noise.
fn is_seen(evidence: &Evidence, hypothesis: &Hypothesis) -> bool {
    let last = &hypothesis.effects[hypothesis.effects.len() - 1..];
    largest(
        evidence,
        &changes(evidence.input, &hypothesis.fit.arm, last),
    ) > SEEN
}

/// Candidates beside a hypothesis, the promising ones fitted, best first.
fn try_each(
    evidence: &Evidence,
    hypothesis: &Hypothesis,
    listed: &[Candidate],
    scales: &[f64],
    columns: &mut Columns,
) -> Vec<Tried> {
    let mut all: Vec<Candidate> = listed.to_vec();
    all.extend(pushes(evidence, &hypothesis.fit, scales));
    for joint in 0..evidence.input.nominal.joints() {
        all.extend(laws(evidence, &hypothesis.fit, joint));
    }
    let known = hypothesis.names();
    all.retain(|c| {
        matches!(c.effect, ArmEffect::Push(_) | ArmEffect::Unlisted(_))
            || !known.contains(&c.effect)
    });
    let promised = screen(evidence, hypothesis, &all, scales, columns);
    let size = (evidence.count() as f64).ln();
    let price = |candidate: &Candidate| {
        let unnamed = matches!(candidate.effect, ArmEffect::Unlisted(_));
        size * candidate.free.len() as f64 + if unnamed { UNNAMED } else { 0.0 }
    };
    let worth = |i: usize| promised[i] - price(&all[i]);
    // The best way of each effect.
    let mut ways: BTreeMap<ArmEffect, usize> = BTreeMap::new();
    for i in 0..all.len() {
        let way = ways.entry(all[i].effect).or_insert(i);
        if worth(i) > worth(*way) {
            *way = i;
        }
    }
    let mut order: Vec<usize> = ways.into_values().collect();
    order.sort_by(|a, b| worth(*b).total_cmp(&worth(*a)));
    let mut tried: Vec<Tried> = order
        .iter()
        .take(FITTED)
        .map(|i| {
            let found = hypothesis.with(evidence, &all[*i], scales, columns);
            let gain = hypothesis.fit.cost - found.fit.cost;
            Tried {
                effect: all[*i].effect,
                gain,
                worth: gain - price(&all[*i]),
                hypothesis: found,
            }
        })
        .collect();
    tried.sort_by(|a, b| b.worth.total_cmp(&a.worth));
    tried
}
