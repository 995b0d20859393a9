//! In place of Rapier's narrow phase: hands it the true contacts of tool and part as they are.
//!
//! Rapier would search the part's mesh and find several contacts at one place (see `contact`). As the narrow phase's dispatcher this answers with the
//! contacts that were found for the coming step instead, one manifold each. It knows the pair of the tool's ball and the part and no other.

use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeCastOptions, ShapeDistance,
    ShapeIntersection, TrackedContact, Unsupported,
};
use rapier3d::parry::shape::{PackedFeatureId, Shape};
use rapier3d::prelude::*;

/// A true contact of the coming step.
#[derive(Debug, Clone, Copy)]
pub struct TrueContact {
    /// Unit normal out of the part, in the world.
    pub normal: DVec3,
    /// Separation that the solver is given [m]: it says the force (see `contact`), and nothing of where the surfaces are.
    pub separation: f64,
}

/// The contacts of the coming step, shared by who finds them and the narrow phase.
#[derive(Debug, Clone, Default)]
pub struct TrueContacts(Arc<Mutex<Vec<TrueContact>>>);

impl TrueContacts {
    /// Does something with the list.
    pub fn with<T>(&self, work: impl FnOnce(&mut Vec<TrueContact>) -> T) -> T {
        work(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for TrueContacts {
    /// The ball's frame has its centre as origin, the part's frame is the world's.
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        shape1: &dyn Shape,
        shape2: &dyn Shape,
        _: Real,
        manifolds: &mut Vec<ContactManifold>,
        _: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let (ball, tool_first) = match (shape1.as_ball(), shape2.as_ball()) {
            (Some(ball), None) => (ball, true),
            (None, Some(ball)) => (ball, false),
            _ => return Err(Unsupported),
        };
        let world_from_tool = if tool_first { pos12.inverse() } else { *pos12 };
        self.with(|contacts| {
            // Never fewer than before: a manifold that vanishes would leave its place in the solver's graph behind.
            let count = contacts.len().max(manifolds.len());
            manifolds.resize_with(count, ContactManifold::new);
            for (index, manifold) in manifolds.iter_mut().enumerate() {
                match contacts.get(index) {
                    Some(contact) => {
                        fill(manifold, contact, &world_from_tool, ball.radius, tool_first);
                    }
                    None => manifold.points.clear(),
                }
            }
        });
        Ok(())
    }

    fn contact_manifold_convex_convex(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
        _: Option<&dyn NormalConstraints>,
        _: Option<&dyn NormalConstraints>,
        _: Real,
        _: &mut ContactManifold,
    ) -> Result<(), Unsupported> {
        Err(Unsupported)
    }
}

fn fill(
    manifold: &mut ContactManifold,
    contact: &TrueContact,
    world_from_tool: &Pose,
    radius: f64,
    tool_first: bool,
) {
    let out_of_part = contact.normal;
    let out_of_tool = world_from_tool.rotation.inverse() * -contact.normal;
    // Both as far from where the surfaces meet, so that friction acts there.
    let half = 0.5 * contact.separation;
    let on_tool = out_of_tool * (radius - half);
    let on_part = world_from_tool.translation - out_of_part * (radius + half);
    let (normals, points) = if tool_first {
        ([out_of_tool, out_of_part], [on_tool, on_part])
    } else {
        ([out_of_part, out_of_tool], [on_part, on_tool])
    };
    [manifold.local_n1, manifold.local_n2] = normals;
    let feature = PackedFeatureId::face(0);
    let point = TrackedContact::new(points[0], points[1], feature, feature, contact.separation);
    match manifold.points.first_mut() {
        // Keeps the impulse that the solver starts from.
        Some(known) => known.copy_geometry_from(point),
        None => manifold.points.push(point),
    }
}

/// Queries that the step never asks.
#[rustfmt::skip] // A table: one query a line.
impl QueryDispatcher for TrueContacts {
    fn intersection_test(&self, _: &Pose, _: &dyn Shape, _: &dyn Shape) -> Result<ShapeIntersection, Unsupported> { Err(Unsupported) }
    fn distance(&self, _: &Pose, _: &dyn Shape, _: &dyn Shape) -> Result<ShapeDistance, Unsupported> { Err(Unsupported) }
    fn contact(&self, _: &Pose, _: &dyn Shape, _: &dyn Shape, _: Real) -> Result<Option<Contact>, Unsupported> { Err(Unsupported) }
    fn closest_points(&self, _: &Pose, _: &dyn Shape, _: &dyn Shape, _: Real) -> Result<ClosestPoints, Unsupported> { Err(Unsupported) }
    fn cast_shapes(&self, _: &Pose, _: DVec3, _: &dyn Shape, _: &dyn Shape, _: ShapeCastOptions) -> Result<Option<ShapeCastHit>, Unsupported> { Err(Unsupported) }
    fn cast_shapes_nonlinear(&self, _: &NonlinearRigidMotion, _: &dyn Shape, _: &NonlinearRigidMotion, _: &dyn Shape, _: Real, _: Real, _: bool) -> Result<Option<ShapeCastHit>, Unsupported> { Err(Unsupported) }
}
