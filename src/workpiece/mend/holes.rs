//! Holes closed: small ones, and those that lie within a plane face.

use glam::DVec3;

use super::sides::{Sides, next_on_border};
use super::{Flaw, Surface};
use crate::mesh_file::split_polygon;
use crate::workpiece::topology::{end_of, start_of, triangle_of};

/// Largest share of the surface that a hole may have: anywhere, and within a plane face [1].
const ANYWHERE: f64 = 0.01;
const WITHIN_FACE: f64 = 0.2;
/// Most corners of a hole within a plane face whose size is not small.
const FEW: usize = 6;
/// Sine of the angle between faces that lie in one plane [1].
const ONE_PLANE: f64 = 0.02;
/// Most volume that a bent hole may leave open: share of the part's [1].
const BENT: f64 = 5e-4;

impl Surface {
    pub(super) fn close_holes(&mut self, size: f64) {
        let sides = Sides::new(&self.triangles);
        let twins = sides.twins();
        let mut visited = vec![false; twins.len()];
        // Edges of three and more have no twins either, and are no border.
        let mut open = vec![false; twins.len()];
        for half_edge in sides.open() {
            open[half_edge as usize] = true;
        }
        let whole = self.whole_area();
        let volume = self.volume().abs();
        let mut found = Vec::new();
        for first in (0..open.len() as u32).filter(|half_edge| open[*half_edge as usize]) {
            let (mut border, mut half_edge) = (Vec::new(), first);
            while !visited[half_edge as usize] && open[half_edge as usize] {
                visited[half_edge as usize] = true;
                border.push(half_edge);
                match next_on_border(&twins, half_edge) {
                    Some(next) => half_edge = next,
                    None => break,
                }
            }
            if border.len() > 2 && half_edge == first {
                found.extend(self.patch(&border, whole, volume, size));
            }
        }
        for (triangles, place) in found {
            self.triangles.extend(triangles);
            self.record(Flaw::Hole, [place]);
        }
    }

    /// Triangles that close a border, and its middle; none where it is no small flaw.
    fn patch(
        &mut self,
        border: &[u32],
        whole: f64,
        volume: f64,
        size: f64,
    ) -> Option<(Vec<[u32; 3]>, DVec3)> {
        // The patch runs along each side the other way.
        let outline: Vec<u32> = border
            .iter()
            .rev()
            .map(|&h| end_of(&self.triangles, h))
            .collect();
        let split = split_polygon(&self.vertices, &outline)?;
        let normal = |[a, b, c]: [u32; 3]| (self.at(b) - self.at(a)).cross(self.at(c) - self.at(a));
        let area: f64 = split
            .triangles
            .iter()
            .map(|&t| 0.5 * normal(t).length())
            .sum();
        let facing = split
            .triangles
            .iter()
            .map(|&t| normal(t))
            .sum::<DVec3>()
            .normalize_or_zero();
        let off = split.off_plane.unwrap_or(0.0);
        let plane = off <= 1e-5 * size;
        let continues = border.iter().any(|&half_edge| {
            let beside = self.normal(triangle_of(half_edge)).normalize_or_zero();
            beside.cross(facing).length() < ONE_PLANE && beside.dot(facing) > 0.0
        });
        let within = plane && continues && border.len() <= FEW && area <= WITHIN_FACE * whole;
        if split.folded || !(area <= ANYWHERE * whole || within) || 0.5 * off * area > BENT * volume
        {
            return None;
        }
        self.open_volume += 0.5 * off * area;
        let middle = border
            .iter()
            .map(|&h| self.at(start_of(&self.triangles, h)))
            .sum::<DVec3>()
            / border.len() as f64;
        Some((split.triangles, middle))
    }
}
