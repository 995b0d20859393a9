//! The whole job as joint motion over time: approach, engage, settle, follow, retract.
//!
//! Approach, engage and retract run along the tool's axis; the tool's ball is led so that at the working stroke it presses into the edge by the contact's
//! nominal penetration.

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;

use super::check;
use super::error::{Obstacle, PlanError};
use super::posture::Standing;
use super::profile::{MotionLimits, PathState, Profile, SpeedSection};
use super::spline::Spline;
use super::toolpath::{Stretch, ToolPath, ToolStation};
use crate::arm::chain::{Chain, MAX_JOINTS};

/// Distance between the knots of the joint angles' spline [m].
const KNOT_SPACING: f64 = 1e-3;
/// Distance between the poses by which a posture is chosen [m].
const COARSE_SPACING: f64 = 8e-3;
/// Distance before touching at which approach hands over to engage [m].
const CLEARANCE: f64 = 5e-3;
/// Share of an axis's speed limit that a slowed feed may use [1].
const SPEED_SHARE: f64 = 0.9;
/// Length over which the feed may be slowed for an axis's speed limit [m].
const FEED_CHUNK: f64 = 1e-2;

/// Part of the job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Towards the edge.
    Approach,
    /// Onto the edge, then at rest until the force has settled.
    Engage,
    /// Along the edge.
    Follow,
    /// Away from it.
    Retract,
}

impl Phase {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Approach => "approach",
            Self::Engage => "engage",
            Self::Follow => "follow",
            Self::Retract => "retract",
        }
    }
}

/// What to plan.
#[derive(Debug, Clone)]
pub struct PlanRequest<'a> {
    /// The arm, base to flange.
    pub arm: &'a Chain,
    /// The arm with the slide as its last joint.
    pub arm_with_slide: &'a Chain,
    /// Its base in the world.
    pub world_from_base: DPose3,
    /// Gravity in the world [m/s2].
    pub gravity: DVec3,
    /// The tool's path.
    pub tool_path: ToolPath,
    /// Centre of the ball from the flange at the working stroke [m].
    pub tool_distance: f64,
    /// Radius of the ball [m].
    pub tool_radius: f64,
    /// Nominal penetration of the contact [m].
    pub penetration: f64,
    /// Stroke at which the device works [m].
    pub working_stroke: f64,
    /// Way that the slide is pushed back when the tool is set on the edge [m].
    pub push_back: f64,
    /// Desired force along the contact normal [N].
    pub force: f64,
    /// Coulomb friction coefficient between tool and part [1].
    pub friction: f64,
    /// Feed along the edge [m/s].
    pub feed: f64,
    /// Feed past corners [m/s].
    pub corner_feed: f64,
    /// Acceleration and jerk along the path.
    pub limits: MotionLimits,
    /// Distance before the edge at which the motion starts [m].
    pub approach_distance: f64,
    /// Speed of approach and retraction [m/s].
    pub approach_speed: f64,
    /// Speed at which the tool is set on [m/s].
    pub engage_speed: f64,
    /// Time at rest on the edge [s].
    pub settle_time: f64,
    /// Posture near which to look first [rad].
    pub seed_posture: Option<&'a [f64]>,
    /// Seed of the search.
    pub seed: u64,
}

impl PlanRequest<'_> {
    /// Force of the part on the tool while it follows the edge: contact force and friction against the motion [N].
    pub(super) fn force_on_tool(&self, normal: DVec3, tangent: DVec3) -> DVec3 {
        self.force * (normal - self.friction * tangent)
    }
}

/// Where the arm and the tool should be at a time.
#[derive(Debug, Clone, Copy)]
pub struct Reference {
    /// Part of the job.
    pub phase: Phase,
    /// Joint angles [rad].
    pub position: [f64; MAX_JOINTS],
    /// Joint speeds [rad/s].
    pub velocity: [f64; MAX_JOINTS],
    /// Joint accelerations [rad/s2].
    pub acceleration: [f64; MAX_JOINTS],
    /// Length of edge behind the tool [m].
    pub edge_length: f64,
    /// Speed along the path [m/s]; zero off the edge.
    pub feed: f64,
    /// Nominal contact normal.
    pub normal: DVec3,
    /// Axis of the tool, towards the part.
    pub axis: DVec3,
    /// Direction of travel.
    pub tangent: DVec3,
    /// Where the ball's centre should be, at the working stroke [m].
    pub centre: DVec3,
}

/// A stretch of the job over which one spline runs.
#[derive(Debug, Clone)]
pub(super) struct Leg {
    pub(super) phase: Phase,
    pub(super) start_time: f64,
    /// Motion, then rest until the next leg starts.
    pub(super) duration: f64,
    pub(super) profile: Profile,
    pub(super) spline: Spline,
    pub(super) way: Way,
}

