//! An edge of a part as a chain of straight segments with the normals of both faces along it.
//!
//! Orientation: the face of `normal_a` lies on the left of the tangent, seen from outside the part.
//! So the tangent is along `normal_a x normal_b` on a convex edge, and against it on a concave one.

use glam::DVec3;

use super::curve_kind::classify;
use super::error::{WorkpieceError, require};

pub use super::curve_kind::CurveKind;

/// Normals that differ by more across a vertex belong to different faces [rad].
const SMOOTH_JOINT: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// Whether an edge sticks out of the part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Convexity {
    /// Everywhere an outer edge: a burr can be reached.
    Convex,
    /// Everywhere an inner corner.
    Concave,
    /// Both occur along the curve.
    Mixed,
}

/// A chain of mesh edges.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeCurve {
    /// Name in an [`super::EdgeList`]: `edge-N` or `loop-N`.
    pub id: String,
    /// Smooth face on the left at the start (the face that a loop bounds), counted from 0.
    pub patch: u32,
    /// Vertices in order in the part frame [m]; a closed curve does not repeat its first.
    pub points: Vec<DVec3>,
    /// Whether a last segment runs from the last point to the first.
    pub closed: bool,
    /// Outward unit normals of the left and the right face, for each segment.
    pub normals: Vec<(DVec3, DVec3)>,
    /// Whether the edge sticks out.
    pub convexity: Convexity,
    /// Length [m].
    pub length: f64,
    /// Shape.
    pub kind: CurveKind,
    /// Indices of the points where the curve turns sharply, increasing.
    pub corners: Vec<usize>,
    /// Path length at each point, and the whole length at the end [m].
    stations: Vec<f64>,
    /// For each point whether direction and normals pass smoothly through it.
    smooth: Vec<bool>,
}

/// A place on an edge, in the part frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// Position [m].
    pub point: DVec3,
    /// Unit direction of increasing path length.
    pub tangent: DVec3,
    /// Outward unit normal of the left face.
    pub normal_a: DVec3,
    /// Outward unit normal of the right face.
    pub normal_b: DVec3,
    /// Unit vector half-way between the normals, away from the part.
    pub bisector: DVec3,
}

/// Parts of a curve; see the fields of [`EdgeCurve`].
pub(crate) struct CurveParts {
    pub(crate) id: String,
    pub(crate) patch: u32,
    pub(crate) points: Vec<DVec3>,
    pub(crate) closed: bool,
    pub(crate) normals: Vec<(DVec3, DVec3)>,
    pub(crate) convexity: Convexity,
    pub(crate) corners: Vec<usize>,
}

impl EdgeCurve {
    /// At least one segment of non-zero length; `normals` holds one pair for each segment.
    pub(crate) fn new(parts: CurveParts) -> Self {
        let CurveParts {
            id,
            patch,
            points,
            closed,
            normals,
            convexity,
            corners,
        } = parts;
        let mut stations = vec![0.0];
        let mut length = 0.0;
        for segment in 0..normals.len() {
            length += points[segment].distance(points[(segment + 1) % points.len()]);
            stations.push(length);
        }
        let kind = classify(&points, closed, length);
        let mut curve = Self {
            id,
            patch,
            points,
            closed,
            normals,
            convexity,
            length,
            kind,
            corners,
            stations,
            smooth: Vec::new(),
        };
        curve.smooth = (0..curve.points.len())
            .map(|point| curve.is_smooth_at(point))
            .collect();
        curve
    }

    /// Path length at each point [m].
    pub fn stations(&self) -> &[f64] {
        &self.stations[..self.points.len()]
    }

    /// Path length at each corner [m].
    pub fn corner_stations(&self) -> Vec<f64> {
        self.corners
            .iter()
            .map(|&corner| self.stations[corner])
            .collect()
    }

    /// Angle by which the direction turns at a point [rad]; 0 at the ends of an open curve.
    pub fn turn(&self, point: usize) -> f64 {
        self.segments_at(point).map_or(0.0, |(before, after)| {
            self.direction(before).angle_between(self.direction(after))
        })
    }

    /// Angle between the two faces of a segment [rad]: of the part's material at a convex edge, of the free space at a concave one.
    /// Pi on a flat face, less the sharper the edge.
    pub fn angle_between_faces(&self, segment: usize) -> f64 {
        let (normal_a, normal_b) = self.normals[segment];
        std::f64::consts::PI - normal_a.angle_between(normal_b)
    }

