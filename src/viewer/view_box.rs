//! Part of space that a 3D view has to show.

use glam::DVec3;
use glamx::DPose3;

use crate::arm::VisualShape;
use crate::scene::{Scene, ScenePoses, SceneShape};

/// A box along the world's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ViewBox {
    low: DVec3,
    high: DVec3,
}

impl ViewBox {
    /// The box around points; `None` without any.
    pub(super) fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let start = Self {
            low: first,
            high: first,
        };
        Some(points.fold(start, |grown, point| Self {
            low: grown.low.min(point),
            high: grown.high.max(point),
        }))
    }

    /// Its middle [m].
    pub(super) fn centre(&self) -> DVec3 {
        (self.low + self.high) / 2.0
    }

    /// A place in a direction from its middle, so many of its radii away [m]. From two radii it
    /// fills the viewer's field of view.
    pub(super) fn eye(&self, direction: DVec3, radii: f64) -> DVec3 {
        let radius = (self.high - self.low).length() / 2.0;
        self.centre() + direction.normalize_or(DVec3::Z) * radii * radius
    }
}

/// Box of the bodies at the middle frame.
pub(super) fn cell_box(scene: &Scene) -> Option<ViewBox> {
    let corners = scene.bodies.iter().flat_map(|body| {
        let world_from_body = match &body.world_from_body {
            ScenePoses::Static(pose) => Some(*pose),
            ScenePoses::Moving(poses) => poses.get(poses.len() / 2).copied(),
        };
        body.shapes
            .iter()
            .filter_map(move |shape| Some(corners(&world_from_body?, shape)))
            .flatten()
    });
    ViewBox::around(corners)
}

/// Corners in the world of a box around a shape.
fn corners(world_from_body: &DPose3, shape: &SceneShape) -> Vec<DVec3> {
    let (low, high) = match &shape.geometry {
        VisualShape::Box { size } => (-*size / 2.0, *size / 2.0),
        VisualShape::Cylinder { radius, length } => {
            let half = DVec3::new(*radius, *radius, length / 2.0);
            (-half, half)
        }
        VisualShape::Sphere { radius } => (DVec3::splat(-radius), DVec3::splat(*radius)),
        VisualShape::Mesh { vertices, .. } => match ViewBox::around(vertices.iter().copied()) {
            Some(around) => (around.low, around.high),
            None => return vec![],
        },
    };
    let world_from_shape = *world_from_body * shape.body_from_shape;
    let corner = |index: u32| {
        let pick = |bit: u32, low: f64, high: f64| if index & bit == 0 { low } else { high };
        let point = DVec3::new(
            pick(1, low.x, high.x),
            pick(2, low.y, high.y),
            pick(4, low.z, high.z),
        );
        world_from_shape.rotation * point + world_from_shape.translation
    };
    (0..8).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneBody;

    #[test]
    fn the_box_holds_every_body_where_it_is() {
        let body = |entity: &str, centre: DVec3| SceneBody {
            entity: entity.to_owned(),
            shapes: vec![SceneShape {
                body_from_shape: DPose3::IDENTITY,
                geometry: VisualShape::Cylinder {
                    radius: 0.5,
                    length: 2.0,
                },
                colour: [255; 4],
            }],
            world_from_body: ScenePoses::Static(DPose3::from_translation(centre)),
        };
        let scene = Scene {
            bodies: vec![body("a", DVec3::ZERO), body("b", DVec3::X * 4.0)],
            ..Scene::default()
        };
        let around = cell_box(&scene).unwrap();
        assert_eq!(around.low, DVec3::new(-0.5, -0.5, -1.0));
        assert_eq!(around.high, DVec3::new(4.5, 0.5, 1.0));
        let eye = around.eye(DVec3::X, 1.5);
        let radius = DVec3::new(5.0, 1.0, 2.0).length() / 2.0;
        assert!((eye - DVec3::new(2.0 + 1.5 * radius, 0.0, 0.0)).length() < 1e-12);
        assert_eq!(cell_box(&Scene::default()), None);
    }
}