/// How a leg's place maps to space.
#[derive(Debug, Clone, Copy)]
pub(super) enum Way {
    /// Along the tool's axis at a fixed place of the path: backed off by `from` at place 0 and moving by `sign`.
    Axial { place: f64, from: f64, sign: f64 },
    /// Along the edge.
    Edge,
}

/// The planned job.
#[derive(Debug, Clone)]
pub struct Plan {
    pub(super) legs: Vec<Leg>,
    pub(super) tool_path: ToolPath,
    offset: f64,
    joints: usize,
    /// Where the feed was slowed, one sentence each.
    pub notes: Vec<String>,
}

impl Plan {
    /// Plans the job and checks it against the arm's limits.
    ///
    /// # Errors
    /// The waypoint that cannot be passed, the axis and its limit.
    pub fn new(request: &PlanRequest) -> Result<Self, PlanError> {
        let standing = Standing {
            chain: request.arm,
            loaded: request.arm_with_slide,
            stroke: request.working_stroke,
            world_from_base: request.world_from_base,
            gravity: request.gravity,
        };
        let far = request.push_back + request.approach_distance;
        let coarse = Coarse::new(request, far);
        let (spin, start) = standing
            .choose(
                |spin| coarse.poses(request, spin),
                request.seed_posture,
                request.seed,
            )
            .map_err(|(index, obstacle)| coarse.failure(request, index, obstacle))?;
        let mut plan = Self {
            legs: Vec::new(),
            tool_path: request.tool_path.clone(),
            offset: request.tool_radius - request.penetration,
            joints: request.arm.len(),
            notes: Vec::new(),
        };
        plan.lay_out(request, &standing, spin, &start, far)?;
        check::limits(request, &standing, &plan)?;
        Ok(plan)
    }

    fn lay_out(
        &mut self,
        request: &PlanRequest,
        standing: &Standing,
        spin: f64,
        start: &[f64],
        far: f64,
    ) -> Result<(), PlanError> {
        let length = request.tool_path.length();
        let knots = places(length, KNOT_SPACING);
        let poses = poses_along(request, &knots, spin);
        let near = request.push_back + CLEARANCE.min(0.5 * request.approach_distance);
        let axial = |plan: &mut Self,
                     phase,
                     place: f64,
                     pose: DPose3,
                     from: f64,
                     to: f64,
                     speed,
                     rest,
                     start: &[f64]| {
            let way = Way::Axial {
                place,
                from,
                sign: (to - from).signum(),
            };
            let knots = places((to - from).abs(), KNOT_SPACING);
            let poses: Vec<DPose3> = knots
                .iter()
                .map(|k| backed_off(pose, from + k * (to - from).signum()))
                .collect();
            let profile = Profile::single((to - from).abs(), speed, request.limits);
            plan.add_leg(standing, phase, way, knots, &poses, profile, rest, start)
        };
        let (first, last) = (poses[0], poses[poses.len() - 1]);
        let q = axial(
            self,
            Phase::Approach,
            0.0,
            first,
            far,
            near,
            request.approach_speed,
            0.0,
            start,
        )?;
        let q = axial(
            self,
            Phase::Engage,
            0.0,
            first,
            near,
            0.0,
            request.engage_speed,
            request.settle_time,
            &q,
        )?;
        let angles = self.track(standing, Phase::Follow, Way::Edge, &knots, &poses, &q)?;
        let spline = Spline::through(knots, angles);
        let sections = self.feeds(request, &spline)?;
        let profile = Profile::through(&sections, request.limits);
        let q = spline.values().last().cloned().unwrap_or(q);
        self.push(Phase::Follow, Way::Edge, spline, profile, 0.0);
        // Gently until the slide stands at its outer stop again: there it takes the tool off the edge with a jolt.
        let q = axial(
            self,
            Phase::Retract,
            length,
            last,
            0.0,
            near,
            request.engage_speed,
            0.0,
            &q,
        )?;
        axial(
            self,
            Phase::Retract,
            length,
            last,
            near,
            far,
            request.approach_speed,
            0.2,
            &q,
        )?;
        Ok(())
    }

    #[allow(clippy::too_many_arguments)]
    fn add_leg(
        &mut self,
        standing: &Standing,
        phase: Phase,
        way: Way,
        knots: Vec<f64>,
        poses: &[DPose3],
        profile: Profile,
        rest: f64,
        start: &[f64],
    ) -> Result<Vec<f64>, PlanError> {
        let angles = self.track(standing, phase, way, &knots, poses, start)?;
        let end = angles.last().cloned().unwrap_or_default();
        self.push(phase, way, Spline::through(knots, angles), profile, rest);
        Ok(end)
    }