    /// The smallest and the largest of these angles [rad].
    pub fn face_angle_range(&self) -> [f64; 2] {
        let angles = (0..self.normals.len()).map(|segment| self.angle_between_faces(segment));
        angles.fold([f64::INFINITY, 0.0], |[low, high], angle| {
            [low.min(angle), high.max(angle)]
        })
    }

    /// The place at path length `position` [m]. Beyond its ends an open curve holds them; a closed
    /// curve is periodic.
    ///
    /// `point` lies on the mesh edge. Direction and normals belong to the segment, but pass linearly
    /// from one to the next about a vertex without corner, over at most half a segment on either
    /// side, so that the facets of an arc do not make them jump.
    pub fn at(&self, position: f64) -> EdgePoint {
        let position = if self.closed {
            position.rem_euclid(self.length)
        } else {
            position.clamp(0.0, self.length)
        };
        let segment = self.segment_at(position);
        let along = position - self.stations[segment];
        let rest = self.stations[segment + 1] - position;
        let point = self
            .start(segment)
            .lerp(self.end(segment), along / (along + rest));
        let here = self.frame(segment);
        let [tangent, normal_a, normal_b] = match self.neighbour_share(segment, along, rest) {
            Some((neighbour, share)) => {
                let other = self.frame(neighbour);
                [0, 1, 2].map(|i| here[i].lerp(other[i], share).normalize_or(here[i]))
            }
            None => here,
        };
        EdgePoint {
            point,
            tangent,
            normal_a,
            normal_b,
            bisector: (normal_a + normal_b).normalize_or(normal_a),
        }
    }

