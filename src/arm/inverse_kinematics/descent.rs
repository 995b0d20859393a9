//! One descent: damped Gauss-Newton steps from one start towards one target.

use super::{IkOptions, IkSolution, TipOrientation};
use crate::arm::chain::{KinematicChain, MAX_JOINTS};
use crate::arm::kinematics::{Jacobian, jacobian_at, link_poses};
use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;
use nalgebra::{SMatrix, SVector};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

type Six = SVector<f64, 6>;
/// Joint positions [rad or m]; slots past the chain's last joint are zero.
pub(super) type Positions = [f64; MAX_JOINTS];

/// One target with everything that stays the same over the steps.
pub(super) struct Search<'a> {
    chain: &'a KinematicChain,
    world_from_base: DPose3,
    world_from_tip: DPose3,
    options: &'a IkOptions,
    limited: bool,
    /// Weight of the angular rows [m]: makes an angle comparable with a distance.
    length: f64,
    /// Spare degrees of freedom, if there are any, are pulled towards mid range.
    redundant: bool,
}

/// Where a descent ended.
#[derive(Clone, Copy)]
pub(super) struct Descent {
    pub q: Positions,
    pub position_error: f64,
    pub orientation_error: f64,
    pub cost: f64,
    pub reached: bool,
    pub iterations: usize,
}

/// Error and Jacobian at one set of joint positions.
struct Linearisation {
    jacobian: Jacobian,
    error: Six,
    position_error: f64,
    orientation_error: f64,
}

impl Descent {
    pub fn solution(
        &self,
        count: usize,
        iterations: usize,
        random_starts_used: usize,
    ) -> IkSolution {
        IkSolution {
            q: self.q[..count].to_vec(),
            position_error: self.position_error,
            orientation_error: self.orientation_error,
            iterations,
            random_starts_used,
        }
    }
}

impl<'a> Search<'a> {
    pub fn new(
        chain: &'a KinematicChain,
        world_from_base: DPose3,
        world_from_tip: &DPose3,
        options: &'a IkOptions,
        limited: bool,
    ) -> Self {
        let wanted = match options.orientation {
            TipOrientation::Full => 6,
            TipOrientation::FreeAboutZ => 5,
        };
        Self {
            chain,
            world_from_base,
            world_from_tip: *world_from_tip,
            options,
            limited,
            length: (0.25 * chain.reach()).max(1e-3),
            redundant: chain.len() > wanted,
        }
    }

    /// The caller's start, moved into the limits if they count.
    pub fn given_start(&self, start: &[f64]) -> Positions {
        let mut q = [0.0; MAX_JOINTS];
        for ((slot, position), joint) in q.iter_mut().zip(start).zip(&self.chain.joints) {
            *slot = if self.limited {
                position.clamp(joint.lower, joint.upper)
            } else {
                *position
            };
        }
        q
    }

    pub fn random_start(&self, random: &mut ChaCha8Rng) -> Positions {
        let mut q = [0.0; MAX_JOINTS];
        for (slot, joint) in q.iter_mut().zip(&self.chain.joints) {
            let share: f64 = random.random();
            let (lower, upper) = (joint.lower.max(-PI), joint.upper.min(PI));
            // Limits may lie wholly outside one turn about zero.
            let (lower, upper) = if lower <= upper {
                (lower, upper)
            } else {
                (joint.lower, joint.upper)
            };
            *slot = lower + share * (upper - lower);
        }
        q
    }

    /// Steps from `q` until reached, stuck or out of iterations.
    pub fn descend(&self, mut q: Positions) -> Descent {
        let mut here = self.linearise(&q);
        let mut cost = 0.5 * here.error.norm_squared();
        let mut extra_damping = 1e-9;
        let mut iterations = 0;
        while !self.reached(&here) && iterations < self.options.max_iterations {
            iterations += 1;
            let damping = cost * 1e-2 + extra_damping * cost.min(1.0);
            let Some(step) = self.step(&q, &here, damping) else {
                break;
            };
            let next_q = self.moved(&q, &step);
            let next = self.linearise(&next_q);
            let next_cost = 0.5 * next.error.norm_squared();
            if next_cost < cost {
                (q, here, cost) = (next_q, next, next_cost);
                extra_damping = (0.2 * extra_damping).max(1e-9);
            } else {
                extra_damping = (extra_damping * 30.0).max(1e-3);
                if extra_damping > 1e12 {
                    break;
                }
            }
        }
        Descent {
            q,
            position_error: here.position_error,
            orientation_error: here.orientation_error,
            cost,
            reached: self.reached(&here),
            iterations,
        }
    }

    fn reached(&self, here: &Linearisation) -> bool {
        here.position_error <= self.options.position_tolerance
            && here.orientation_error <= self.options.orientation_tolerance
    }

