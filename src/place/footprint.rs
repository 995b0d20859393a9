//! What stands in a cell as it is seen from above: the outline of each body, a convex one.

use glam::{DVec2, DVec3};

use super::Possible;
use crate::cell::{Setup, Stance};
use crate::collision::Role;

/// A body from above.
#[derive(Debug, Clone, PartialEq)]
pub struct Footprint {
    /// What it is.
    pub kind: FootprintKind,
    /// Its name.
    pub name: String,
    /// Corners of its outline, anticlockwise [m].
    pub outline: Vec<DVec2>,
}

/// What a body is in the picture of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FootprintKind {
    /// The arm's base, which stands.
    Base,
    /// A link of the arm, or what is mounted on it.
    Link,
    /// An obstacle.
    Obstacle,
    /// The part as the scenario has it.
    PartNow,
    /// The part where the job is done most comfortably.
    PartBest,
    /// As far as the tool reaches at the part's height with arm and slide stretched.
    Reach,
}

/// Bodies of a cell from above, the arm at the start of the edge where the job is done best, if it can be, or as the scenario has it.
#[must_use]
pub fn footprints(setup: &Setup, best: Option<(glam::DVec3, Possible)>) -> Vec<Footprint> {
    let own = setup.stance();
    let stance = best.map_or(own, |(position, possible)| Stance {
        world_from_part: glamx::DPose3::from_parts(position, own.world_from_part.rotation),
        roll: Some(possible.roll),
        ..own
    });
    let posture = setup.outline(&stance).ok().map(|outline| outline.start);
    let mut found = vec![reach(setup, stance.world_from_part.translation.z)];
    let stroke = setup.scenario.process.working_stroke;
    let joints = posture.as_ref().map(|start| {
        let slide = std::iter::once(&stroke);
        start.iter().chain(slide).copied().collect::<Vec<f64>>()
    });
    for body in setup.collision.placed_at(joints.as_deref()) {
        let kind = match body.role {
            Role::Robot if !body.moves => FootprintKind::Base,
            Role::Robot | Role::Device | Role::Tool => FootprintKind::Link,
            Role::Obstacle => FootprintKind::Obstacle,
            Role::Part => FootprintKind::PartNow,
            Role::Floor => continue,
        };
        let points: Vec<DVec2> = body
            .corners
            .iter()
            .map(|corner| corner.truncate())
            .collect();
        found.push(Footprint {
            kind,
            name: body.name.to_owned(),
            outline: hull(points),
        });
    }
    if best.is_some() {
        let vertices = setup.part.mesh.vertices().iter();
        let seen = vertices.map(|v| stance.world_from_part.transform_point(*v).truncate());
        found.push(Footprint {
            kind: FootprintKind::PartBest,
            name: "part".to_owned(),
            outline: hull(seen.collect()),
        });
    }
    found
}

/// How far the tool comes at a height at most: a circle about the arm's first joint.
fn reach(setup: &Setup, height: f64) -> Footprint {
    const SIDES: u32 = 180;
    let nominal = &setup.scenario.nominal;
    let mounting = &nominal.mounting;
    let tool = mounting.tool_centre + nominal.device.full_stroke + mounting.tool_radius;
    let first = setup.arm.chain.joints.first();
    let joint = first.map_or(DVec3::ZERO, |joint| joint.parent_from_joint.translation);
    let joint = setup.scenario.arm.world_from_base.transform_point(joint);
    let square = (setup.arm.chain.reach() + tool).powi(2) - (height - joint.z).powi(2);
    let radius = square.max(0.0).sqrt();
    let turn = std::f64::consts::TAU / f64::from(SIDES);
    let at = |side: u32| joint.truncate() + radius * DVec2::from_angle(turn * f64::from(side));
    Footprint {
        kind: FootprintKind::Reach,
        name: format!("reach: {:.0} mm", 1e3 * radius),
        outline: (0..SIDES).map(at).collect(),
    }
}

/// Corners of the convex outline of points, anticlockwise (A. M. Andrew, Information Processing Letters 9, 1979).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut corners: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., before, last] = corners[..]
                && (last - before).perp_dot(point - last) <= 0.0
            {
                corners.pop();
            }
            corners.push(point);
        }
        corners.pop();
        corners
    };
    if points.len() < 3 {
        return points;
    }
    let mut below = half(&mut points.iter().copied());
    below.extend(half(&mut points.iter().rev().copied()));
    below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_of_points_is_that_of_the_outer_ones() {
        let points = [
            [0.0, 0.0],
            [2.0, 0.0],
            [1.0, 0.5],
            [2.0, 1.0],
            [0.0, 1.0],
            [1.0, 0.0],
        ];
        let found = hull(points.map(DVec2::from_array).to_vec());
        let expected = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        assert_eq!(found, expected.map(DVec2::from_array));
    }
}
