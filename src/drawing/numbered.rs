//! A part with numbered lines on it as a picture, for paper and where nothing can be turned.

use glam::{DVec2, DVec3};

use super::faces::faces;
use super::raster::Camera;
use super::{HIDDEN, SIZE, Svg, depth_at, drawn, image, scale_bar};
use crate::scene::Scene;

/// Room that a number takes [pixel].
const NUMBER: DVec2 = DVec2::new(26.0, 18.0);

/// A line with its number.
#[derive(Debug, Clone, PartialEq)]
pub struct Numbered {
    /// Its points in the world [m].
    pub points: Vec<DVec3>,
    /// Its number.
    pub number: usize,
    /// Whether it is pale.
    pub pale: bool,
}

/// Length of a piece that is hidden or seen as a whole [pixel].
const PIECE: f64 = 8.0;

/// The bodies of a scene from a direction, with lines on them; what of them lies behind is pale and has no number.
#[must_use]
pub fn numbered(scene: &Scene, lines: &[Numbered], eye: DVec3) -> String {
    let bodies = faces(scene, 0, |_| true);
    let (camera, raster) = drawn(&bodies, eye);
    let mut svg = Svg::with_image((SIZE, SIZE), "The part and its edges", &image(&raster));
    let mut words: Vec<(DVec2, usize)> = Vec::new();
    for line in lines {
        let mut seen = Vec::new();
        for (piece, depth) in pieces(&line.points, &camera) {
            let middle = 0.5 * (piece[0] + piece[1]);
            let hidden = depth_at(&raster, middle) > depth + HIDDEN.min(4.0 / camera.scale);
            let opacity = match (hidden, line.pale) {
                (true, _) => 0.2,
                (false, true) => 0.5,
                (false, false) => 1.0,
            };
            svg.line(piece, "#d55e00", 2.5, opacity);
            if !hidden {
                seen.push(middle);
            }
        }
        let apart = |one: &DVec2, other: &DVec2| (*one - *other).abs().cmpge(NUMBER).any();
        let free = |at: &&DVec2| words.iter().all(|(other, _)| apart(at, other));
        let middle = seen.len() / 2;
        let outwards = seen[middle..].iter().chain(seen[..middle].iter().rev());
        if let Some(at) = outwards.copied().find(|at| free(&at)) {
            words.push((at, line.number));
        }
    }
    for (at, number) in words {
        svg.text([at.x, at.y + 5.0], "middle", &number.to_string());
    }
    scale_bar(&mut svg, &camera, SIZE[1] as f64 - 14.0);
    svg.end()
}

/// Short pieces of a line in the picture, and how deep each lies [m].
fn pieces(points: &[DVec3], camera: &Camera) -> Vec<([DVec2; 2], f64)> {
    let mut pieces = Vec::new();
    for two in points.windows(2) {
        let [from, to] = [two[0], two[1]].map(|point| camera.project(point));
        let count = ((to.0 - from.0).length() / PIECE).ceil().max(1.0);
        for index in 0..count as usize {
            let at = |step: f64| from.0.lerp(to.0, (index as f64 + step) / count);
            let share = (index as f64 + 0.5) / count;
            pieces.push(([at(0.0), at(1.0)], from.1 + share * (to.1 - from.1)));
        }
    }
    pieces
}
