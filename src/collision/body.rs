//! A body: what it moves with, and the solids that it consists of.

use glam::DVec3;
use glamx::DPose3;
use rapier3d::parry::partitioning::BvhNode;
use rapier3d::parry::query;
use rapier3d::parry::shape::{Shape, SharedShape, TriMesh, TriMeshFlags};

use crate::arm::VisualShape;
use crate::workpiece::TriangleMesh;

/// What a body moves with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mount {
    /// It stands in the world at a pose.
    World(DPose3),
    /// It moves with the link behind a joint of the chain, counted from 0.
    Link(usize),
}

impl Mount {
    /// Number of joints that move it.
    pub(super) fn joints(self) -> usize {
        match self {
            Self::World(_) => 0,
            Self::Link(joint) => joint + 1,
        }
    }

    /// Its pose, from those of the links.
    pub(super) fn pose(self, links: &[DPose3]) -> DPose3 {
        match self {
            Self::World(pose) => pose,
            Self::Link(joint) => links[joint],
        }
    }
}

/// A shape that encloses no volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("its points lie in a plane or closer, expected a shape that encloses a volume")]
pub struct SolidError;

/// A convex solid, or a closed surface.
#[derive(Clone)]
pub struct Solid {
    /// Its pose in the body's frame.
    pub body_from_solid: DPose3,
    pub(super) shape: SharedShape,
    /// Centre of a sphere about it, in the body's frame [m], and the sphere's radius [m].
    pub(super) centre: DVec3,
    pub(super) radius: f64,
    /// Opposite corners of a box about it, in its own frame [m].
    corners: [DVec3; 2],
}

impl Solid {
    /// A shape of an arm or a device at a pose in its body; of a mesh the convex hull.
    ///
    /// # Errors
    /// A mesh whose hull encloses no volume.
    pub fn convex(shape: &VisualShape, body_from_solid: DPose3) -> Result<Self, SolidError> {
        match shape {
            VisualShape::Box { size } => {
                let half = 0.5 * *size;
                Ok(Self::new(
                    SharedShape::cuboid(half.x, half.y, half.z),
                    body_from_solid,
                ))
            }
            VisualShape::Cylinder { radius, length } => {
                // Parry's cylinders stand along y.
                let upright = glam::DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
                Ok(Self::new(
                    SharedShape::cylinder(0.5 * length, *radius),
                    body_from_solid * DPose3::from_rotation(upright),
                ))
            }
            VisualShape::Sphere { radius } => {
                Ok(Self::new(SharedShape::ball(*radius), body_from_solid))
            }
            VisualShape::Mesh { vertices, .. } => {
                let hull = SharedShape::convex_hull(vertices).ok_or(SolidError)?;
                Ok(Self::new(hull, body_from_solid))
            }
        }
    }

    /// A box about its body's origin, of edge lengths [m].
    #[must_use]
    pub fn cuboid(size: DVec3) -> Self {
        let half = 0.5 * size;
        let shape = SharedShape::cuboid(half.x, half.y, half.z);
        Self::new(shape, DPose3::IDENTITY)
    }

    /// The closed surface of a part or an obstacle.
    ///
    /// # Errors
    /// No surface can be made of it.
    pub fn surface(mesh: &TriangleMesh) -> Result<Self, SolidError> {
        let (vertices, triangles) = (mesh.vertices().to_vec(), mesh.triangles().to_vec());
        let shape = SharedShape::trimesh_with_flags(vertices, triangles, TriMeshFlags::ORIENTED);
        Ok(Self::new(shape.map_err(|_| SolidError)?, DPose3::IDENTITY))
    }

    fn new(shape: SharedShape, body_from_solid: DPose3) -> Self {
        let sphere = shape.compute_local_bounding_sphere();
        let bounds = shape.compute_local_aabb();
        Self {
            centre: body_from_solid.transform_point(sphere.center),
            radius: sphere.radius,
            corners: [bounds.mins, bounds.maxs],
            body_from_solid,
            shape,
        }
    }

