//! Prediction by a term of recordings that it was not fitted to, the piston held to its measured motion.
//!
//! Fitted anew to the others, not stepped there: a force over the stroke works like a spring, and one step of Gauss and Newton goes astray.

use super::super::evidence::Evidence;
use super::super::fit::{Effort, Fit, ROUGH, fit, robust_sum};

/// Iterations of a fit to the others, from where the fit to all is.
const ITERATIONS: usize = 5;
/// Longest step in a coordinate, as in the fit of a term [1].
const LONGEST: f64 = 30.0;

/// Each recording, and the others.
#[derive(Debug)]
pub struct Elsewhere {
    turns: Vec<(Evidence, Evidence)>,
}

impl Elsewhere {
    /// Of recordings; nothing where one stands alone.
    #[must_use]
    pub fn of(evidence: &Evidence) -> Option<Self> {
        let count = evidence.recordings.len();
        let turn = |left: usize| {
            let kept = |i: usize| evidence.recordings[i].clone();
            let others = (0..count).filter(|i| *i != left).map(kept).collect();
            (
                Evidence::new(vec![kept(left)], evidence.noise),
                Evidence::new(others, evidence.noise),
            )
        };
        (count > 1).then(|| Self {
            turns: (0..count).map(turn).collect(),
        })
    }

    /// Cost of each recording as predicted by a rough fit to the others [1].
    #[must_use]
    pub fn cost(&self, whole: &Fit) -> f64 {
        let free = whole.free_from_here();
        let effort = Effort {
            iterations: ITERATIONS,
            stages: ROUGH,
            frozen: &[],
            longest_step: LONGEST,
        };
        let turns = self.turns.iter().map(|(own, others)| {
            let plant = &whole.prediction.plant;
            let plant = fit(others, plant, &free, effort, None).prediction.plant;
            let shares = own.shares(ROUGH[0].forgiven, ROUGH[0].guided);
            let left = own.predict(&plant, ROUGH[0].guided, None).residuals;
            let counted = left.iter().zip(shares.iter()).map(|(r, share)| r * share);
            robust_sum(&counted.collect::<Vec<f64>>())
        });
        turns.sum()
    }
}
