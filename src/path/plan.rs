//! The whole job as joint motion over time: approach, engage, settle, follow, retract.
//!
//! Approach, engage and retract run along the tool's axis; the tool's ball is led so that at the working stroke it presses into the edge by the contact's
//! nominal penetration. Before anything moves the plan is held against the arm's limits.

use super::choice::{Choice, Outline};
use super::collisions;
use super::error::{Obstacle, PlanError};
use super::legs::Layout;
use super::posture::{MountedArm, SINGULAR_LIMIT};
use super::profile::PathState;
use super::reference::Reference;
use super::request::{Leg, Phase, PlanRequest, Way, waypoint_error};
use super::toolpath::ToolPath;
use super::torques;
use crate::arm::chain::MAX_JOINTS;
use crate::collision::JointMotion;

/// Ways, by roll and posture, that are planned in full before a collision is reported.
const WAYS: usize = 4;
/// Interval at which speeds and torques are checked [s].
const INTERVAL: f64 = 4e-3;

/// The planned job.
#[derive(Debug, Clone)]
pub struct Plan {
    pub(super) legs: Vec<Leg>,
    pub(super) tool_path: ToolPath,
    offset: f64,
    joints: usize,
    pub(super) motion: JointMotion,
    /// Angle of the flange's x axis about the tool's axis from the direction of travel, at the start of the edge [rad].
    pub roll: f64,
    /// Where the feed was slowed, one sentence each.
    pub notes: Vec<String>,
}

/// A stretch of the job: from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Part of the job.
    pub phase: Phase,
    /// Pass that it belongs to, from 0.
    pub pass: usize,
    /// When its motion starts [s].
    pub start: f64,
    /// When its motion ends [s].
    pub at_rest: f64,
    /// When the next stretch starts [s].
    pub end: f64,
}

impl Plan {
    /// Chooses roll and posture by widely spaced poses of the whole job.
    ///
    /// # Errors
    /// The pose that cannot be passed, and why.
    pub fn outline(request: &PlanRequest) -> Result<Outline, PlanError> {
        let mut choice = Choice::new(request);
        choice.next().ok_or_else(|| choice.failure())
    }

    /// Plans the job and checks it against the arm's limits and the obstacles.
    ///
    /// # Errors
    /// The waypoint that cannot be passed, the axis and its limit, or the bodies that meet.
    pub fn new(request: &PlanRequest) -> Result<Self, PlanError> {
        let mut choice = Choice::new(request);
        let first = choice.next().ok_or_else(|| choice.failure())?;
        let planned = Self::from_outline(request, first);
        let meets = |planned: &Result<Self, PlanError>| {
            planned.as_ref().is_err_and(PlanError::is_collision)
        };
        if !meets(&planned) {
            return planned;
        }
        // Another roll or posture may pass what is met between the widely spaced poses.
        let others = choice.take(WAYS - 1);
        let mut others = others.map(|outline| Self::from_outline(request, outline));
        others.find(|other| !meets(other)).unwrap_or(planned)
    }

    /// Plans the job with roll and posture as they were chosen.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn from_outline(request: &PlanRequest, outline: Outline) -> Result<Self, PlanError> {
        let mounted = MountedArm::of(request);
        let roll = outline.roll;
        let (legs, notes) = Layout::lay_out(request, &mounted, outline)?;
        let plan = Self {
            motion: collisions::motion(request, &legs),
            roll,
            legs,
            tool_path: request.tool_path.clone(),
            offset: request.tool_radius - request.penetration,
            joints: request.arm.len(),
            notes,
        };
        limits(request, &mounted, &plan)?;
        collisions::check(request, &plan.motion, &plan.legs)?;
        Ok(plan)
    }

    /// The whole motion of arm and slide, its knots the waypoints of all legs.
    pub fn motion(&self) -> &JointMotion {
        &self.motion
    }

    /// Duration of the whole job [s].
    pub fn duration(&self) -> f64 {
        self.legs
            .last()
            .map_or(0.0, |leg| leg.start_time + leg.duration)
    }

    /// Phases with their start and end [s].
    pub fn phases(&self) -> Vec<(Phase, f64, f64)> {
        self.legs
            .iter()
            .map(|leg| (leg.phase, leg.start_time, leg.start_time + leg.duration))
            .collect()
    }

    /// The stretches of the job in order, each a motion and a rest after it.
    pub fn stretches(&self) -> impl Iterator<Item = Stretch> + '_ {
        self.legs.iter().map(|leg| Stretch {
            phase: leg.phase,
            pass: leg.pass,
            start: leg.start_time,
            at_rest: leg.start_time + leg.profile.duration(),
            end: leg.start_time + leg.duration,
        })
    }

    /// Joint angles at the start [rad].
    pub fn start(&self) -> Vec<f64> {
        self.reference(0.0).position[..self.joints].to_vec()
    }

    /// The leg that runs at a time [s].
    fn leg_at(&self, time: f64) -> &Leg {
        let begun = self.legs.partition_point(|leg| leg.start_time <= time);
        &self.legs[begun.saturating_sub(1)]
    }

    /// The reference at a time [s].
    pub fn reference(&self, time: f64) -> Reference {
        let leg = self.leg_at(time);
        let along: PathState = leg.profile.at(time - leg.start_time);
        let (mut position, mut slope, mut bend) =
            ([0.0; MAX_JOINTS], [0.0; MAX_JOINTS], [0.0; MAX_JOINTS]);
        let n = self.joints;
        leg.spline.at(
            along.position,
            &mut position[..n],
            &mut slope[..n],
            &mut bend[..n],
        );
        let (mut velocity, mut acceleration) = ([0.0; MAX_JOINTS], [0.0; MAX_JOINTS]);
        for joint in 0..n {
            velocity[joint] = slope[joint] * along.speed;
            acceleration[joint] =
                bend[joint] * along.speed * along.speed + slope[joint] * along.acceleration;
        }
        let (station, back, feed) = match leg.way {
            Way::Edge => (self.tool_path.at(along.position), 0.0, along.speed),
            way => {
                let place = way.place(along.position, self.tool_path.length());
                let back = way.backed_off(along.position);
                (self.tool_path.at(place), back, 0.0)
            }
        };
        Reference {
            phase: leg.phase,
            pass: leg.pass,
            position,
            velocity,
            acceleration,
            edge_length: station.edge_length,
            feed,
            normal: station.normal,
            axis: station.axis,
            tangent: station.tangent,
            share: self.tool_path.share(&station),
            centre: station.point + station.normal * self.offset - station.axis * back,
        }
    }
}

