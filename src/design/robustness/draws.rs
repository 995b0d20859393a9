//! The draws at a design, and what they do.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::{
    Draw, DrawnVariable, KeptShare, LimitShare, QUANTILES, Quantiles, Robustness, Scattering,
};
use crate::design::candidate::{Evaluate, EvaluateError, Outcome};
use crate::design::limits::Limit;
use crate::design::result::Candidate;
use crate::design::study::Study;
use crate::stats::quantiles;
use crate::vary::LatinHypercube;

/// A draw that was simulated.
struct Simulated {
    values: Vec<f64>,
    result: Result<Outcome, EvaluateError>,
}

/// Draws at the chosen design; `done` gets how many are.
pub(in crate::design) fn draw(
    study: &Study,
    scattering: &Scattering,
    chosen: &Candidate,
    evaluator: &dyn Evaluate,
    done: &(dyn Fn(usize) + Sync),
) -> Robustness {
    let hypercube =
        LatinHypercube::new(scattering.runs, scattering.scatters.len(), scattering.seed);
    let count = AtomicUsize::new(0);
    let simulate = |run: usize| {
        let pairs = scattering.scatters.iter().zip(hypercube.shares(run));
        let values: Vec<f64> = pairs
            .map(|(scatter, share)| scatter.at_share(share))
            .collect();
        let keys = scattering
            .scatters
            .iter()
            .map(|scatter| scatter.key.clone());
        let design = chosen.design.with(keys.zip(values.iter().copied()));
        let result = evaluator.evaluate(&design);
        done(count.fetch_add(1, Ordering::Relaxed) + 1);
        Simulated { values, result }
    };
    let simulated: Vec<Simulated> = (0..scattering.runs).into_par_iter().map(simulate).collect();
    summarise(study, scattering, chosen, &simulated)
}

/// What a result and quantiles are given of: the objective, then each limited metric once.
fn metrics(study: &Study) -> Vec<String> {
    let mut names = vec![study.objective.metric.clone()];
    for limit in &study.limits {
        if limit.key() != "force_n" && !names.iter().any(|name| name == limit.key()) {
            names.push(limit.key().to_owned());
        }
    }
    names
}

/// The value of a metric: of the objective as it is minimised, else the worst over the scenarios as its limits take it.
fn value(study: &Study, metric: &str, outcome: &Outcome) -> Option<f64> {
    if metric == study.objective.metric {
        return study.objective.value(outcome);
    }
    let limit = study.limits.iter().find(|limit| limit.key() == metric)?;
    limit.value(outcome).filter(|value| value.is_finite())
}

fn keeps(limit: &Limit, simulated: &Simulated) -> bool {
    let outcome = simulated.result.as_ref().ok();
    let value = outcome.and_then(|outcome| limit.value(outcome));
    value.is_some_and(|value| limit.excess(value) <= 0.0)
}

fn summarise(
    study: &Study,
    scattering: &Scattering,
    chosen: &Candidate,
    simulated: &[Simulated],
) -> Robustness {
    let runs = simulated.len();
    let metrics = metrics(study);
    let draws: Vec<Draw> = simulated
        .iter()
        .map(|draw| Draw {
            values: draw.values.clone(),
            metrics: metrics
                .iter()
                .map(|metric| value(study, metric, draw.result.as_ref().ok()?))
                .collect(),
            kept: draw.result.is_ok() && study.limits.iter().all(|limit| keeps(limit, draw)),
        })
        .collect();
    let mut failed: BTreeMap<String, usize> = BTreeMap::new();
    for error in simulated
        .iter()
        .filter_map(|draw| draw.result.as_ref().err())
    {
        *failed.entry(error.reason.clone()).or_default() += 1;
    }
    let limits = study.limits.iter().map(|limit| LimitShare {
        limit: limit.sentence(),
        share: KeptShare::of(
            simulated.iter().filter(|draw| keeps(limit, draw)).count(),
            runs,
        ),
    });
    let undrawn = Outcome {
        force_range: chosen.force_range,
        scenarios: chosen.scenarios.clone(),
    };
    let quantiles_of_metrics = metrics.iter().enumerate().filter_map(|(place, metric)| {
        let values: Vec<f64> = draws
            .iter()
            .filter_map(|draw| draw.metrics[place])
            .collect();
        let [percent_5, percent_50, percent_95] =
            quantiles(&values, &QUANTILES)?.try_into().ok()?;
        Some(Quantiles {
            metric: metric.clone(),
            chosen: value(study, metric, &undrawn)?,
            percent_5,
            percent_50,
            percent_95,
        })
    });
    Robustness {
        runs,
        seed: scattering.seed,
        variables: (scattering.scatters.iter())
            .map(|scatter| DrawnVariable {
                key: scatter.key.clone(),
                distribution: scatter.distribution,
            })
            .collect(),
        failed,
        all_limits: KeptShare::of(draws.iter().filter(|draw| draw.kept).count(), runs),
        limits: limits.collect(),
        quantiles: quantiles_of_metrics.collect(),
        draws,
    }
}
