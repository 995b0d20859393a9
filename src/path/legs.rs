//! The legs of the job, one after the other: approach, engage, follow, retract.

use glamx::DPose3;

use super::choice::Outline;
use super::error::PlanError;
use super::feed;
use super::poses::{backed_off, places, poses_along};
use super::posture::MountedArm;
use super::profile::Profile;
use super::request::{KNOT_SPACING, Leg, Pass, Phase, PlanRequest, Way, waypoint_error};
use super::spline::Spline;

/// Distance before touching at which approach hands over to engage [m].
const CLEARANCE: f64 = 5e-3;
/// Time at rest after retracting [s].
const FINAL_REST: f64 = 0.2;

/// A motion along the tool's axis at a place of the path.
struct Axial {
    phase: Phase,
    place: f64,
    /// Flange pose when touching.
    pose: DPose3,
    /// Distances backed off at its start and end [m].
    from: f64,
    to: f64,
    speed: f64,
    /// Time at rest after it [s].
    rest: f64,
}

/// The legs as they are laid out.
pub(super) struct Layout<'a> {
    request: &'a PlanRequest<'a>,
    mounted: &'a MountedArm<'a>,
    /// Joint angles at the end of the last leg [rad].
    angles: Vec<f64>,
    legs: Vec<Leg>,
    pass: usize,
    notes: Vec<String>,
}

impl<'a> Layout<'a> {
    /// Lays out all legs for a roll of the flange, from joint angles near the first pose.
    ///
    /// # Errors
    /// The waypoint that is not reached.
    pub(super) fn lay_out(
        request: &'a PlanRequest<'a>,
        mounted: &'a MountedArm<'a>,
        Outline { roll, start, .. }: Outline,
    ) -> Result<(Vec<Leg>, Vec<String>), PlanError> {
        let mut layout = Self {
            request,
            mounted,
            angles: start,
            legs: Vec::new(),
            pass: 0,
            notes: Vec::new(),
        };
        let (length, far) = (request.tool_path.length(), request.far());
        let knots = places(length, KNOT_SPACING);
        let poses = poses_along(request, &knots, roll);
        let (first, last) = (poses[0], poses[poses.len() - 1]);
        let near = request.push_back + CLEARANCE.min(0.5 * request.approach_distance);
        let (fast, gentle) = (request.approach_speed, request.engage_speed);
        let at_start = |phase, from, to, speed, rest| Axial {
            phase,
            place: 0.0,
            pose: first,
            from,
            to,
            speed,
            rest,
        };
        let at_end = |from, to, speed, rest| Axial {
            phase: Phase::Retract,
            place: length,
            pose: last,
            from,
            to,
            speed,
            rest,
        };
        let last_pass = request.passes.len() - 1;
        for (pass, &Pass { feed, .. }) in request.passes.iter().enumerate() {
            layout.pass = pass;
            layout.axial(&at_start(Phase::Approach, far, near, fast, 0.0))?;
            let settle = request.settle_time;
            layout.axial(&at_start(Phase::Engage, near, 0.0, gentle, settle))?;
            layout.follow(&knots, &poses, feed)?;
            // Gently until the slide stands at its outer stop again: there it takes the tool off the edge with a jolt.
            layout.axial(&at_end(0.0, near, gentle, 0.0))?;
            layout.axial(&at_end(near, far, fast, FINAL_REST))?;
            if pass < last_pass {
                layout.pass = pass + 1;
                layout.back(&knots, &poses, far)?;
            }
        }
        Ok((layout.legs, layout.notes))
    }

    fn axial(&mut self, motion: &Axial) -> Result<(), PlanError> {
        let length = (motion.to - motion.from).abs();
        let sign = (motion.to - motion.from).signum();
        let way = Way::Axial {
            place: motion.place,
            from: motion.from,
            sign,
        };
        let knots = places(length, KNOT_SPACING);
        let poses: Vec<DPose3> = knots
            .iter()
            .map(|k| backed_off(motion.pose, motion.from + sign * k))
            .collect();
        let spline = self.track(motion.phase, way, knots, &poses)?;
        let profile = Profile::single(length, motion.speed, self.request.limits);
        self.push(motion.phase, way, spline, profile, motion.rest);
        Ok(())
    }

    /// Back to the start of the edge, the tool backed off by a distance [m].
    fn back(&mut self, knots: &[f64], poses: &[DPose3], from: f64) -> Result<(), PlanError> {
        let length = self.request.tool_path.length();
        let away: Vec<DPose3> = (poses.iter().rev())
            .map(|pose| backed_off(*pose, from))
            .collect();
        let places = knots.iter().rev().map(|knot| length - knot).collect();
        let way = Way::Back { from };
        let spline = self.track(Phase::Approach, way, places, &away)?;
        let profile = Profile::single(length, self.request.approach_speed, self.request.limits);
        self.push(Phase::Approach, way, spline, profile, 0.0);
        Ok(())
    }

    fn follow(&mut self, knots: &[f64], poses: &[DPose3], feed: f64) -> Result<(), PlanError> {
        let spline = self.track(Phase::Follow, Way::Edge, knots.to_vec(), poses)?;
        let (sections, note) = feed::sections(self.request, feed, &spline)?;
        self.notes.extend(note);
        let profile = Profile::through(&sections, self.request.limits);
        self.push(Phase::Follow, Way::Edge, spline, profile, 0.0);
        Ok(())
    }

    fn track(
        &mut self,
        phase: Phase,
        way: Way,
        knots: Vec<f64>,
        poses: &[DPose3],
    ) -> Result<Spline, PlanError> {
        let angles = self
            .mounted
            .track(poses, &self.angles)
            .map_err(|(index, stop)| {
                let place = way.place(knots[index], self.request.tool_path.length());
                waypoint_error(
                    &self.request.tool_path,
                    phase,
                    index,
                    poses.len(),
                    place,
                    self.mounted.why(stop),
                )
            })?;
        if let Some(last) = angles.last() {
            self.angles.clone_from(last);
        }
        Ok(Spline::through(knots, angles))
    }

    fn push(&mut self, phase: Phase, way: Way, spline: Spline, profile: Profile, rest: f64) {
        let start_time = self
            .legs
            .last()
            .map_or(0.0, |leg| leg.start_time + leg.duration);
        let duration = profile.duration() + rest;
        self.legs.push(Leg {
            phase,
            pass: self.pass,
            start_time,
            duration,
            profile,
            spline,
            way,
        });
    }
}
