//! Joint positions that put the tip at a wanted pose, within the joint limits.
//!
//! Damped Gauss-Newton steps `dq = z + J^T (J J^T + lambda I)^-1 (e - J z)`: the damping follows the squared
//! error (Sugihara, Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method, IEEE
//! Trans. Robotics 27(5), 2011), so the last steps are plain Newton steps, and `z` pulls spare degrees of
//! freedom towards mid range. Joints that a step would drive over a limit are held there and the step is
//! solved again with the others. A start that does not lead there is followed by seeded random ones.

mod descent;
mod limits;
mod problem;

#[cfg(test)]
mod tests;

pub use problem::{IkFailure, IkOptions, IkSolution, LimitingAxis, TipOrientation};

use crate::arm::chain::KinematicChain;
use descent::Search;
use glamx::DPose3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Finds joint positions that put the tip at `world_from_tip`, starting from `start`.
///
/// With a start near the answer the answer is the one near the start. The result depends on the arguments
/// alone.
///
/// # Errors
/// No posture was found; `world_from_tip` or `start` is not finite.
pub fn solve(
    chain: &KinematicChain,
    world_from_base: DPose3,
    world_from_tip: &DPose3,
    start: &[f64],
    options: &IkOptions,
) -> Result<IkSolution, IkFailure> {
    let search = Search::new(chain, world_from_base, world_from_tip, options, true);
    let mut best = search.descend(search.given_start(start));
    let mut iterations = best.iterations;
    if best.reached {
        return Ok(best.solution(chain.len(), iterations, 0));
    }
    let mut random = ChaCha8Rng::seed_from_u64(options.seed);
    for used in 1..=options.random_starts {
        let found = search.descend(search.random_start(&mut random));
        iterations += found.iterations;
        if found.reached {
            return Ok(found.solution(chain.len(), iterations, used));
        }
        if found.cost < best.cost {
            best = found;
        }
    }
    limits::explain(
        chain,
        world_from_base,
        world_from_tip,
        start,
        best,
        options,
        iterations,
    )
}

/// Every different answer that `starts` random starts lead to, in the order found.
///
/// Answers closer than 1e-3 rad or m in every joint count as one. For choosing a posture; a chain with
/// spare degrees of freedom gives samples of its endless family.
pub fn distinct_solutions(
    chain: &KinematicChain,
    world_from_base: DPose3,
    world_from_tip: &DPose3,
    starts: usize,
    options: &IkOptions,
) -> Vec<IkSolution> {
    let search = Search::new(chain, world_from_base, world_from_tip, options, true);
    let mut random = ChaCha8Rng::seed_from_u64(options.seed);
    let mut solutions: Vec<IkSolution> = Vec::new();
    for used in 1..=starts {
        let found = search.descend(search.random_start(&mut random));
        let known = |other: &IkSolution| {
            let mut pairs = other.q.iter().zip(&found.q);
            pairs.all(|(a, b)| (a - b).abs() < 1e-3)
        };
        if found.reached && !solutions.iter().any(known) {
            solutions.push(found.solution(chain.len(), found.iterations, used));
        }
    }
    solutions
}
