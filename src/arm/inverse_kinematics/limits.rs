//! Which joint limit stands in the way of a pose that was not reached.

use super::descent::{Descent, Positions, Search};
use super::{IkFailure, IkOptions, IkSolution, LimitingAxis};
use crate::arm::chain::{Joint, JointKind, KinematicChain};
use glamx::DPose3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Solves again without limits and names the axis that is over its own by least; `best` is the nearest
/// pose found within them. If a posture turns out to lie within the limits after all, it is the answer.
pub(super) fn explain(
    chain: &KinematicChain,
    world_from_base: DPose3,
    world_from_tip: &DPose3,
    start: &[f64],
    best: Descent,
    options: &IkOptions,
    iterations: usize,
) -> Result<IkSolution, IkFailure> {
    let count = chain.len();
    let free = Search::new(chain, world_from_base, world_from_tip, options, false);
    let mut random = ChaCha8Rng::seed_from_u64(options.seed);
    let mut nearest: Option<(f64, LimitingAxis)> = None;
    for tried in 0..options.random_starts + 2 {
        let start = match tried {
            0 => free.given_start(start),
            1 => best.q,
            _ => free.random_start(&mut random),
        };
        let mut found = free.descend(start);
        if !found.reached {
            continue;
        }
        wind_back(chain, &mut found.q);
        match most_over_limit(chain, &found.q) {
            None => return Ok(found.solution(count, iterations, options.random_starts + 1)),
            Some(over) => {
                if nearest.as_ref().is_none_or(|(least, _)| over.0 < *least) {
                    nearest = Some(over);
                }
            }
        }
    }
    let reachable_without_limits = nearest.is_some();
    let axis = match nearest {
        Some((_, axis)) => Some(axis),
        None => nearest_limit(chain, &best.q),
    };
    Err(IkFailure {
        q: best.q[..count].to_vec(),
        position_error: best.position_error,
        orientation_error: best.orientation_error,
        reachable_without_limits,
        axis,
    })
}

/// Takes whole turns off revolute joints so that each is as near its mid range as it can be.
fn wind_back(chain: &KinematicChain, q: &mut Positions) {
    for (position, joint) in q.iter_mut().zip(&chain.joints) {
        if let (JointKind::Revolute, Some(middle)) = (joint.kind, joint.middle()) {
            *position -= TAU * ((*position - middle) / TAU).round();
        }
    }
}

/// The joint most over its limit and by how much [rad or m].
fn most_over_limit(chain: &KinematicChain, q: &Positions) -> Option<(f64, LimitingAxis)> {
    let over = |joint: &Joint, position: f64| (position - joint.upper).max(joint.lower - position);
    let joints = chain.joints.iter().zip(q).enumerate();
    joints
        .map(|(index, (joint, position))| (over(joint, *position), index))
        .filter(|(amount, _)| *amount > 0.0)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(amount, index)| (amount, limiting_axis(chain, index, q[index])))
}

/// The joint with the smallest share of its range left.
fn nearest_limit(chain: &KinematicChain, q: &Positions) -> Option<LimitingAxis> {
    let room = |index: usize| {
        let joint = &chain.joints[index];
        (q[index] - joint.lower).min(joint.upper - q[index]) / (joint.upper - joint.lower)
    };
    (0..chain.len())
        .filter(|index| chain.joints[*index].middle().is_some())
        .min_by(|a, b| room(*a).total_cmp(&room(*b)))
        .map(|index| limiting_axis(chain, index, q[index]))
}

fn limiting_axis(chain: &KinematicChain, index: usize, position: f64) -> LimitingAxis {
    let joint = &chain.joints[index];
    let nearer_upper = (joint.upper - position).abs() < (position - joint.lower).abs();
    LimitingAxis {
        joint: index,
        name: joint.name.clone(),
        position,
        limit: if nearer_upper {
            joint.upper
        } else {
            joint.lower
        },
    }
}
