//! From a few good places to the best near them: COBYLA on each, then on the neighbouring catalogue choices of the best, as long as one of these
//! is better and there is budget.
//!
//! It looks only at what it evaluates itself, never at what the archive has meanwhile got from others, so that several of it can run side by side
//! and still give the same result each time.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::archive::{Archive, EvaluatedDesign};
use super::error::DesignError;
use super::goal::Goal;
use super::polish::{Ranked, polish};
use super::study::Study;

/// Places that are further apart than this share of the range along some axis count as different.
const APART: f64 = 0.15;
/// Radii of the last rounds, as shares of the first.
const SHRINK: [f64; 3] = [0.5, 0.2, 0.1];

/// Refines `starts` with at most `budget` designs; none if there are no starts.
pub(super) fn refine(
    archive: &Archive<'_>,
    goal: &Goal,
    starts: &[Vec<f64>],
    radius: f64,
    budget: usize,
) -> Result<Option<Ranked>, DesignError> {
    let study = archive.study();
    let catalogues = study.variables.iter().any(|v| v.domain.count().is_some());
    let mut left = budget;
    let share = if catalogues {
        budget / 2
    } else {
        2 * budget / 3
    };
    let mut best = best_of(archive, goal, starts, radius, share, &mut left)?;
    let mut seen: BTreeSet<Vec<usize>> = starts
        .iter()
        .map(|coordinates| choice(study, coordinates))
        .collect();
    while let Some(current) = best.clone() {
        let neighbours: Vec<Vec<f64>> = neighbours(study, &current.coordinates)
            .into_iter()
            .filter(|coordinates| seen.insert(choice(study, coordinates)))
            .collect();
        let share = 2 * left / 3;
        match best_of(archive, goal, &neighbours, radius, share, &mut left)? {
            Some(found) if found.rank < current.rank => best = Some(found),
            _ => break,
        }
    }
    // A new simplex, smaller each time, where the first has lost its shape.
    for shrink in SHRINK {
        let Some(current) = best.clone() else { break };
        let again = [current.coordinates];
        let share = left;
        match best_of(archive, goal, &again, shrink * radius, share, &mut left)? {
            Some(found) if found.rank < current.rank => best = Some(found),
            _ => break,
        }
    }
    Ok(best)
}

/// Polishes all of them in parallel with `share` designs, and takes what they use from `left`; of equals the first is the best.
fn best_of(
    archive: &Archive<'_>,
    goal: &Goal,
    starts: &[Vec<f64>],
    radius: f64,
    share: usize,
    left: &mut usize,
) -> Result<Option<Ranked>, DesignError> {
    let each = share / starts.len().max(1);
    if each == 0 {
        return Ok(None);
    }
    let polished: Vec<(Ranked, usize)> = starts
        .par_iter()
        .map(|coordinates| polish(archive, goal, coordinates, radius, each))
        .collect::<Result<_, _>>()?;
    let used: usize = polished.iter().map(|(_, used)| used).sum();
    *left = left.saturating_sub(used);
    let found = polished.into_iter().map(|(ranked, _)| ranked);
    Ok(found.reduce(|best, other| if other.rank < best.rank { other } else { best }))
}

/// Entries that a place stands for, one a catalogue.
fn choice(study: &Study, coordinates: &[f64]) -> Vec<usize> {
    let pairs = study.variables.iter().zip(coordinates);
    pairs
        .filter(|(variable, _)| variable.domain.count().is_some())
        .map(|(variable, coordinate)| variable.domain.index(*coordinate))
        .collect()
}

/// The place with one catalogue's entry replaced by the next smaller or larger one.
fn neighbours(study: &Study, coordinates: &[f64]) -> Vec<Vec<f64>> {
    let mut found = Vec::new();
    for (axis, variable) in study.variables.iter().enumerate() {
        let Some(count) = variable.domain.count() else {
            continue;
        };
        let index = variable.domain.index(coordinates[axis]);
        for next in [index.checked_sub(1), Some(index + 1)]
            .into_iter()
            .flatten()
        {
            if next < count {
                let mut neighbour = coordinates.to_vec();
                neighbour[axis] = super::Domain::place_of_entry(next, count);
                found.push(neighbour);
            }
        }
    }
    found
}

/// The best designs that differ in a catalogue's entry or lie apart, at most `count`.
pub(super) fn distinct_best(
    study: &Study,
    goal: &Goal,
    all: &[std::sync::Arc<EvaluatedDesign>],
    count: usize,
) -> Vec<Vec<f64>> {
    let mut ranked: Vec<(f64, &EvaluatedDesign)> = all
        .iter()
        .map(|evaluated| (goal.rank(evaluated), &**evaluated))
        .collect();
    // Stable: of equals the first by their values stays first.
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut chosen: Vec<Vec<f64>> = Vec::new();
    for (_, evaluated) in ranked {
        let coordinates = coordinates_of(study, evaluated);
        let apart = |other: &Vec<f64>| {
            choice(study, other) != choice(study, &coordinates)
                || other
                    .iter()
                    .zip(&coordinates)
                    .any(|(a, b)| (a - b).abs() > APART)
        };
        if chosen.iter().all(apart) {
            chosen.push(coordinates);
        }
        if chosen.len() == count {
            break;
        }
    }
    chosen
}

/// Places of a design.
pub(super) fn coordinates_of(study: &Study, evaluated: &EvaluatedDesign) -> Vec<f64> {
    let pairs = study.variables.iter().zip(&evaluated.values);
    pairs
        .map(|(variable, value)| variable.domain.coordinate(*value))
        .collect()
}
