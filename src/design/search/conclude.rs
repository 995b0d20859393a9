//! From all that was evaluated to the result.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::design::archive::{Archive, EvaluatedDesign, Good};
use crate::design::error::DesignError;
use crate::design::front::{non_dominated, thinned};
use crate::design::goal::Goal;
use crate::design::result::{Candidate, FrontPoint, LimitState, ObjectiveNames, StudyResult};
use crate::design::sensitivity::{ACTIVE, active_bounds, active_limits, sensitivities};
use crate::design::study::{Over, Study, TradeOff};

/// Points of the front differ by more than this share of its extent.
const FRONT_RESOLUTION: f64 = 0.004;
/// Version of the result's format.
const SCHEMA: u32 = 1;

/// The result from all that was evaluated, after a last look at what binds.
pub(super) fn conclude(
    archive: &Archive<'_>,
    goal: &Goal,
    start: &Good,
    (chosen, score): Good,
    budget: usize,
) -> Result<StudyResult, DesignError> {
    let study = archive.study();
    // What these try is apart from the search: it may lie outside bounds and limits, and it is not there to be chosen.
    let aside = archive.aside();
    aside.begin(study.evaluations - budget, study.evaluations);
    let steps = 2 * study.variables.len() + 1;
    let active_limits = active_limits(&aside, goal, &chosen, &score, budget.saturating_sub(steps))?;
    let sensitivities = sensitivities(&aside, &chosen, &score);
    let all = archive.all();
    let feasible = archive.feasible();
    let points: Vec<[f64; 2]> = feasible
        .iter()
        .map(|(_, s)| [s.trade_off, s.objective])
        .collect();
    let front = match study.trade_off {
        Some(_) => thinned(&points, &non_dominated(&points), FRONT_RESOLUTION),
        None => Vec::new(),
    };
    let front_point = |index: &usize| FrontPoint {
        trade_off: points[*index][0],
        objective: points[*index][1],
        design: study.design(&feasible[*index].0.values),
    };
    Ok(StudyResult {
        schema: SCHEMA,
        title: study.title.clone(),
        objectives: names(study),
        seed: study.seed,
        evaluations: all.len() + aside.all().len() + sensitivities.len(),
        infeasible: infeasible(study, &all),
        start: candidate(study, start),
        front: front.iter().map(front_point).collect(),
        active_bounds: active_bounds(study, &chosen, &sensitivities),
        active_limits,
        chosen: candidate(study, &(chosen, score)),
        sensitivities,
        robustness: None,
        others: points,
    })
}

fn names(study: &Study) -> ObjectiveNames {
    let word = |over: Over| match over {
        Over::Mean => "mean",
        Over::Worst => "worst",
    };
    let over = match &study.trade_off {
        Some(TradeOff::Metric(metric)) => Some(word(metric.over).into()),
        _ => None,
    };
    ObjectiveNames {
        minimised: study.objective.metric.clone(),
        minimised_over: word(study.objective.over).into(),
        trade_off: study.trade_off_key().map(str::to_owned),
        trade_off_over: over,
        scenarios: study.scenarios.len(),
    }
}

fn infeasible(study: &Study, all: &[Arc<EvaluatedDesign>]) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for evaluated in all {
        let reason = match &evaluated.result {
            Err(error) => error.reason.clone(),
            Ok(scored) if scored.feasible() => continue,
            Ok(scored) => {
                let most = (0..study.limits.len())
                    .max_by(|a, b| scored.excess[*a].total_cmp(&scored.excess[*b]));
                most.map_or_else(String::new, |index| study.limits[index].sentence())
            }
        };
        *counts.entry(reason).or_default() += 1;
    }
    counts
}

fn candidate(study: &Study, (evaluated, scored): &Good) -> Candidate {
    let pairs = study.limits.iter().zip(&scored.excess);
    let limits = pairs.map(|(limit, excess)| LimitState {
        limit: limit.sentence(),
        key: limit.key().to_owned(),
        side: limit.side,
        bound: limit.bound,
        value: limit.value(&scored.outcome).unwrap_or(f64::NAN),
        kept: *excess <= 0.0,
        active: (-ACTIVE..=0.0).contains(excess),
    });
    Candidate {
        design: study.design(&evaluated.values),
        objective: scored.objective,
        trade_off: study.trade_off.as_ref().map(|_| scored.trade_off),
        feasible: scored.feasible(),
        limits: limits.collect(),
        force_range: scored.outcome.force_range,
        scenarios: scored.outcome.scenarios.clone(),
    }
}
