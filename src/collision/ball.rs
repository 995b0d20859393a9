//! The tool's ball against the part: it rides on one edge, and may touch nothing else of it.

use std::sync::Arc;

use glam::DVec3;
use glamx::DPose3;

use crate::workpiece::{ContactSurface, EdgeCurve, SurfaceContact, TriangleMesh};

/// Distance from the ridden edge within which a contact is that of riding it, of the ball's radius [1].
pub const RIDDEN_ZONE: f64 = 0.5;
/// Depth to which the ball may reach into what it does not ride, of its radius [1]: another edge a little way off is met by deburring tools that do their work.
pub(super) const ALLOWED: f64 = 0.1;

/// Distance up to which contacts are looked for [m]; beyond it a bound does.
const REACH: f64 = 0.02;

/// The ball, the part and the edge of it that is ridden.
#[derive(Debug, Clone)]
pub struct RiddenEdge {
    surface: Arc<ContactSurface>,
    /// Points of the edge in the part's frame [m], the first again at the end of a closed one.
    points: Arc<[DVec3]>,
    pub(super) world_from_part: DPose3,
    /// Centre of the ball in the frame of the slide's link [m].
    pub(super) centre: DVec3,
    /// Its radius [m].
    pub(super) radius: f64,
}

impl RiddenEdge {
    /// A ball of a radius [m] about a centre in the slide's frame [m], on an edge of a part in the part's frame.
    #[must_use]
    pub fn new(
        part: &TriangleMesh,
        edge: &EdgeCurve,
        world_from_part: DPose3,
        (centre, radius): (DVec3, f64),
    ) -> Self {
        let mut points = edge.points.clone();
        if edge.closed {
            points.extend(edge.points.first());
        }
        Self {
            surface: Arc::new(ContactSurface::new(part)),
            points: points.into(),
            world_from_part,
            centre,
            radius,
        }
    }

    /// Distance of the ball from what it does not ride [m], negative where it reaches into it; no more than `reach`.
    pub(super) fn distance(&self, world_from_slide: DPose3, reach: f64) -> f64 {
        let reach = reach.min(REACH);
        let centre = world_from_slide.transform_point(self.centre);
        let centre = self.world_from_part.inverse().transform_point(centre);
        let mut contacts: Vec<SurfaceContact> = Vec::new();
        self.surface
            .genuine_contacts(centre, self.radius + reach, &mut contacts);
        let elsewhere = contacts
            .iter()
            .filter(|contact| self.distance_to_edge(contact.point) > RIDDEN_ZONE * self.radius);
        elsewhere
            .map(|contact| contact.distance - self.radius)
            .fold(reach, f64::min)
    }

    fn distance_to_edge(&self, point: DVec3) -> f64 {
        let pieces = self.points.windows(2).map(|two| {
            let along = two[1] - two[0];
            let share = (point - two[0]).dot(along) / along.length_squared().max(1e-300);
            (point - two[0] - along * share.clamp(0.0, 1.0)).length()
        });
        pieces.fold(f64::INFINITY, f64::min)
    }
}
