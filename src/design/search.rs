//! The search from the starting design to the result.
//!
//! 1. Differential evolution over all variables, feasibility first; the starting design is among the first.
//! 2. COBYLA from the best few designs that differ, then on neighbouring catalogue choices.
//! 3. The same for the second objective alone: the other end of the front.
//! 4. Between the ends, level by level: the objective under a ceiling on the second one (epsilon-constraint; Y. Y. Haimes et al., IEEE Trans. Syst.
//!    Man Cybern. 1, 1971), from the best known design below it. It finds the parts of a front that are not convex as well.
//! 5. What binds the chosen design.
//!
//! Every design that was ever evaluated can become the chosen one or a point of the front.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;

use super::archive::{Archive, Judged, Scored};
use super::candidate::Evaluate;
use super::error::DesignError;
use super::evolve::evolve;
use super::front::{non_dominated, thinned};
use super::goal::{Aim, Goal};
use super::label::with_unit;
use super::refine::{distinct_best, refine};
use super::result::{Candidate, FrontPoint, LimitState, ObjectiveNames, StudyResult};
use super::sensitivity::{ACTIVE, active_bounds, active_limits, sensitivities};
use super::study::{Over, Study, TradeOff};
use super::variable::Domain;

/// Shares of the budget: evolution and refinement of the objective, of the second one, all levels, what binds.
const WITH_FRONT: [f64; 5] = [0.35, 0.15, 0.1, 0.08, 0.24];
const WITHOUT_FRONT: [f64; 5] = [0.6, 0.3, 0.0, 0.0, 0.0];
/// Designs from which the refinement starts.
const STARTS: usize = 3;
/// First steps of the refinement, as shares of a variable's range: after evolution, and from one level to the next.
const RADII: [f64; 2] = [0.1, 0.05];
/// Points of the front differ by more than this share of its extent.
const FRONT_RESOLUTION: f64 = 0.004;
/// Version of the result's format.
const SCHEMA: u32 = 1;

