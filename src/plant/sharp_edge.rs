//! A ball on a sharp edge of a part, as the part's faces have it.
//!
//! ```text
//! d = r - |q|,     n = q/|q|          q from the nearest point of the edge to the ball's centre, between the normals of the two faces
//! d = r - n_f . q                     beyond one of them: the ball stands on that face
//! ```
//!
//! The nearest point of a convex part to a point outside of it (Ericson, Real-Time Collision Detection, 2005, sec. 5.1), for the part whose only features
//! near the ball are a chain of straight edges and the two faces of each.

use glam::DVec3;

/// A point of the followed edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeStation {
    /// Where it is [m].
    pub point: DVec3,
    /// Direction of the edge [1].
    pub tangent: DVec3,
    /// Outward bisector of the faces [1].
    pub bisector: DVec3,
    /// Distance along the edge from its start [m].
    pub station: f64,
}

/// An edge as a chain of straight segments in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct SharpEdge {
    points: Vec<DVec3>,
    /// Outward normals of both faces of each segment [1].
    normals: Vec<[DVec3; 2]>,
    /// Distance along the edge of each point [m].
    stations: Vec<f64>,
}

/// Where a ball touches an edge, or would.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeTouch {
    /// Nearest point of the edge [m].
    pub point: DVec3,
    /// From the part to the ball's centre [1].
    pub normal: DVec3,
    /// Distance of the ball's centre from the part [m].
    pub distance: f64,
    /// Where on the edge [m].
    pub station: f64,
}

/// Length of edge on either side of where the ball should be in which it is sought [m].
const SOUGHT: f64 = 0.02;

impl SharpEdge {
    /// From points with the distances along the edge, and the normals of the faces of each segment between them.
    pub fn new(points: Vec<DVec3>, stations: Vec<f64>, normals: Vec<[DVec3; 2]>) -> Self {
        Self {
            points,
            normals,
            stations,
        }
    }

    /// Where a ball with its centre there [m] touches, near a distance along the edge [m].
    pub fn touch(&self, centre: DVec3, near: f64) -> EdgeTouch {
        let first = self.stations.partition_point(|s| *s < near - SOUGHT);
        let last = self.stations.partition_point(|s| *s <= near + SOUGHT);
        let segments = self.normals.len();
        let from = first.saturating_sub(1).min(segments - 1);
        let to = last.clamp(from + 1, segments);
        let mut best = (f64::INFINITY, from, 0.0);
        for segment in from..to {
            let (start, end) = (self.points[segment], self.points[segment + 1]);
            let along = end - start;
            // The first and the last go on: the ball may stand a little beyond.
            let low = if segment == 0 { f64::NEG_INFINITY } else { 0.0 };
            let high = if segment + 1 == segments {
                f64::INFINITY
            } else {
                1.0
            };
            let share = ((centre - start).dot(along) / along.length_squared()).clamp(low, high);
            let away = (centre - start - along * share).length_squared();
            if away < best.0 {
                best = (away, segment, share);
            }
        }
        let (_, segment, share) = best;
        let [start, end] = [segment, segment + 1].map(|i| self.points[i]);
        let point = start + (end - start) * share;
        let stations = [segment, segment + 1].map(|i| self.stations[i]);
        let out = centre - point;
        let (normal, distance) = self.on_faces(segment, out);
        EdgeTouch {
            point,
            normal,
            distance,
            station: stations[0] + share * (stations[1] - stations[0]),
        }
    }

    /// Normal and distance for a way out of the nearest point of the edge.
    fn on_faces(&self, segment: usize, out: DVec3) -> (DVec3, f64) {
        let [a, b] = self.normals[segment];
        let along = (self.points[segment + 1] - self.points[segment]).normalize_or(DVec3::X);
        // In each face, away from the edge.
        let into = |face: DVec3, other: DVec3| {
            let way = along.cross(face);
            if way.dot(other) < 0.0 { way } else { -way }
        };
        for (face, other) in [(a, b), (b, a)] {
            if out.dot(into(face, other)) > 0.0 {
                return (face, out.dot(face));
            }
        }
        let distance = out.length();
        (out.normalize_or((a + b).normalize_or(a)), distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An edge along x whose faces look to +z and -y.
    fn edge() -> SharpEdge {
        let points = vec![DVec3::ZERO, DVec3::X * 0.05, DVec3::X * 0.1];
        SharpEdge::new(points, vec![0.0, 0.05, 0.1], vec![[DVec3::Z, -DVec3::Y]; 2])
    }

    #[test]
    fn above_the_bisector_the_normal_is_the_bisector_and_beside_it_it_turns() {
        let bisector = DVec3::new(0.0, -1.0, 1.0).normalize();
        let lateral = DVec3::new(0.0, 1.0, 1.0).normalize();
        let touch = edge().touch(DVec3::X * 0.03 + bisector * 4e-3, 0.03);
        assert!((touch.normal - bisector).length() < 1e-12);
        assert!((touch.distance - 4e-3).abs() < 1e-15);
        assert!((touch.station - 0.03).abs() < 1e-12);
        let centre = DVec3::X * 0.07 + bisector * 4e-3 + lateral * 5e-4;
        let touch = edge().touch(centre, 0.06);
        let turned = (5e-4f64 / 4e-3).atan();
        assert!((touch.normal.dot(lateral) - turned.sin()).abs() < 1e-12);
        assert!((touch.distance - 4e-3f64.hypot(5e-4)).abs() < 1e-15);
    }

    #[test]
    fn beyond_the_normals_of_the_faces_the_ball_rests_on_a_face() {
        let touch = edge().touch(DVec3::new(0.03, 2e-3, 4e-3), 0.03);
        assert_eq!(touch.normal, DVec3::Z);
        assert!((touch.distance - 4e-3).abs() < 1e-15);
        let touch = edge().touch(DVec3::new(0.03, -4e-3, -1e-3), 0.03);
        assert_eq!(touch.normal, -DVec3::Y);
    }

    #[test]
    fn at_a_corner_the_normal_fans_out_about_it() {
        let points = vec![DVec3::ZERO, DVec3::X * 0.05, DVec3::new(0.05, 0.05, 0.0)];
        let normals = vec![[DVec3::Z, -DVec3::Y], [DVec3::Z, DVec3::X]];
        let edge = SharpEdge::new(points, vec![0.0, 0.05, 0.1], normals);
        let out = DVec3::new(1.0, -1.0, 2.0).normalize() * 4e-3;
        let touch = edge.touch(DVec3::X * 0.05 + out, 0.05);
        assert!((touch.distance - 4e-3).abs() < 1e-12);
        assert!((touch.point - DVec3::X * 0.05).length() < 1e-12);
    }
}
