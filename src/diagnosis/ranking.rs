//! Explanations in the order of their evidence.

use super::cross_validation::{Depth, LeftOut, left_out};
use super::hypothesis::{Hypothesis, stands_for};
use super::model_error::ModelError;
use super::search::Search;

/// An explanation among others.
#[derive(Debug, Clone)]
pub struct Ranked {
    /// The explanation.
    pub hypothesis: Hypothesis,
    /// Its cost, penalty included [1].
    pub score: f64,
    /// Its odds against the best one [1].
    pub odds: f64,
    /// Its probability among those looked at in full [1].
    pub probability: f64,
    /// Each recording as predicted by a fit to the others; none where there are no others.
    pub left_out: Option<LeftOut>,
}

impl Ranked {
    /// Robust sum of squares of what was left out in turn.
    fn left_out_sum(&self, model_error: &ModelError) -> Option<f64> {
        Some(self.left_out.as_ref()?.sum(model_error))
    }
}

/// Explanations by evidence, unless what was left out in turn speaks as clearly for another as evidence would have to.
pub(super) fn rank(search: &Search<'_>, found: Vec<Hypothesis>) -> Vec<Ranked> {
    let mut ranked: Vec<Ranked> = found
        .into_iter()
        .map(|hypothesis| Ranked {
            score: search.score(&hypothesis),
            odds: 1.0,
            probability: 1.0,
            left_out: None,
            hypothesis,
        })
        .collect();
    let limit = -2.0 * search.settings.least_odds.ln();
    let close = ranked[0].score + limit;
    let near = ranked.iter().take_while(|r| r.score <= close).count();
    for leading in &mut ranked[..near] {
        let fit = &leading.hypothesis.fit;
        leading.left_out = left_out(search.evidence, fit, Depth::OneStep);
    }
    let sums: Vec<Option<f64>> = (ranked[..near].iter())
        .map(|r| r.left_out_sum(&search.model_error))
        .collect();
    if let Some(first) = sums[0] {
        let others = sums.iter().enumerate().skip(1);
        // A richer law in place of a plain one predicts a little better whether or not it is at work: the search has weighed them.
        let others =
            others.filter(|(i, _)| !stands_for(&ranked[*i].hypothesis, &ranked[0].hypothesis));
        let predicts = others.filter_map(|(i, sum)| Some((i, (*sum)?)));
        let better = predicts.min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, sum)) = better
            && first - sum > limit
        {
            let chosen = ranked.remove(index);
            ranked.insert(0, chosen);
        }
    }
    let best = ranked[0].score;
    // One that was put first for what it predicts is not held to be less likely than those behind it.
    let odds = |score: f64| (-0.5 * (score - best)).exp().min(1.0);
    let sum: f64 = ranked.iter().map(|r| odds(r.score)).sum();
    for r in &mut ranked {
        r.odds = odds(r.score);
        r.probability = r.odds / sum;
    }
    ranked
}