    fn track(
        &self,
        standing: &Standing,
        phase: Phase,
        way: Way,
        knots: &[f64],
        poses: &[DPose3],
        start: &[f64],
    ) -> Result<Vec<Vec<f64>>, PlanError> {
        standing.track(poses, start).map_err(|(index, obstacle)| {
            let place = match way {
                Way::Edge => knots[index],
                Way::Axial { place, .. } => place,
            };
            waypoint_error(&self.tool_path, phase, index, poses.len(), place, obstacle)
        })
    }

    fn push(&mut self, phase: Phase, way: Way, spline: Spline, profile: Profile, rest: f64) {
        let start_time = self.duration();
        let duration = profile.duration() + rest;
        self.legs.push(Leg {
            phase,
            start_time,
            duration,
            profile,
            spline,
            way,
        });
    }

    /// Speed limits along the edge: the feed, less at corners, and less where an axis could not keep up.
    fn feeds(
        &mut self,
        request: &PlanRequest,
        spline: &Spline,
    ) -> Result<Vec<SpeedSection>, PlanError> {
        let mut sections = Vec::new();
        let mut slowest: Option<(f64, f64, usize)> = None;
        for section in request.tool_path.sections() {
            let wanted = match section.stretch {
                Stretch::Edge { .. } => request.feed,
                Stretch::Corner { .. } => request.corner_feed,
            };
            let chunks = (section.length / FEED_CHUNK).ceil().max(1.0);
            for chunk in 0..chunks as usize {
                let start = section.start + section.length * chunk as f64 / chunks;
                let end = start + section.length / chunks;
                let (cap, joint) = self.speed_cap(request, spline, start, end);
                if cap < wanted && slowest.is_none_or(|s| cap < s.0) {
                    slowest = Some((cap, start, joint));
                }
                sections.push(SpeedSection {
                    length: section.length / chunks,
                    speed: wanted.min(cap),
                });
            }
        }
        if let Some((cap, place, joint)) = slowest {
            let axis = &request.arm.joints[joint];
            let station = request.tool_path.at(place);
            if cap < 0.1 * request.feed {
                let obstacle = Obstacle::Velocity {
                    axis: axis.name.clone(),
                    value: axis.velocity * SPEED_SHARE * request.feed / cap,
                    limit: axis.velocity,
                };
                let waypoint = (place / KNOT_SPACING) as usize;
                let count = spline.knots().len();
                return Err(waypoint_error(
                    &self.tool_path,
                    Phase::Follow,
                    waypoint,
                    count,
                    place,
                    obstacle,
                ));
            }
            self.notes.push(format!(
                "the feed is slowed to {:.1} mm/s near {:.1} mm of the edge, where axis {} reaches {:.0} % of its speed limit",
                1e3 * cap,
                1e3 * station.edge_length,
                axis.name,
                100.0 * SPEED_SHARE
            ));
        }
        Ok(sections)
    }

    /// Largest speed between two places that every axis can follow, and the axis that limits it.
    fn speed_cap(
        &self,
        request: &PlanRequest,
        spline: &Spline,
        start: f64,
        end: f64,
    ) -> (f64, usize) {
        let (mut value, mut slope, mut bend) =
            ([0.0; MAX_JOINTS], [0.0; MAX_JOINTS], [0.0; MAX_JOINTS]);
        let n = self.joints;
        let mut worst = (0.0, 0);
        for i in 0..=8 {
            let place = start + (end - start) * f64::from(i) / 8.0;
            spline.at(place, &mut value[..n], &mut slope[..n], &mut bend[..n]);
            for (joint, axis) in request.arm.joints.iter().enumerate() {
                let share = slope[joint].abs() / axis.velocity;
                if share > worst.0 {
                    worst = (share, joint);
                }
            }
        }
        (SPEED_SHARE / worst.0.max(1e-12), worst.1)
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

    /// Joint angles at the start [rad].
    pub fn start(&self) -> Vec<f64> {
        self.reference(0.0).position[..self.joints].to_vec()
    }

    /// The tool's path.
    pub fn tool_path(&self) -> &ToolPath {
        &self.tool_path
    }

    /// The reference at a time [s].
    pub fn reference(&self, time: f64) -> Reference {
        let index = self
            .legs
            .partition_point(|leg| leg.start_time <= time)
            .saturating_sub(1);
        let leg = &self.legs[index];
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
            Way::Axial { place, from, sign } => {
                (self.tool_path.at(place), from + sign * along.position, 0.0)
            }
        };
        Reference {
            phase: leg.phase,
            position,
            velocity,
            acceleration,
            edge_length: station.edge_length,
            feed,
            normal: station.normal,
            axis: station.axis,
            tangent: station.tangent,
            centre: station.point + station.normal * self.offset - station.axis * back,
        }
    }
}

