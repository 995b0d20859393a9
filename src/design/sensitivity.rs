//! Bounds of the chosen design, and its gain from more room.
//!
//! One-sided finite differences: each variable alone a tenth up and down, or to the next entry of its catalogue, also where that is beyond the
//! study's bounds. For an active limit the multiplier as a finite difference: the limit is loosened by a tenth (one of nothing by a fixed step), and the continuous variables are
//! chosen anew.

use rayon::prelude::*;

use super::archive::{Archive, EvaluatedDesign, Scored};
use super::error::DesignError;
use super::goal::Goal;
use super::limits::Side;
use super::polish::polish;
use super::refine::coordinates_of;
use super::result::{ActiveBound, ActiveLimit, Sensitivity};
use super::study::Study;
use super::variable::{Domain, Variable, rounded};

/// A bound or limit is active within this share of the range or of the limit's bound.
pub(super) const ACTIVE: f64 = 0.005;
/// Step of a variable, and loosening of a limit, as a share.
const STEP: f64 = 0.1;
/// First step of the search under a loosened limit, as a share of a variable's range.
const RADIUS: f64 = 0.05;

/// One row for each variable and direction that there is.
pub(super) fn sensitivities(
    archive: &Archive<'_>,
    chosen: &EvaluatedDesign,
    score: &Scored,
) -> Vec<Sensitivity> {
    let study = archive.study();
    let steps: Vec<(usize, f64)> = study
        .variables
        .iter()
        .enumerate()
        .flat_map(|(index, variable)| {
            let value = chosen.values[index];
            [false, true]
                .into_iter()
                .filter_map(move |larger| next(variable, value, larger))
                .map(move |next| (index, next))
        })
        .collect();
    steps
        .into_par_iter()
        .map(|(index, value)| sensitivity(archive, chosen, score, index, value))
        .collect()
}

/// The value a step away.
fn next(variable: &Variable, value: f64, larger: bool) -> Option<f64> {
    let [min, max] = variable.domain.ends();
    if let Domain::Catalogue(entries) = &variable.domain {
        let mut values = entries.iter().map(|entry| entry.value);
        let inside = if larger {
            values.find(|other| *other > value)
        } else {
            values.rfind(|other| *other < value)
        };
        return inside.or_else(|| variable.beyond(value, larger));
    }
    let size = if value == 0.0 {
        STEP * (max - min)
    } else {
        STEP * value.abs()
    };
    Some(rounded(if larger { value + size } else { value - size }))
}

fn sensitivity(
    archive: &Archive<'_>,
    chosen: &EvaluatedDesign,
    score: &Scored,
    index: usize,
    value: f64,
) -> Sensitivity {
    let study = archive.study();
    let variable = &study.variables[index];
    let mut values = chosen.values.clone();
    let before = values[index];
    values[index] = value;
    let [min, max] = variable.domain.ends();
    let evaluated = archive.evaluate(values);
    let broken = |scored: &Scored| {
        let pairs = study.limits.iter().zip(&scored.excess);
        let broken = pairs.filter(|(_, excess)| **excess > 0.0);
        broken.map(|(limit, _)| limit.key().to_owned()).collect()
    };
    let scored = evaluated.result.as_ref();
    Sensitivity {
        variable: variable.key.clone(),
        value,
        change_percent: relative(before, value),
        objective_change_percent: scored.ok().map(|s| relative(score.objective, s.objective)),
        beyond_bound: !(min..=max).contains(&value),
        breaks: scored.map(broken).unwrap_or_default(),
        failure: scored.err().map(|error| error.detail.clone()),
    }
}

/// Change [%]; of something that was zero, 100 % up or down.
fn relative(before: f64, after: f64) -> f64 {
    if after == before {
        0.0
    } else if before == 0.0 {
        100.0 * after.signum()
    } else {
        100.0 * (after - before) / before.abs()
    }
}

/// Variables on a bound.
pub(super) fn active_bounds(
    study: &Study,
    chosen: &EvaluatedDesign,
    steps: &[Sensitivity],
) -> Vec<ActiveBound> {
    let mut found = Vec::new();
    for (variable, value) in study.variables.iter().zip(&chosen.values) {
        let [min, max] = variable.domain.ends();
        if min == max {
            continue;
        }
        // By its place, so that a logarithmic scale counts as what it is; an entry of a catalogue is the end or is not.
        let coordinate = variable.domain.coordinate(*value);
        let ends = match variable.domain {
            Domain::Catalogue(_) => [*value == min, *value == max],
            _ => [coordinate <= ACTIVE, coordinate >= 1.0 - ACTIVE],
        };
        for (side, bound, at_end, beyond) in [
            (Side::Min, min, ends[0], -1.0),
            (Side::Max, max, ends[1], 1.0),
        ] {
            let step = steps.iter().find(|step| {
                step.variable == variable.key
                    && step.beyond_bound
                    && (step.value - bound) * beyond > 0.0
            });
            if at_end {
                found.push(ActiveBound {
                    variable: variable.key.clone(),
                    side,
                    bound,
                    objective_change_percent: step.and_then(|step| step.objective_change_percent),
                });
            }
        }
    }
    found
}

/// Limits that the chosen design just keeps, each loosened in turn with a share of `budget`.
pub(super) fn active_limits(
    archive: &Archive<'_>,
    goal: &Goal,
    chosen: &EvaluatedDesign,
    score: &Scored,
    budget: usize,
) -> Result<Vec<ActiveLimit>, DesignError> {
    let study = archive.study();
    let active: Vec<usize> = (0..study.limits.len())
        .filter(|index| score.excess[*index] >= -ACTIVE)
        .collect();
    let coordinates = coordinates_of(study, chosen);
    let each = budget / active.len().max(1);
    active
        .into_par_iter()
        .map(|index| {
            let mut looser = goal.clone();
            let limit = &study.limits[index];
            let step = STEP * limit.slack();
            looser.slack[index] = step / limit.scale();
            let (found, _) = polish(archive, &looser, &coordinates, RADIUS, each)?;
            let change = match &archive.at(&found.coordinates).result {
                Ok(better) if Goal::keeps(found.rank) => {
                    Some(relative(score.objective, better.objective))
                }
                _ => None,
            };
            Ok(ActiveLimit {
                limit: limit.sentence(),
                loosened_to: limit.loosened(step),
                unit: limit.unit().to_owned(),
                objective_change_percent: change,
            })
        })
        .collect()
}
