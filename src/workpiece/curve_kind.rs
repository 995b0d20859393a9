//! Tells straight edges and circular arcs from other chains of points.

use std::f64::consts::TAU;

use glam::DVec3;

/// Points may lie this far off the ideal shape [m]: more than 32-bit coordinates round, less than
/// matters to a tool.
const TOLERANCE: f64 = 2e-6;

/// Fewest points that make an arc; any three lie on a circle.
const ARC_POINTS: usize = 4;

/// Shape of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CurveKind {
    /// All points on a line.
    Straight,
    /// All points on a circle; a closed curve is the full circle.
    Arc {
        /// Radius [m].
        radius: f64,
        /// Angle about the centre [rad].
        angle: f64,
    },
    /// Anything else.
    Polyline,
}

/// The kind of a chain of this length [m].
pub(crate) fn classify(points: &[DVec3], closed: bool, length: f64) -> CurveKind {
    if !closed && is_straight(points) {
        return CurveKind::Straight;
    }
    if points.len() >= ARC_POINTS
        && let Some((centre, radius)) = circle(points, closed)
        && points
            .iter()
            .all(|point| (point.distance(centre) - radius).abs() < TOLERANCE)
    {
        let swept: f64 = points
            .windows(2)
            .map(|pair| (pair[0] - centre).angle_between(pair[1] - centre))
            .sum();
        let angle = if closed { TAU } else { swept };
        // Points that hop about on a circle are no arc.
        if (radius * angle - length).abs() < 0.1 * length {
            return CurveKind::Arc { radius, angle };
        }
    }
    CurveKind::Polyline
}

fn is_straight(points: &[DVec3]) -> bool {
    let (first, last) = (points[0], points[points.len() - 1]);
    let Some(direction) = (last - first).try_normalize() else {
        return false;
    };
    points
        .iter()
        .all(|&point| (point - first).reject_from_normalized(direction).length() < TOLERANCE)
}

/// Centre and radius of the circle through three spread points, if all points lie in its plane.
fn circle(points: &[DVec3], closed: bool) -> Option<(DVec3, f64)> {
    let count = points.len();
    let [a, b, c] = if closed {
        [0, count / 3, 2 * count / 3]
    } else {
        [0, count / 2, count - 1]
    }
    .map(|index| points[index]);
    let (to_b, to_c) = (b - a, c - a);
    let axis = to_b.cross(to_c);
    let normal = axis.try_normalize()?;
    if points
        .iter()
        .any(|&point| (point - a).dot(normal).abs() > TOLERANCE)
    {
        return None;
    }
    let to_centre = (to_b.length_squared() * to_c - to_c.length_squared() * to_b).cross(axis)
        / (2.0 * axis.length_squared());
    Some((a + to_centre, to_centre.length()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn arc(radius: f64, angle: f64, count: usize) -> Vec<DVec3> {
        let tilt = DQuat::from_rotation_x(0.7) * DQuat::from_rotation_y(-0.3);
        (0..count)
            .map(|i| {
                let (sin, cos) = (angle * i as f64 / (count - 1) as f64).sin_cos();
                tilt * DVec3::new(radius * cos, radius * sin, 0.01) + DVec3::new(0.1, 0.2, 0.3)
            })
            .collect()
    }

    fn length(points: &[DVec3]) -> f64 {
        points
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .sum()
    }

    #[test]
    fn arcs_are_measured() {
        let points = arc(0.02, 1.4, 60);
        let CurveKind::Arc { radius, angle } = classify(&points, false, length(&points)) else {
            panic!("not an arc");
        };
        assert!((radius - 0.02).abs() < 1e-9);
        assert!((angle - 1.4).abs() < 1e-9);
    }

    #[test]
    fn near_arcs_and_near_lines_are_neither() {
        let mut points = arc(0.02, 1.4, 60);
        points[20] *= 1.0 + 1e-4;
        assert_eq!(
            classify(&points, false, length(&points)),
            CurveKind::Polyline
        );
        let line = |bend: f64| vec![DVec3::ZERO, DVec3::new(0.05, bend, 0.0), DVec3::X * 0.1];
        assert_eq!(classify(&line(1e-7), false, 0.1), CurveKind::Straight);
        assert_eq!(classify(&line(1e-4), false, 0.1), CurveKind::Polyline);
        // The corners of a square lie on a circle.
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        assert_eq!(classify(&square, true, 4.0), CurveKind::Polyline);
    }
}