    /// Distance from another solid at poses [m]; a lower bound of it, no less than `enough`, where that is more.
    fn distance(&self, at: DPose3, other: &Self, other_at: DPose3, enough: f64) -> f64 {
        let (one, two) = (&*self.shape, &*other.shape);
        match (one.as_trimesh(), two.as_trimesh()) {
            (Some(mesh), None) => surface_distance(mesh, two, &(at.inverse() * other_at), enough),
            (None, Some(mesh)) => surface_distance(mesh, one, &(other_at.inverse() * at), enough),
            _ => query::distance(&at, one, &other_at, two)
                .map_or(f64::INFINITY, |found| found.distance),
        }
    }

    /// Distance of the box about this solid from the sphere about another [m], no more than theirs.
    fn apart_from(&self, at: DPose3, other: &Self, other_at: DPose3) -> f64 {
        let centre = other_at.transform_point(other.centre);
        let local = (at * self.body_from_solid)
            .inverse()
            .transform_point(centre);
        let outside = local - local.clamp(self.corners[0], self.corners[1]);
        outside.length() - other.radius
    }

    /// Whether it is a convex solid, filled, and not a surface.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.shape.as_trimesh().is_none()
    }

    /// Corners and triangles of its surface in the body's frame [m], for a picture or another program; of round shapes an inscribed one.
    #[must_use]
    pub fn triangles(&self) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        const STEPS: u32 = 24;
        let shape = &self.shape;
        let (points, triangles) = if let Some(hull) = shape.as_convex_polyhedron() {
            hull.to_trimesh()
        } else if let Some(cuboid) = shape.as_cuboid() {
            cuboid.to_trimesh()
        } else if let Some(cylinder) = shape.as_cylinder() {
            cylinder.to_trimesh(STEPS)
        } else if let Some(ball) = shape.as_ball() {
            ball.to_trimesh(STEPS, STEPS / 2)
        } else if let Some(mesh) = shape.as_trimesh() {
            (mesh.vertices().to_vec(), mesh.indices().to_vec())
        } else {
            (Vec::new(), Vec::new())
        };
        let pose = self.body_from_solid;
        let placed = points.into_iter().map(|point| pose.transform_point(point));
        (placed.collect(), triangles)
    }
}

/// Distance of a convex solid from a surface in whose frame it stands at a pose [m]; a lower bound of it, no less than `enough`, where that is more.
///
/// Parry itself asks of a node of the tree how far its box is from the solid's; of a solid that stands aslant that box is mostly empty, and all triangles
/// in it would be measured. The ball about a node is measured against the solid itself.
fn surface_distance(mesh: &TriMesh, solid: &dyn Shape, at: &DPose3, enough: f64) -> f64 {
    let box_of_solid = solid.compute_aabb(at);
    let from_node = |node: &BvhNode, least: f64| {
        let (low, high) = (node.mins(), node.maxs());
        let gap = (box_of_solid.mins - high).max(low - box_of_solid.maxs);
        let between = gap.max(DVec3::ZERO).length();
        if between >= least {
            return between;
        }
        let ball =
            solid.distance_to_point(at, 0.5 * (low + high), true) - 0.5 * (high - low).length();
        between.max(ball)
    };
    let from_triangle = |index: u32, _: f64| {
        let triangle = mesh.triangle(index);
        query::distance(&DPose3::IDENTITY, &triangle, at, solid)
            .ok()
            .map(|found| found.distance)
    };
    let best = mesh.bvh().find_best(enough, from_node, from_triangle);
    best.map_or(enough, |(_, distance)| distance)
}

/// A body.
#[derive(Clone)]
pub struct Body {
    /// Its name for people: a link's, `device`, `tool`, `part`, an obstacle's.
    pub name: String,
    /// What it moves with.
    pub mount: Mount,
    /// Its solids.
    pub solids: Vec<Solid>,
}

