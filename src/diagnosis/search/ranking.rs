//! Explanations in the order of their evidence.

use super::Search;
use crate::diagnosis::fit::cross_validation::{Depth, LeftOut, left_out};
use crate::diagnosis::fit::hypothesis::{Hypothesis, covers, is_equivalent};
use crate::diagnosis::fit::model_error::ModelError;

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
pub(in crate::diagnosis) fn rank(search: &Search<'_>, found: Vec<Hypothesis>) -> Vec<Ranked> {
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
    let hypotheses: Vec<&Hypothesis> = ranked[..near].iter().map(|r| &r.hypothesis).collect();
    let first = foremost(&hypotheses, &sums, limit);
    let chosen = ranked.remove(first);
    ranked.insert(0, chosen);
    let own: Vec<f64> = ranked.iter().map(|r| odds(search, &ranked[0], r)).collect();
    let sum: f64 = own.iter().sum();
    for (r, odds) in ranked.iter_mut().zip(own) {
        (r.odds, r.probability) = (odds, odds / sum);
    }
    ranked
}

/// Index of the explanation that is put first, of some in the order of their scores and their sums of squares of what was left out in turn: the first, or the one that
/// predicts better than it by more than `limit` [1].
fn foremost(hypotheses: &[&Hypothesis], sums: &[Option<f64>], limit: f64) -> usize {
    let (Some(&best), Some(&Some(first))) = (hypotheses.first(), sums.first()) else {
        return 0;
    };
    // One that has all effects of the first, or richer laws in their place, predicts a little better whether or not it is at work: the search has weighed what that costs.
    let is_richer = |other: &Hypothesis| !best.effects.is_empty() && covers(other, best);
    let others = hypotheses.iter().zip(sums).enumerate();
    let others = others.filter(|(_, (other, _))| !is_richer(other));
    let predicts = others.filter_map(|(i, (_, sum))| Some((i, (*sum)?)));
    let better = predicts.min_by(|a, b| a.1.total_cmp(&b.1));
    better.map_or(0, |(index, sum)| match first - sum > limit {
        true => index,
        false => 0,
    })
}

/// Odds of an explanation against the one that was put first. One that was put first for what it predicts is not held to be less likely than those behind it.
/// Where a plain law was put before a richer one, what that gains was found to be no more than idealisation leaves: its penalty stands.
fn odds(search: &Search<'_>, first: &Ranked, other: &Ranked) -> f64 {
    let (plain, richer) = (&first.hypothesis, &other.hypothesis);
    let passed_over = other.score < first.score
        && richer.fit.free.len() > plain.fit.free.len()
        && is_equivalent(plain, richer);
    let behind = match passed_over {
        true => search.penalty(richer) - search.penalty(plain),
        false => other.score - first.score,
    };
    (-0.5 * behind).exp().min(1.0)
}

#[cfg(test)]
mod tests {
    use super::super::ruled_out::variant;
    use super::*;
    use crate::diagnosis::fit::FINEST;
    use crate::diagnosis::test_evidence::{evidence_of, fit, plant, search};
    use crate::effects::every;

    /// A case with dry friction alone was said to be as likely one whose friction grows with the pressure, by 0.04 N of 25 N: that law had followed the
    /// errors of the other numbers and was passed over for it, yet stood beside the plain one at even odds.
    #[test]
    fn a_richer_law_that_was_passed_over_costs_its_numbers() {
        let mut truth = plant();
        let friction = |name: &str| every().find(|e| e.name == name).unwrap();
        let (plain, richer) = (
            friction("coulomb_viscous_friction"),
            friction("pressure_dependent_friction"),
        );
        truth.device.seal_friction.viscous = 40.0;
        let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
        let search = search(&evidence);
        let fitted = |effect| Hypothesis {
            effects: vec![effect],
            fit: variant(&search, &[effect], FINEST).unwrap(),
            depends_on: Vec::new(),
        };
        let (plain, mut richer) = (fitted(plain), fitted(richer));
        let count = evidence.count() as f64;
        let odds = |richer: &Hypothesis| {
            let ranked = rank(&search, vec![plain.clone(), richer.clone()]);
            assert_eq!(ranked[0].hypothesis.names(), plain.names());
            let sum: f64 = ranked.iter().map(|r| r.probability).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{sum}");
            ranked[1].odds
        };
        // One number more: Schwarz's penalty for it, whatever it gained.
        richer.fit.misfit = plain.fit.misfit - 200.0;
        assert!((odds(&richer) * count.sqrt() - 1.0).abs() < 1e-9);
        richer.fit.misfit = plain.fit.misfit - 400.0;
        assert!((odds(&richer) * count.sqrt() - 1.0).abs() < 1e-9);
        // One that scores no better is as likely as its score says.
        richer.fit.misfit = plain.fit.misfit + 4.0;
        richer.fit.prior = plain.fit.prior;
        let expected = (-0.5 * (4.0 + count.ln())).exp();
        assert!((odds(&richer) / expected - 1.0).abs() < 1e-9);
    }

    /// A late regulator and nothing else: beside the delay a restriction that was as good as none scored worse by its number, predicted better by chance, and was put first for
    /// it. Its 1 % was then a doubt of the whole explanation. Of laws that do not have all that the first has, one may be put first for what it predicts.
    #[test]
    fn an_effect_more_is_not_put_first_for_what_it_predicts() {
        let of = |names: &[&str]| Hypothesis {
            effects: names
                .iter()
                .map(|name| every().find(|e| e.name == *name).unwrap())
                .collect(),
            fit: fit(vec![0.0], vec![1.0], 0.0),
            depends_on: Vec::new(),
        };
        let first = |names: &[&[&str]], sums: &[f64]| {
            let hypotheses: Vec<Hypothesis> = names.iter().map(|names| of(names)).collect();
            let sums: Vec<Option<f64>> = sums.iter().copied().map(Some).collect();
            foremost(&hypotheses.iter().collect::<Vec<_>>(), &sums, 9.0)
        };
        let delay: &[&str] = &["transport_delay"];
        let both: &[&str] = &["transport_delay", "exhaust_restriction"];
        let lag: &[&str] = &["regulator_second_order"];
        assert_eq!(first(&[delay, both], &[100.0, 50.0]), 0);
        assert_eq!(first(&[delay, both, lag], &[100.0, 50.0, 80.0]), 2);
        assert_eq!(first(&[delay, both, lag], &[100.0, 50.0, 95.0]), 0);
        assert_eq!(first(&[both, delay], &[100.0, 50.0]), 1);
        assert_eq!(first(&[&[], delay], &[100.0, 50.0]), 1);
    }
}