/// Does the study. The progress is told the number of designs evaluated so far and the budget, from any thread.
///
/// # Errors
/// The starting design cannot be simulated, a metric is unknown, or no design keeps the limits.
pub fn run(
    study: &Study,
    evaluator: &dyn Evaluate,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<StudyResult, DesignError> {
    let archive = Archive::new(study, evaluator, progress);
    let start = start(&archive)?;
    let scale = |value: f64| if value == 0.0 { 1.0 } else { value.abs() };
    let goal = Goal {
        aim: Aim::Objective,
        ceiling: None,
        slack: vec![0.0; study.limits.len()],
        scales: [scale(start.1.objective), scale(start.1.trade_off)],
    };
    let shares = match study.trade_off {
        Some(_) => WITH_FRONT,
        None => WITHOUT_FRONT,
    };
    let budgets = shares.map(|share| (share * study.evaluations as f64) as usize);
    hunt(&archive, &goal, [budgets[0], budgets[1]], study.seed)?;
    let best = best(&archive, &goal)?;
    if study.trade_off.is_some() {
        let other = Goal {
            aim: Aim::TradeOff,
            ..goal.clone()
        };
        hunt(&archive, &other, [budgets[2], budgets[3]], study.seed.wrapping_add(1))?;
        levels(&archive, &goal, &other, best.1.trade_off, budgets[4])?;
    }
    finish(&archive, &goal, &start, study.evaluations - budgets.iter().sum::<usize>())
}

/// A design that could be simulated.
type Good = (Arc<Judged>, Scored);

fn good(judged: &Arc<Judged>) -> Option<Good> {
    let scored = judged.result.as_ref().ok()?;
    Some((judged.clone(), scored.clone()))
}

/// The starting design, after a check that every metric of the file is one.
fn start(archive: &Archive<'_>) -> Result<Good, DesignError> {
    let study = archive.study();
    let judged = archive.at(&study.start());
    if let Some(good) = good(&judged) {
        return Ok(good);
    }
    let failed = |detail: String| DesignError::Start {
        file: study.path.clone(),
        detail,
    };
    // Which metrics there are is only known from an outcome.
    let outcome = archive.outcome(&judged.values);
    let outcome = outcome.map_err(|error| failed(error.detail))?;
    let metrics = outcome.scenarios.iter().flat_map(|scenario| scenario.metrics.keys());
    let known: BTreeSet<&String> = metrics.collect();
    let unknown = study.places.iter().find(|(_, metric, _)| !known.contains(metric));
    match (unknown, &judged.result) {
        (Some((key, metric, place)), _) => Err(DesignError::UnknownMetric {
            place: place.clone(),
            key: key.clone(),
            metric: metric.clone(),
            known: known.into_iter().cloned().collect::<Vec<_>>().join(", "),
        }),
        (None, Err(error)) => Err(failed(error.detail.clone())),
        (None, Ok(_)) => Err(failed("it gives another outcome each time".to_owned())),
    }
}

/// Evolution, then refinement of the best.
fn hunt(archive: &Archive<'_>, goal: &Goal, budgets: [usize; 2], seed: u64) -> Result<(), DesignError> {
    let study = archive.study();
    // What is known already seeds the first generation by half at most.
    let known = distinct_best(study, goal, &archive.all(), 5);
    evolve(archive, goal, &known, budgets[0], seed)?;
    let starts = distinct_best(study, goal, &archive.all(), STARTS);
    refine(archive, goal, &starts, RADII[0], budgets[1])?;
    Ok(())
}

/// The best design so far, or why there is none.
fn best(archive: &Archive<'_>, goal: &Goal) -> Result<Good, DesignError> {
    let all = archive.all();
    let best = all
        .iter()
        .map(|judged| (goal.rank(judged), judged))
        .reduce(|best, other| if other.0 < best.0 { other } else { best });
    match best {
        Some((rank, judged)) if Goal::keeps(rank) => good(judged).ok_or_else(|| only_failures(&all)),
        Some((_, judged)) => Err(match &judged.result {
            Ok(scored) => no_design(archive.study(), scored, all.len()),
            Err(_) => only_failures(&all),
        }),
        None => Err(only_failures(&all)),
    }
}

fn no_design(study: &Study, scored: &Scored, designs: usize) -> DesignError {
    let worst = (0..study.limits.len()).max_by(|a, b| scored.excess[*a].total_cmp(&scored.excess[*b]));
    let (limit, value) = match worst.map(|index| &study.limits[index]) {
        Some(limit) => (Some(limit), limit.value(&scored.outcome).unwrap_or(f64::NAN)),
        None => (None, f64::NAN),
    };
    let show = |value| limit.map_or_else(String::new, |limit| with_unit(limit.key(), value));
    DesignError::NoDesign {
        designs,
        limit: limit.map_or_else(String::new, super::Limit::sentence),
        excess: limit.map_or_else(String::new, |limit| show(limit.excess(value))),
        value: show(value),
    }
}

fn only_failures(all: &[Arc<Judged>]) -> DesignError {
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    for error in all.iter().filter_map(|judged| judged.result.as_ref().err()) {
        *reasons.entry(&error.reason).or_default() += 1;
    }
    let most = reasons.iter().max_by_key(|(_, count)| **count);
    DesignError::OnlyFailures {
        designs: all.len(),
        count: reasons.values().sum(),
        reason: most.map_or_else(String::new, |(reason, _)| (*reason).to_owned()),
    }
}

/// The front between its ends: the least objective under each of some ceilings.
fn levels(
    archive: &Archive<'_>,
    goal: &Goal,
    other: &Goal,
    highest: f64,
    budget: usize,
) -> Result<(), DesignError> {
    let study = archive.study();
    let lowest = best(archive, other)?.1.trade_off;
    let ceilings = ceilings(study, lowest, highest);
    let all = archive.all();
    let each = budget / ceilings.len().max(1);
    let tasks: Vec<(Goal, Vec<Vec<f64>>)> = ceilings
        .into_iter()
        .map(|ceiling| {
            let goal = Goal {
                ceiling: Some(ceiling),
                ..goal.clone()
            };
            let starts = distinct_best(study, &goal, &all, 1);
            (goal, starts)
        })
        .collect();
    tasks
        .par_iter()
        .try_for_each(|(goal, starts)| refine(archive, goal, starts, RADII[1], each).map(drop))
}

/// Levels of the second objective, both ends included: the lowest end is refined once more for the objective. Every entry, if it is a catalogue.
fn ceilings(study: &Study, lowest: f64, highest: f64) -> Vec<f64> {
    if lowest >= highest {
        return Vec::new();
    }
    if let Some(TradeOff::Variable(index)) = study.trade_off
        && let Domain::Catalogue(entries) = &study.variables[index].domain
    {
        let values = entries.iter().map(|entry| entry.value);
        return values.filter(|value| (lowest..=highest).contains(value)).collect();
    }
    let last = study.front_points - 1;
    (0..last)
        .map(|level| lowest + (highest - lowest) * level as f64 / last as f64)
        .collect()
}

fn finish(archive: &Archive<'_>, goal: &Goal, start: &Good, budget: usize) -> Result<StudyResult, DesignError> {
    let study = archive.study();
    let (chosen, score) = best(archive, goal)?;
    // What these try is apart from the search: it may lie outside bounds and limits, and it is not there to be chosen.
    let aside = archive.aside();
    let steps = 2 * study.variables.len() + 1;
    let active_limits = active_limits(&aside, goal, &chosen, &score, budget.saturating_sub(steps))?;
    let sensitivities = sensitivities(&aside, &chosen, &score);
    let all = archive.all();
    let feasible: Vec<Good> = all.iter().filter_map(good).filter(|(_, s)| s.feasible()).collect();
    let points: Vec<[f64; 2]> = feasible.iter().map(|(_, s)| [s.trade_off, s.objective]).collect();
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
        others: points,
    })
}

fn names(study: &Study) -> ObjectiveNames {
    let word = |over: Over| match over {
        Over::Mean => "mean",
        Over::Worst => "worst",
    };
    let over = match &study.trade_off {
        Some(TradeOff::Metric(metric)) => Some(word(metric.over)),
        _ => None,
    };
    ObjectiveNames {
        minimised: study.objective.metric.clone(),
        minimised_over: word(study.objective.over),
        trade_off: study.trade_off_key().map(str::to_owned),
        trade_off_over: over,
        scenarios: study.scenarios.len(),
    }
}

fn infeasible(study: &Study, all: &[Arc<Judged>]) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for judged in all {
        let reason = match &judged.result {
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

fn candidate(study: &Study, (judged, scored): &Good) -> Candidate {
    let pairs = study.limits.iter().zip(&scored.excess);
    let limits = pairs.map(|(limit, excess)| LimitState {
        limit: limit.sentence(),
        key: limit.key().to_owned(),
        bound: limit.bound,
        value: limit.value(&scored.outcome).unwrap_or(f64::NAN),
        kept: *excess <= 0.0,
        active: (-ACTIVE..=0.0).contains(excess),
    });
    Candidate {
        design: study.design(&judged.values),
        objective: scored.objective,
        trade_off: study.trade_off.as_ref().map(|_| scored.trade_off),
        feasible: scored.feasible(),
        limits: limits.collect(),
        force_range: scored.outcome.force_range,
        scenarios: scored.outcome.scenarios.clone(),
    }
}
