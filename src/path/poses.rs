//! Flange poses along the job: along the edge, backed off from it, and widely spaced ones for the choice of a posture.

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;

use super::error::{Obstacle, PlanError};
use super::request::{Phase, PlanRequest, waypoint_error};
use super::toolpath::ToolStation;
use crate::collision::Positions;

/// Distance between the poses by which a posture is chosen [m].
const COARSE_SPACING: f64 = 8e-3;

/// Widely spaced poses of the whole job, by which a posture is chosen: approach, follow, retract.
pub(super) struct Coarse {
    /// Distances backed off along the tool's axis, from far to touching.
    backs: Vec<f64>,
    /// Places along the path.
    places: Vec<f64>,
}

impl Coarse {
    pub(super) fn new(request: &PlanRequest) -> Self {
        Self {
            backs: places_between(request.far(), 0.0, COARSE_SPACING),
            places: places(request.tool_path.length(), COARSE_SPACING),
        }
    }

    /// Flange poses for a spin [rad], with the force on the tool at each [N].
    pub(super) fn poses(&self, request: &PlanRequest, spin: f64) -> (Vec<DPose3>, Vec<DVec3>) {
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

    /// Joint positions of arm and slide at all of its poses.
    pub(super) fn positions<'a>(
        &'a self,
        request: &'a PlanRequest,
        angles: &'a [Vec<f64>],
    ) -> impl Iterator<Item = Positions> + 'a {
        let (before, after) = (self.backs.len(), self.backs.len() + self.places.len());
        let back = move |index: usize| match index {
            _ if index < before => self.backs[index],
            _ if index < after => 0.0,
            _ => self.backs[before - 1 - (index - after)],
        };
        let poses = angles.iter().enumerate();
        poses.map(move |(index, q)| request.with_stroke(q, back(index)))
    }

    /// The error of a coarse pose that is not reached.
    pub(super) fn failure(
        &self,
        request: &PlanRequest,
        index: usize,
        obstacle: Obstacle,
    ) -> PlanError {
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
pub(super) fn places(length: f64, spacing: f64) -> Vec<f64> {
    places_between(0.0, length, spacing)
}

fn places_between(from: f64, to: f64, spacing: f64) -> Vec<f64> {
    let count = ((to - from).abs() / spacing).ceil().max(2.0) as usize;
    (0..=count)
        .map(|i| from + (to - from) * i as f64 / count as f64)
        .collect()
}

/// The pose moved back along its own z by `back` [m].
pub(super) fn backed_off(pose: DPose3, back: f64) -> DPose3 {
    DPose3::from_parts(
        pose.translation - pose.rotation * DVec3::Z * back,
        pose.rotation,
    )
}

/// Flange poses at places along the path; the flange's x is carried along without turning about the tool's axis, from `spin` [rad] off the tangent.
pub(super) fn poses_along(request: &PlanRequest, places: &[f64], spin: f64) -> Vec<DPose3> {
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
