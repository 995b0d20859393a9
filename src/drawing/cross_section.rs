//! How the tool stands to an edge: the part cut across it, seen along the direction of travel, so that the left face is on the left.

use glam::{DVec2, DVec3};

use super::svg::Svg;

/// Size of the picture [pixel].
const SIZE: [usize; 2] = [420, 410];
/// Where the edge is in it [pixel].
const EDGE: DVec2 = DVec2::new(210.0, 235.0);
/// Lengths of a face, of the tool, of the bisector and of gravity's arrow, and the ball's radius [pixel].
const FACE: f64 = 95.0;
const TOOL: f64 = 165.0;
const BISECTOR: f64 = 175.0;
const GRAVITY: f64 = 60.0;
const BALL: f64 = 22.0;

/// An edge, its faces and the tool, in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossSection {
    /// Direction of travel.
    pub tangent: DVec3,
    /// Outward normal of the left face and of the right one.
    pub normals: [DVec3; 2],
    /// Outward bisector.
    pub bisector: DVec3,
    /// The tool's axis, towards the part.
    pub axis: DVec3,
    /// Gravity.
    pub gravity: DVec3,
}

/// The picture as SVG.
#[must_use]
pub fn cross_section(section: &CrossSection) -> String {
    let right = section.tangent.cross(section.bisector);
    let flat =
        |direction: DVec3| DVec2::new(direction.dot(right), -direction.dot(section.bisector));
    let mut svg = Svg::plain(SIZE, "The tool across the edge");
    let faces = section.normals.map(|normal| {
        let along = section.tangent.cross(normal);
        let into = if along.dot(section.bisector) < 0.0 {
            along
        } else {
            -along
        };
        FACE * flat(into).normalize_or(DVec2::Y)
    });
    svg.polygon(
        &[
            EDGE,
            EDGE + faces[0],
            EDGE + faces[0] + faces[1],
            EDGE + faces[1],
        ],
        "#96a5b2",
    );
    for (face, word) in faces.iter().zip(["left face", "right face"]) {
        svg.line([EDGE, EDGE + *face], "#222222", 2.5, 1.0);
        let beside = EDGE + *face + DVec2::new(8.0 * face.x.signum(), 16.0);
        let anchor = if face.x < 0.0 { "end" } else { "start" };
        svg.text([beside.x, beside.y], anchor, word);
    }
    let centre = EDGE - DVec2::new(0.0, BALL);
    svg.line(
        [centre, EDGE - DVec2::new(0.0, BISECTOR)],
        "#777777",
        1.5,
        0.8,
    );
    svg.text([EDGE.x + 6.0, EDGE.y - BISECTOR + 4.0], "start", "bisector");
    let back = flat(-section.axis).normalize_or(DVec2::NEG_Y);
    svg.line([centre, centre + TOOL * back], "#d55e00", 6.0, 0.9);
    svg.disc(centre, BALL, "#de8f05");
    let end = centre + (TOOL + 14.0) * back;
    let anchor = if back.x < -0.1 { "end" } else { "start" };
    svg.text([end.x, end.y + 4.0], anchor, "tool");
    let lean = back.x.atan2(-back.y).to_degrees();
    let words = if lean.abs() < 0.05 {
        "along the bisector".to_owned()
    } else {
        let side = if lean < 0.0 { "left" } else { "right" };
        // Positive towards the left face, as process.lean_deg counts.
        format!("lean_deg = {:.1}, towards the {side} face", -lean)
    };
    svg.text([10.0, 22.0], "start", &words);
    svg.text(
        [10.0, SIZE[1] as f64 - 10.0],
        "start",
        "seen along the direction of travel",
    );
    let down = GRAVITY * flat(section.gravity.normalize_or_zero());
    if down.length() > 0.2 * GRAVITY {
        let from = DVec2::new(SIZE[0] as f64 - 60.0, 50.0);
        svg.arrow([from, from + down], "currentColor", 1.5);
        svg.text([from.x, from.y - 10.0], "middle", "gravity");
    }
    svg.end()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted(angle: f64) -> CrossSection {
        // An edge along x, its bisector up: left of the travel is +y.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        CrossSection {
            tangent: DVec3::X,
            normals: [DVec3::new(0.0, half, half), DVec3::new(0.0, -half, half)],
            bisector: DVec3::Z,
            axis: -DVec3::new(0.0, angle.sin(), angle.cos()),
            gravity: DVec3::NEG_Z,
        }
    }

    #[test]
    fn a_positive_lean_is_drawn_and_described_towards_the_left_face() {
        let drawn = cross_section(&tilted(f64::to_radians(20.0)));
        assert!(
            drawn.contains("lean_deg = 20.0, towards the left face"),
            "{drawn}"
        );
        let other = cross_section(&tilted(f64::to_radians(-35.0)));
        assert!(
            other.contains("lean_deg = -35.0, towards the right face"),
            "{other}"
        );
        assert!(cross_section(&tilted(0.0)).contains("along the bisector"));
        // The word for the tool stands left of the edge when it leans left.
        let place = |text: &str| -> f64 {
            let line = text.lines().find(|line| line.contains(">tool<")).unwrap();
            let from = line.find("x=\"").unwrap() + 3;
            line[from..].split('"').next().unwrap().parse().unwrap()
        };
        assert!(place(&drawn) < EDGE.x && place(&other) > EDGE.x);
    }
}