    fn linearise(&self, q: &Positions) -> Linearisation {
        let count = self.chain.len();
        let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
        let poses = &mut poses[..count];
        link_poses(self.chain, self.world_from_base, &q[..count], poses);
        let last = poses.last().copied().unwrap_or(self.world_from_base);
        let tip = last * self.chain.tip_from_last;
        let mut jacobian = jacobian_at(self.chain, poses, tip.translation);
        let position = self.world_from_tip.translation - tip.translation;
        let angular = match self.options.orientation {
            TipOrientation::Full => {
                rotation_vector(self.world_from_tip.rotation * tip.rotation.inverse())
            }
            TipOrientation::FreeAboutZ => {
                let tip_from_world = DMat3::from_quat(tip.rotation).transpose();
                drop_turning_about_tip_z(&mut jacobian, count, &tip_from_world);
                tilt(tip_from_world * (self.world_from_tip.rotation * DVec3::Z))
            }
        };
        jacobian.fixed_rows_mut::<3>(3).scale_mut(self.length);
        let scaled = self.length * angular;
        Linearisation {
            jacobian,
            error: Six::from([
                position.x, position.y, position.z, scaled.x, scaled.y, scaled.z,
            ]),
            position_error: position.length(),
            orientation_error: angular.length(),
        }
    }

    /// Damped minimum-norm step; joints it would push over their limits are held and it is solved again.
    fn step(&self, q: &Positions, here: &Linearisation, damping: f64) -> Option<Positions> {
        let count = self.chain.len();
        let pull = self.pull(q, here);
        let mut jacobian = here.jacobian;
        let mut held = [false; MAX_JOINTS];
        loop {
            let spare =
                SVector::<f64, MAX_JOINTS>::from_fn(
                    |index, _| {
                        if held[index] { 0.0 } else { pull[index] }
                    },
                );
            let mut normal: SMatrix<f64, 6, 6> = jacobian * jacobian.transpose();
            for row in 0..6 {
                normal[(row, row)] += damping + 1e-15;
            }
            let solved = normal.cholesky()?.solve(&(here.error - jacobian * spare));
            let step: Positions = (spare + jacobian.tr_mul(&solved)).into();
            let blocked = |index: &usize| !held[*index] && self.pushes_over(q, &step, *index);
            let blocked: Vec<usize> = (0..count).filter(blocked).collect();
            if blocked.is_empty() {
                let finite = step[..count].iter().all(|x| x.is_finite());
                return finite.then_some(step);
            }
            for index in blocked {
                held[index] = true;
                jacobian.column_mut(index).fill(0.0);
            }
        }
    }

    /// Whether joint `index` stands at a limit and the step would push it on.
    fn pushes_over(&self, q: &Positions, step: &Positions, index: usize) -> bool {
        let joint = &self.chain.joints[index];
        self.limited
            && ((q[index] >= joint.upper && step[index] > 0.0)
                || (q[index] <= joint.lower && step[index] < 0.0))
    }

    /// Wish of the spare degrees of freedom: towards mid range, in proportion to the error left, so that
    /// it fades as the pose is reached and the last steps converge as without it.
    fn pull(&self, q: &Positions, here: &Linearisation) -> Positions {
        let mut pull = [0.0; MAX_JOINTS];
        if self.redundant && self.limited {
            let gain = 0.5 * here.error.norm() / self.length;
            for (index, joint) in self.chain.joints.iter().enumerate() {
                if let Some(middle) = joint.middle() {
                    let half_range = 0.5 * (joint.upper - joint.lower);
                    pull[index] = gain.min(0.5) * (middle - q[index]) / half_range.max(1e-6);
                }
            }
        }
        pull
    }

    fn moved(&self, q: &Positions, step: &Positions) -> Positions {
        // Longer turns than this leave the range in which the linearisation means anything.
        let largest = step.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let share = if largest > 0.8 { 0.8 / largest } else { 1.0 };
        let mut moved = *q;
        for (index, joint) in self.chain.joints.iter().enumerate() {
            moved[index] += share * step[index];
            if self.limited {
                moved[index] = moved[index].clamp(joint.lower, joint.upper);
            }
        }
        moved
    }
}

/// Rotation vector of the shorter turn [rad]. Unlike glam's `to_scaled_axis` it keeps angles below 2e-8 rad.
fn rotation_vector(turn: DQuat) -> DVec3 {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let imaginary = DVec3::new(turn.x, turn.y, turn.z);
    let sine = imaginary.length();
    if sine > 0.0 {
        imaginary * (2.0 * sine.atan2(turn.w) / sine)
    } else {
        DVec3::ZERO
    }
}

/// Turns the angular rows into tip axes and clears the one about the tip's z.
fn drop_turning_about_tip_z(jacobian: &mut Jacobian, count: usize, tip_from_world: &DMat3) {
    for index in 0..count {
        let mut column = jacobian.column_mut(index);
        let turned = *tip_from_world * DVec3::new(column[3], column[4], column[5]);
        (column[3], column[4], column[5]) = (turned.x, turned.y, 0.0);
    }
}

/// Rotation vector that tilts z onto `wanted`, a unit vector; it has no z component [rad].
fn tilt(wanted: DVec3) -> DVec3 {
    let across = DVec3::new(-wanted.y, wanted.x, 0.0);
    let sine = across.length();
    let angle = sine.atan2(wanted.z);
    if sine > 0.0 {
        across * (angle / sine)
    } else {
        DVec3::X * angle
    }
}
