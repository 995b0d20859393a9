//! Links as solids of one density: volume, centre and second moments of their shapes; of a mesh those of its convex hull, which a mesh that is open has as well.

use glam::{DMat3, DQuat, DVec3};
use rapier3d::parry::shape::SharedShape;

use super::{CollisionShape, VisualShape};
use crate::arm::chain::BodyInertia;

/// The shapes together, of density 1 kg/m3, in the frame of the moving link that they belong to; without mass if they enclose no volume.
pub(super) fn of_density_one<'a>(shapes: impl Iterator<Item = &'a CollisionShape>) -> BodyInertia {
    shapes.fold(BodyInertia::ZERO, |sum, own| {
        let solid = solid(&own.shape).unwrap_or(BodyInertia::ZERO);
        sum.welded_to(&solid.seen_from(&own.link_from_shape))
    })
}

/// A body of the same shape with another mass [kg].
pub(super) fn with_mass(body: &BodyInertia, mass: f64) -> BodyInertia {
    BodyInertia {
        mass,
        centre_of_mass: body.centre_of_mass,
        inertia: body.inertia * (mass / body.mass),
    }
}

/// A rod of density 1 kg/m3 from the origin to a point [m], as thick as arms of its length are; a ball where the point is the origin.
pub(super) fn rod(to: DVec3) -> BodyInertia {
    /// Radius over length of an arm, and the least radius [m]: judged.
    const SLENDERNESS: f64 = 0.15;
    const THINNEST: f64 = 0.04;
    let length = to.length();
    let radius = (SLENDERNESS * length).max(THINNEST);
    let shape = if length < radius {
        VisualShape::Sphere { radius }
    } else {
        VisualShape::Cylinder { radius, length }
    };
    let along = DQuat::from_rotation_arc(DVec3::Z, to.try_normalize().unwrap_or(DVec3::Z));
    let pose = glamx::DPose3::from_parts(0.5 * to, along);
    solid(&shape).map_or(BodyInertia::ZERO, |solid| solid.seen_from(&pose))
}

fn solid(shape: &VisualShape) -> Option<BodyInertia> {
    let diagonal = |x: f64, y: f64, z: f64| DMat3::from_diagonal(DVec3::new(x, y, z));
    let centred = |mass: f64, per_mass: DMat3| BodyInertia {
        mass,
        centre_of_mass: DVec3::ZERO,
        inertia: per_mass * mass,
    };
    match shape {
        VisualShape::Box { size } => {
            let [x, y, z] = (*size * *size / 12.0).to_array();
            let volume = size.x * size.y * size.z;
            Some(centred(volume, diagonal(y + z, x + z, x + y)))
        }
        VisualShape::Cylinder { radius, length } => {
            let about_axis = 0.5 * radius * radius;
            let across = 0.5 * about_axis + length * length / 12.0;
            let volume = std::f64::consts::PI * radius * radius * length;
            Some(centred(volume, diagonal(across, across, about_axis)))
        }
        VisualShape::Sphere { radius } => {
            let about = 0.4 * radius * radius;
            let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
            Some(centred(volume, diagonal(about, about, about)))
        }
        VisualShape::Mesh { vertices, .. } => {
            let properties = SharedShape::convex_hull(vertices)?.mass_properties(1.0);
            let mass = properties.mass();
            let body = BodyInertia {
                mass,
                centre_of_mass: properties.local_com,
                inertia: properties.reconstruct_inertia_matrix(),
            };
            let is_solid = mass > 0.0 && mass.is_finite() && body.inertia.is_finite();
            is_solid.then_some(body)
        }
    }
}