    /// The same edge run the other way; the faces of `normal_a` and `normal_b` change places.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let count = self.points.len();
        let mut points = self.points.clone();
        points.reverse();
        let mut normals: Vec<_> = self.normals.iter().map(|&(a, b)| (b, a)).collect();
        normals.reverse();
        let mut corners: Vec<usize> = self.corners.iter().map(|&i| count - 1 - i).collect();
        if self.closed {
            // Keep the starting point.
            points.rotate_right(1);
            corners = corners.iter().map(|&i| (i + 1) % count).collect();
        }
        corners.sort_unstable();
        self.rebuilt(points, self.closed, normals, corners)
    }

    /// The part from path length `start` to `end` [m] as an open curve. On a closed curve `end` may
    /// lie up to one length beyond `start`, past the seam.
    ///
    /// # Errors
    /// The ends do not lie on the curve, or not in this order.
    pub fn trim(&self, start: f64, end: f64) -> Result<Self, WorkpieceError> {
        let last = if self.closed {
            start + self.length
        } else {
            self.length
        };
        require(
            "start of the trimmed edge [m]",
            start,
            (0.0..self.length).contains(&start),
            &format!("at least 0 and less than the length {}", self.length),
        )?;
        // A caller that adds up lengths may miss the end by a rounding.
        let end = if (end - last).abs() <= 1e-9 {
            last
        } else {
            end
        };
        require(
            "end of the trimmed edge [m]",
            end,
            end > start && end <= last,
            &format!("more than the start {start}, at most {last}"),
        )?;
        let count = self.normals.len();
        let mut segment = self.segment_at(start);
        let mut offset = 0.0;
        let mut points = vec![self.at(start).point];
        let mut normals = Vec::new();
        let mut corners = Vec::new();
        loop {
            normals.push(self.normals[segment]);
            let station = self.stations[segment + 1] + offset;
            // A vertex at the very end closes the curve; a shorter rest is not a segment.
            if station >= end - 1e-12 {
                points.push(self.at(end - offset).point);
                break;
            }
            if segment + 1 == count {
                offset += self.length;
            }
            segment = (segment + 1) % count;
            if self.corners.binary_search(&segment).is_ok() {
                corners.push(points.len());
            }
            points.push(self.start(segment));
        }
        Ok(self.rebuilt(points, false, normals, corners))
    }

    /// The same closed curve begun at path length `start` [m].
    ///
    /// # Errors
    /// The curve is open, or `start` does not lie on it.
    pub fn started_at(&self, start: f64) -> Result<Self, WorkpieceError> {
        require(
            "number of free ends of a curve that is to start elsewhere",
            if self.closed { 0.0 } else { 2.0 },
            self.closed,
            "0 (a closed curve)",
        )?;
        let mut open = self.trim(start, start + self.length)?;
        open.points.pop();
        let segment = self.segment_at(start);
        if self.stations[segment] == start && self.corners.binary_search(&segment).is_ok() {
            open.corners.insert(0, 0);
        }
        Ok(self.rebuilt(open.points, true, open.normals, open.corners))
    }

    fn rebuilt(
        &self,
        points: Vec<DVec3>,
        closed: bool,
        normals: Vec<(DVec3, DVec3)>,
        corners: Vec<usize>,
    ) -> Self {
        Self::new(CurveParts {
            id: self.id.clone(),
            patch: self.patch,
            points,
            closed,
            normals,
            convexity: self.convexity,
            corners,
        })
    }

    fn start(&self, segment: usize) -> DVec3 {
        self.points[segment]
    }

    fn end(&self, segment: usize) -> DVec3 {
        self.points[(segment + 1) % self.points.len()]
    }

    fn direction(&self, segment: usize) -> DVec3 {
        (self.end(segment) - self.start(segment)).normalize_or_zero()
    }

    fn frame(&self, segment: usize) -> [DVec3; 3] {
        let (normal_a, normal_b) = self.normals[segment];
        [self.direction(segment), normal_a, normal_b]
    }

    /// The segment that holds a path length within the curve.
    fn segment_at(&self, position: f64) -> usize {
        let after = self
            .stations
            .partition_point(|&station| station <= position);
        after.saturating_sub(1).min(self.normals.len() - 1)
    }

    /// The segments before and after a point.
    fn segments_at(&self, point: usize) -> Option<(usize, usize)> {
        let count = self.normals.len();
        if self.closed {
            return Some(((point + count - 1) % count, point));
        }
        (point > 0 && point < count).then(|| (point - 1, point))
    }

    fn is_smooth_at(&self, point: usize) -> bool {
        let Some((before, after)) = self.segments_at(point) else {
            return false;
        };
        let (before, after) = (self.frame(before), self.frame(after));
        self.corners.binary_search(&point).is_err()
            && (0..3).all(|i| before[i].angle_between(after[i]) < SMOOTH_JOINT)
    }

    /// The neighbouring segment whose frame counts here, and its share from 0 to 1/2.
    fn neighbour_share(&self, segment: usize, along: f64, rest: f64) -> Option<(usize, f64)> {
        let nearer_start = along < rest;
        let point = if nearer_start {
            segment
        } else {
            (segment + 1) % self.points.len()
        };
        if !self.smooth[point] {
            return None;
        }
        let (before, after) = self.segments_at(point)?;
        let neighbour = if nearer_start { before } else { after };
        let neighbour_length = self.stations[neighbour + 1] - self.stations[neighbour];
        let window = 0.5 * neighbour_length.min(along + rest);
        let distance = along.min(rest);
        (distance < window).then(|| (neighbour, 0.5 * (1.0 - distance / window)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    /// The rim of a disc of radius 1 in the plane z = 0, counter-clockwise, wall downwards.
    fn rim(facets: usize) -> EdgeCurve {
        let at = |i: f64| {
            let (sin, cos) = (TAU * i / facets as f64).sin_cos();
            DVec3::new(cos, sin, 0.0)
        };
        EdgeCurve::new(CurveParts {
            id: "loop-0".into(),
            patch: 0,
            points: (0..facets).map(|i| at(i as f64)).collect(),
            closed: true,
            normals: (0..facets)
                .map(|i| (DVec3::Z, at(i as f64 + 0.5)))
                .collect(),
            convexity: Convexity::Convex,
            corners: Vec::new(),
        })
    }

    /// The outline of a unit square in the plane z = 0.
    fn square() -> EdgeCurve {
        EdgeCurve::new(CurveParts {
            id: "loop-1".into(),
            patch: 0,
            points: vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y],
            closed: true,
            normals: [DVec3::NEG_Y, DVec3::X, DVec3::Y, DVec3::NEG_X]
                .map(|side| (DVec3::Z, side))
                .to_vec(),
            convexity: Convexity::Convex,
            corners: vec![0, 1, 2, 3],
        })
    }

    #[test]
    fn rim_normals_follow_the_true_circle() {
        let rim = rim(240);
        assert!(matches!(rim.kind, CurveKind::Arc { radius, angle }
            if (radius - 1.0).abs() < 1e-12 && (angle - TAU).abs() < 1e-12));
        let facet = TAU / 240.0;
        let mut last = rim.at(0.0).normal_b;
        for sample in 0..=5000 {
            let angle = TAU * f64::from(sample) / 5000.0;
            let place = rim.at(angle / TAU * rim.length);
            let (sin, cos) = angle.sin_cos();
            assert!(place.normal_b.distance(DVec3::new(cos, sin, 0.0)) < 1e-4);
            assert!(place.tangent.distance(DVec3::new(-sin, cos, 0.0)) < 1e-4);
            assert!(place.normal_a.cross(place.normal_b).distance(place.tangent) < 1e-4);
            // A step of 0.05 facets may turn the normal by little more than 0.05 facets.
            assert!(place.normal_b.distance(last) < 0.06 * facet);
            last = place.normal_b;
            assert!((place.bisector.z - 0.5_f64.sqrt()).abs() < 1e-9);
        }
    }

    #[test]
    fn corners_are_not_smoothed() {
        let square = square();
        assert_eq!(square.length, 4.0);
        assert_eq!(square.kind, CurveKind::Polyline);
        assert_eq!(square.corner_stations(), [0.0, 1.0, 2.0, 3.0]);
        assert!((square.turn(2) - FRAC_PI_2).abs() < 1e-12);
        let before = square.at(1.0 - 1e-9);
        let after = square.at(1.0 + 1e-9);
        assert_eq!(before.tangent, DVec3::X);
        assert_eq!(after.tangent, DVec3::Y);
        assert_eq!(after.normal_b, DVec3::X);
        assert!(
            after
                .bisector
                .distance(DVec3::new(1.0, 0.0, 1.0) / 2.0_f64.sqrt())
                < 1e-15
        );
        assert_eq!(square.at(4.25), square.at(0.25));
        assert_eq!(square.at(-0.25), square.at(3.75));
    }

    #[test]
    fn reversing_keeps_the_places() {
        for curve in [square(), rim(24), square().trim(0.25, 2.5).unwrap()] {
            let reversed = curve.reversed();
            for sample in 0..=97 {
                let position = curve.length * f64::from(sample) / 97.0;
                let (here, there) = (curve.at(position), reversed.at(curve.length - position));
                assert!(here.point.distance(there.point) < 1e-12);
                if curve
                    .corner_stations()
                    .iter()
                    .all(|s| (s - position).abs() > 1e-9)
                    && sample % 97 != 0
                {
                    assert!(here.tangent.distance(-there.tangent) < 1e-9);
                    assert!(here.normal_a.distance(there.normal_b) < 1e-9);
                }
            }
            let twice = reversed.reversed();
            assert_eq!(twice.points, curve.points);
            assert_eq!(twice.normals, curve.normals);
            assert_eq!(twice.corners, curve.corners);
        }
    }

    #[test]
    fn trimming_keeps_the_places_and_corners() {
        let square = square();
        let part = square.trim(3.5, 5.25).unwrap();
        assert!(!part.closed);
        assert!((part.length - 1.75).abs() < 1e-12);
        assert_eq!(part.corner_stations(), [0.5, 1.5]);
        for sample in 0..=40 {
            let position = 1.75 * f64::from(sample) / 40.0;
            assert!(
                part.at(position)
                    .point
                    .distance(square.at(3.5 + position).point)
                    < 1e-12
            );
        }
        let side = square.trim(1.0, 2.0).unwrap();
        assert_eq!(side.kind, CurveKind::Straight);
        assert_eq!(side.points, [DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
        let quarter = rim(240).trim(0.0, rim(240).length / 4.0).unwrap();
        assert!(matches!(quarter.kind, CurveKind::Arc { radius, angle }
            if (radius - 1.0).abs() < 1e-9 && (angle - PI / 2.0).abs() < 1e-9));
        for (start, end) in [
            (-0.1, 1.0),
            (1.0, 1.0),
            (1.0, 5.1),
            (4.0, 4.5),
            (0.0, f64::NAN),
        ] {
            assert!(square.trim(start, end).is_err(), "{start} {end}");
        }
        assert!(side.trim(0.5, 1.5).is_err());
    }

    #[test]
    fn closed_curve_can_start_elsewhere() {
        let moved = square().started_at(0.5).unwrap();
        assert!(moved.closed);
        assert_eq!(moved.points.len(), 5);
        assert_eq!(moved.corner_stations(), [0.5, 1.5, 2.5, 3.5]);
        assert!((moved.length - 4.0).abs() < 1e-12);
        let corner = square().started_at(2.0).unwrap();
        assert_eq!(corner.corner_stations(), [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(corner.points[0], DVec3::new(1.0, 1.0, 0.0));
        assert!(square().trim(0.0, 1.0).unwrap().started_at(0.5).is_err());
    }
}