/// Checks the whole plan against the arm's limits: singularities at every knot, speeds and torques over time.
fn limits(request: &PlanRequest, mounted: &MountedArm, plan: &Plan) -> Result<(), PlanError> {
    singularities(mounted, plan)?;
    let count = (plan.duration() / INTERVAL).ceil() as usize;
    for i in 0..=count {
        drives(request, plan, i as f64 * INTERVAL)?;
    }
    Ok(())
}

fn singularities(mounted: &MountedArm, plan: &Plan) -> Result<(), PlanError> {
    for leg in &plan.legs {
        for (index, q) in leg.spline.values().iter().enumerate() {
            if !mounted.is_regular(q, SINGULAR_LIMIT) {
                let value = mounted.singularity(q);
                let axis = mounted.weakest_axis(q);
                let obstacle = Obstacle::Singular {
                    value,
                    limit: SINGULAR_LIMIT,
                    axis,
                };
                return Err(along_leg(plan, leg, leg.spline.knots()[index], obstacle));
            }
        }
    }
    Ok(())
}

/// Speeds and torques at a time.
fn drives(request: &PlanRequest, plan: &Plan, time: f64) -> Result<(), PlanError> {
    let reference = plan.reference(time);
    let torques = torques::needed(request, &reference);
    for (joint, axis) in request.arm.joints.iter().enumerate() {
        if reference.velocity[joint].abs() > axis.velocity {
            return Err(too_fast(request, plan, time));
        }
        let needed = torques[joint];
        if needed.abs() > axis.effort {
            let obstacle = Obstacle::Effort {
                axis: axis.name.clone(),
                value: needed,
                limit: axis.effort,
            };
            return Err(at_time(plan, time, obstacle));
        }
    }
    Ok(())
}

/// An obstacle at a time, reported by its waypoint.
fn at_time(plan: &Plan, time: f64, obstacle: Obstacle) -> PlanError {
    let leg = plan.leg_at(time);
    let along = leg.profile.at(time - leg.start_time).position;
    along_leg(plan, leg, along, obstacle)
}

/// An obstacle at a place along a leg.
fn along_leg(plan: &Plan, leg: &Leg, along: f64, obstacle: Obstacle) -> PlanError {
    let knots = leg.spline.knots();
    let index = knots
        .partition_point(|&knot| knot <= along)
        .saturating_sub(1);
    let place = leg.way.place(along, plan.tool_path.length());
    let (path, count) = (&plan.tool_path, knots.len());
    waypoint_error(path, leg.phase, index, count, place, obstacle)
}

/// The axis that is most too fast in the leg in which one is, from a time on: the speed that is reported is the one that must come down.
fn too_fast(request: &PlanRequest, plan: &Plan, from: f64) -> PlanError {
    let leg = plan.leg_at(from);
    let end = leg.start_time + leg.duration;
    let mut worst = (0.0, from, 0);
    let count = ((end - from) / INTERVAL).ceil().max(1.0) as usize;
    for step in 0..=count {
        let time = (from + step as f64 * INTERVAL).min(end - 1e-9).max(from);
        let velocity = plan.reference(time).velocity;
        for (joint, axis) in request.arm.joints.iter().enumerate() {
            let share = velocity[joint].abs() / axis.velocity;
            if share > worst.0 {
                worst = (share, time, joint);
            }
        }
    }
    let (_, time, joint) = worst;
    let axis = &request.arm.joints[joint];
    let obstacle = Obstacle::Velocity {
        axis: axis.name.clone(),
        value: plan.reference(time).velocity[joint],
        limit: axis.velocity,
    };
    at_time(plan, time, obstacle)
}