impl Body {
    /// Distance of two bodies at poses [m], zero where they meet; a lower bound of it where that is more than `enough`.
    pub(super) fn distance(&self, at: DPose3, other: &Self, other_at: DPose3, enough: f64) -> f64 {
        let mut least = f64::INFINITY;
        for one in &self.solids {
            for two in &other.solids {
                let apart = at.transform_point(one.centre) - other_at.transform_point(two.centre);
                let mut bound = apart.length() - one.radius - two.radius;
                if bound <= enough.min(least) {
                    let boxes = [
                        one.apart_from(at, two, other_at),
                        two.apart_from(other_at, one, at),
                    ];
                    bound = bound.max(boxes[0]).max(boxes[1]);
                }
                if bound > enough || bound > least {
                    least = least.min(bound);
                    continue;
                }
                let poses = [at * one.body_from_solid, other_at * two.body_from_solid];
                least = least.min(one.distance(poses[0], two, poses[1], least.min(enough)));
            }
        }
        least
    }

    /// Depth by which two bodies at poses reach into each other [m]; negative for their distance where that is below `reach`, none farther apart.
    pub(super) fn depth(
        &self,
        at: DPose3,
        other: &Self,
        other_at: DPose3,
        reach: f64,
    ) -> Option<f64> {
        let mut deepest: Option<f64> = None;
        for one in &self.solids {
            for two in &other.solids {
                let poses = [at * one.body_from_solid, other_at * two.body_from_solid];
                let contact = query::contact(&poses[0], &*one.shape, &poses[1], &*two.shape, reach);
                let depth = contact.ok().flatten().map(|contact| -contact.dist);
                deepest = match (deepest, depth) {
                    (Some(most), Some(depth)) => Some(most.max(depth)),
                    (most, depth) => most.or(depth),
                };
            }
        }
        deepest
    }

    /// Whether a body lies wholly within this one's surfaces, which is not seen by the distance from them.
    pub(super) fn encloses(&self, at: DPose3, other: &Self, other_at: DPose3) -> bool {
        let closed = self
            .solids
            .iter()
            .filter(|solid| solid.shape.as_trimesh().is_some());
        closed.into_iter().any(|solid| {
            let from_world = (at * solid.body_from_solid).inverse();
            other.solids.iter().any(|inner| {
                let point = from_world.transform_point(other_at.transform_point(inner.centre));
                let [low, high] = solid.corners;
                // Most lie outside its box, and a surface is looked through for its nearest point.
                let in_box = (point.cmpge(low) & point.cmple(high)).all();
                in_box && solid.shape.contains_local_point(point)
            })
        })
    }

    /// A sphere about all of it: its centre in the body's frame and its radius [m].
    pub(super) fn sphere(&self) -> (DVec3, f64) {
        let sum = self.solids.iter().map(|solid| solid.centre).sum::<DVec3>();
        let centre = sum / self.solids.len().max(1) as f64;
        let reaches = self.solids.iter();
        let reaches = reaches.map(|solid| (solid.centre - centre).length() + solid.radius);
        (centre, reaches.fold(0.0, f64::max))
    }

    /// Farthest of its points from its own frame's origin [m], no less.
    pub(super) fn extent(&self) -> f64 {
        let reaches = self
            .solids
            .iter()
            .map(|solid| solid.centre.length() + solid.radius);
        reaches.fold(0.0, f64::max)
    }

    /// Lowest and highest of its points along a direction, standing at a pose [m], no farther in.
    pub fn span(&self, at: DPose3, direction: DVec3) -> [f64; 2] {
        self.solids
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], solid| {
                let bounds = solid.shape.compute_aabb(&(at * solid.body_from_solid));
                let (middle, half) = (bounds.center(), bounds.half_extents());
                let (middle, half) = (middle.dot(direction), half.dot(direction.abs()));
                [low.min(middle - half), high.max(middle + half)]
            })
    }
}