/// Widely spaced poses of the whole job, by which a posture is chosen: approach, follow, retract.
struct Coarse {
    /// Distances backed off along the tool's axis, from far to touching.
    backs: Vec<f64>,
    /// Places along the path.
    places: Vec<f64>,
}

impl Coarse {
    fn new(request: &PlanRequest, far: f64) -> Self {
        Self {
            backs: places_between(far, 0.0, COARSE_SPACING),
            places: places(request.tool_path.length(), COARSE_SPACING),
        }
    }

    /// Flange poses for a spin [rad], with the force on the tool at each [N].
    fn poses(&self, request: &PlanRequest, spin: f64) -> (Vec<DPose3>, Vec<DVec3>) {
        let follow = poses_along(request, &self.places, spin);
        let (first, last) = (follow[0], follow[follow.len() - 1]);
        let approach = self.backs.iter().map(|&back| backed_off(first, back));
        let retract = self.backs.iter().rev().map(|&back| backed_off(last, back));
        let idle = vec![DVec3::ZERO; self.backs.len()];
        let mut forces = idle.clone();
        forces.extend(self.places.iter().map(|&place| {
            let station = request.tool_path.at(place);
            request.force_on_tool(station.normal, station.tangent)
        }));
        forces.extend(idle);
        (
            approach
                .chain(follow.iter().copied())
                .chain(retract)
                .collect(),
            forces,
        )
    }

    fn failure(&self, request: &PlanRequest, index: usize, obstacle: Obstacle) -> PlanError {
        let (before, after) = (self.backs.len(), self.backs.len() + self.places.len());
        let (phase, waypoint, count, place) = if index < before {
            (Phase::Approach, index, before, 0.0)
        } else if index < after {
            (
                Phase::Follow,
                index - before,
                self.places.len(),
                self.places[index - before],
            )
        } else {
            (
                Phase::Retract,
                index - after,
                before,
                request.tool_path.length(),
            )
        };
        waypoint_error(&request.tool_path, phase, waypoint, count, place, obstacle)
    }
}

/// Evenly spaced places from 0 to `length`, both included.
fn places(length: f64, spacing: f64) -> Vec<f64> {
    places_between(0.0, length, spacing)
}

fn places_between(from: f64, to: f64, spacing: f64) -> Vec<f64> {
    let count = ((to - from).abs() / spacing).ceil().max(2.0) as usize;
    (0..=count)
        .map(|i| from + (to - from) * i as f64 / count as f64)
        .collect()
}

/// The pose moved back along its own z by `back` [m].
fn backed_off(pose: DPose3, back: f64) -> DPose3 {
    DPose3::from_parts(
        pose.translation - pose.rotation * DVec3::Z * back,
        pose.rotation,
    )
}

/// Flange poses at places along the path; the flange's x is carried along without turning about the tool's axis, from `spin` [rad] off the tangent.
fn poses_along(request: &PlanRequest, places: &[f64], spin: f64) -> Vec<DPose3> {
    let pose = |station: &ToolStation, x: DVec3| {
        let x = (x - station.axis * x.dot(station.axis)).normalize();
        let rotation = DQuat::from_mat3(&DMat3::from_cols(x, station.axis.cross(x), station.axis));
        let centre = station.point + station.normal * (request.tool_radius - request.penetration);
        (
            DPose3::from_parts(centre - station.axis * request.tool_distance, rotation),
            x,
        )
    };
    let first = request.tool_path.at(places[0]);
    let mut x = DQuat::from_axis_angle(first.axis, spin) * first.tangent;
    places
        .iter()
        .map(|&place| {
            let (pose, carried) = pose(&request.tool_path.at(place), x);
            x = carried;
            pose
        })
        .collect()
}

/// The error of a waypoint, counted from 0 here and from 1 in the message.
pub(super) fn waypoint_error(
    tool_path: &ToolPath,
    phase: Phase,
    index: usize,
    count: usize,
    place: f64,
    obstacle: Obstacle,
) -> PlanError {
    let station = tool_path.at(place);
    PlanError::Waypoint {
        phase: phase.name(),
        waypoint: index + 1,
        waypoints: count,
        edge_length: station.edge_length,
        point: station.point,
        obstacle,
    }
}
