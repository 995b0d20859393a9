//! Shapes of a scene as triangles in the world.

use glam::{DQuat, DVec3};
use glamx::DPose3;

use crate::arm::VisualShape;
use crate::scene::colour::Colour;
use crate::scene::{Scene, ScenePoses, SceneShape};

/// Sides of a drawn cylinder, and of a sphere about its axis.
const SIDES: usize = 32;
/// Rings of a sphere from pole to pole.
const RINGS: usize = 16;

/// A triangle with the normals by which its corners are shaded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Face {
    /// Corners in the world [m].
    pub(super) corners: [DVec3; 3],
    /// Unit normals at the corners.
    pub(super) normals: [DVec3; 3],
    pub(super) colour: Colour,
    /// Number of the body.
    pub(super) body: u16,
}

/// Triangles of the bodies at a frame; of those of which the name passes.
pub(super) fn faces(scene: &Scene, frame: usize, wanted: impl Fn(&str) -> bool) -> Vec<Face> {
    let mut faces = Vec::new();
    for (number, body) in scene.bodies.iter().enumerate() {
        let Some(world_from_body) = pose(&body.world_from_body, frame) else {
            continue;
        };
        if !wanted(&body.entity) {
            continue;
        }
        for shape in &body.shapes {
            let place = world_from_body * shape.body_from_shape;
            let colour = shape.colour;
            let body = number as u16 + 1;
            let of = |(corners, normals): Smooth| Face {
                corners: corners.map(|corner| place.transform_point(corner)),
                normals: normals.map(|normal| place.rotation * normal),
                colour,
                body,
            };
            faces.extend(triangles(shape).into_iter().map(of));
        }
    }
    faces
}

/// Where a body is at a frame.
pub(super) fn pose(poses: &ScenePoses, frame: usize) -> Option<DPose3> {
    match poses {
        ScenePoses::Static(pose) => Some(*pose),
        ScenePoses::Moving(poses) => poses.get(frame).copied(),
    }
}

/// Corners and normals.
type Smooth = ([DVec3; 3], [DVec3; 3]);

fn triangles(shape: &SceneShape) -> Vec<Smooth> {
    match &shape.geometry {
        VisualShape::Box { size } => cuboid(*size),
        VisualShape::Cylinder { radius, length } => cylinder(*radius, *length),
        VisualShape::Sphere { radius } => sphere(*radius),
        VisualShape::Mesh {
            vertices,
            triangles,
        } => {
            let corners = |of: &[u32; 3]| of.map(|index| vertices[index as usize]);
            triangles
                .iter()
                .filter_map(|of| flat(corners(of)))
                .collect()
        }
    }
}

/// With the normal of its plane; none without area.
fn flat(corners: [DVec3; 3]) -> Option<Smooth> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let normal = normal.try_normalize()?;
    Some((corners, [normal; 3]))
}

fn quad([a, b, c, d]: [DVec3; 4]) -> impl Iterator<Item = Smooth> {
    [[a, b, c], [a, c, d]].into_iter().filter_map(flat)
}

fn cuboid(size: DVec3) -> Vec<Smooth> {
    let half = 0.5 * size;
    let turned = [
        DQuat::IDENTITY,
        DQuat::from_rotation_x(std::f64::consts::PI),
        DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
        DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2),
        DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2),
        DQuat::from_rotation_y(-std::f64::consts::FRAC_PI_2),
    ];
    let top = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let side = |turn: DQuat| quad(top.map(|(x, y)| (turn * DVec3::new(x, y, 1.0)).round() * half));
    turned.into_iter().flat_map(side).collect()
}

fn round(side: usize) -> DVec3 {
    let angle = std::f64::consts::TAU * side as f64 / SIDES as f64;
    DVec3::new(angle.cos(), angle.sin(), 0.0)
}

fn cylinder(radius: f64, length: f64) -> Vec<Smooth> {
    let up = DVec3::Z * 0.5 * length;
    let mut all = Vec::new();
    for side in 0..SIDES {
        let (here, next) = (round(side), round(side + 1));
        let (a, b) = (radius * here, radius * next);
        all.push(([a - up, b - up, b + up], [here, next, next]));
        all.push(([a - up, b + up, a + up], [here, next, here]));
        all.extend(flat([up, a + up, b + up]));
        all.extend(flat([-up, b - up, a - up]));
    }
    all
}

fn sphere(radius: f64) -> Vec<Smooth> {
    let place = |ring: usize, side: usize| {
        let angle = std::f64::consts::PI * ring as f64 / RINGS as f64;
        angle.sin() * round(side) + DVec3::Z * angle.cos()
    };
    let mut all = Vec::new();
    for ring in 0..RINGS {
        for side in 0..SIDES {
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
            let [a, b, c, d] = corners.map(|(down, on)| place(ring + down, side + on));
            for normals in [[a, b, c], [a, c, d]] {
                all.push((normals.map(|normal| radius * normal), normals));
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume enclosed by triangles that turn outwards.
    fn volume(triangles: &[Smooth]) -> f64 {
        let of = |(corners, _): &Smooth| corners[0].dot(corners[1].cross(corners[2])) / 6.0;
        triangles.iter().map(of).sum()
    }

    #[test]
    fn solids_are_closed_and_face_outwards() {
        let box_of = volume(&cuboid(DVec3::new(1.0, 2.0, 3.0)));
        assert!((box_of - 6.0).abs() < 1e-12, "{box_of}");
        let pi = std::f64::consts::PI;
        assert!((volume(&cylinder(1.0, 2.0)) / (2.0 * pi) - 1.0).abs() < 0.01);
        assert!((volume(&sphere(1.0)) / (4.0 / 3.0 * pi) - 1.0).abs() < 0.03);
    }
}
