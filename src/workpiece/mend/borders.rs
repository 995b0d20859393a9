//! Borders that lie on each other joined: vertices of one place, and vertices on a neighbour's side.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::sides::Sides;
use super::{Flaw, Surface};
use crate::workpiece::topology::{end_of, start_of, triangle_of};

/// Vertices that lie nearer to each other than this share of the sides at them are one [1].
const BESIDE: f64 = 0.3;

/// A grid of cells with the vertices in each.
struct Grid {
    cell: f64,
    vertices: BTreeMap<[i64; 3], Vec<u32>>,
}

impl Grid {
    fn new(surface: &Surface, vertices: &BTreeSet<u32>, cell: f64) -> Self {
        let mut grid = Self {
            cell,
            vertices: BTreeMap::new(),
        };
        for &vertex in vertices {
            let key = grid.key(surface.at(vertex));
            grid.vertices.entry(key).or_default().push(vertex);
        }
        grid
    }

    fn key(&self, point: DVec3) -> [i64; 3] {
        (point / self.cell)
            .floor()
            .to_array()
            .map(|value| value as i64)
    }

    /// Vertices in the cells of a box, in order; adds the cells and vertices looked at to `work`.
    fn within(&self, low: DVec3, high: DVec3, work: &mut usize) -> Vec<u32> {
        let (low, high) = (self.key(low), self.key(high));
        let cells = (0..3)
            .map(|axis| (high[axis] - low[axis] + 1) as f64)
            .product::<f64>();
        let inside =
            |key: &[i64; 3]| (0..3).all(|axis| (low[axis]..=high[axis]).contains(&key[axis]));
        let mut found: Vec<u32> = if cells > self.vertices.len() as f64 {
            let all = self.vertices.iter().filter(|(key, _)| inside(key));
            all.flat_map(|(_, vertices)| vertices.iter().copied())
                .collect()
        } else {
            let mut found = Vec::new();
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        found.extend(self.vertices.get(&[x, y, z]).into_iter().flatten());
                    }
                }
            }
            found
        };
        *work += found.len() + (self.vertices.len() as f64).min(cells) as usize;
        found.sort_unstable();
        found
    }
}

impl Surface {
    fn border(&self) -> (Vec<u32>, BTreeSet<u32>) {
        let open: Vec<u32> = Sides::new(&self.triangles).open().collect();
        let ends = open
            .iter()
            .flat_map(|&h| [start_of(&self.triangles, h), end_of(&self.triangles, h)]);
        let vertices = ends.collect();
        (open, vertices)
    }

    /// Of each vertex of the border its shortest side [m], and the number of its triangles.
    fn shortest_sides(&self, border: &BTreeSet<u32>) -> BTreeMap<u32, (f64, usize)> {
        let mut shortest: BTreeMap<u32, (f64, usize)> =
            border.iter().map(|&v| (v, (f64::INFINITY, 0))).collect();
        for triangle in &self.triangles {
            for corner in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|step| triangle[(corner + step) % 3]);
                let length = self
                    .at(a)
                    .distance(self.at(b))
                    .min(self.at(a).distance(self.at(c)));
                if let Some((least, count)) = shortest.get_mut(&a) {
                    *least = least.min(length);
                    *count += 1;
                }
            }
        }
        shortest
    }

    /// Makes one of vertices of the border that lie within a tolerance [m], and nearer to each other than to anything else.
    pub(super) fn join_vertices(&mut self, tolerance: f64) {
        let (_, border) = self.border();
        if border.is_empty() {
            return;
        }
        let shortest = self.shortest_sides(&border);
        let grid = Grid::new(self, &border, 2.0 * tolerance);
        let mut pairs: Vec<(f64, u32, u32)> = Vec::new();
        for &vertex in &border {
            let at = self.at(vertex);
            let near = grid.within(at - tolerance, at + tolerance, &mut self.work);
            if self.is_beyond_mending() {
                return;
            }
            for other in near {
                let distance = at.distance(self.at(other));
                let reach = BESIDE * shortest[&vertex].0.min(shortest[&other].0);
                if other > vertex && distance <= tolerance.min(reach) {
                    pairs.push((distance, vertex, other));
                }
            }
        }
        pairs.sort_by(|one, other| {
            one.0
                .total_cmp(&other.0)
                .then((one.1, one.2).cmp(&(other.1, other.2)))
        });
        let mut is_equivalent: BTreeMap<u32, u32> = BTreeMap::new();
        let mut stays = BTreeSet::new();
        let mut moved = Vec::new();
        for (distance, one, other) in pairs {
            if is_equivalent.contains_key(&one) || is_equivalent.contains_key(&other) {
                continue;
            }
            // The vertex of more triangles stays.
            let (keep, gone) = if shortest[&one].1 >= shortest[&other].1 {
                (one, other)
            } else {
                (other, one)
            };
            if stays.contains(&gone) {
                continue;
            }
            is_equivalent.insert(gone, keep);
            stays.insert(keep);
            moved.push((gone, distance));
        }
        // Area of the triangles about each that goes [m^2].
        let mut around: BTreeMap<u32, f64> = moved.iter().map(|(gone, _)| (*gone, 0.0)).collect();
        for (triangle, corners) in self.triangles.iter().enumerate() {
            for corner in corners {
                if let Some(area) = around.get_mut(corner) {
                    *area += self.area(triangle);
                }
            }
        }
        for (gone, distance) in &moved {
            self.open_volume += around[gone] * distance / 3.0;
        }
        let places: Vec<DVec3> = moved.iter().map(|(gone, _)| self.at(*gone)).collect();
        for triangle in &mut self.triangles {
            *triangle =
                triangle.map(|vertex| is_equivalent.get(&vertex).copied().unwrap_or(vertex));
        }
        self.triangles
            .retain(|[a, b, c]| a != b && b != c && c != a);
        self.record(Flaw::Unwelded, places);
    }

    /// Splits triangles at vertices of the border that lie on their open sides, within a tolerance [m].
    pub(super) fn join_sides(&mut self, tolerance: f64) {
        let (open, border) = self.border();
        if border.is_empty() {
            return;
        }
        let lengths = open.iter().map(|&h| {
            self.at(start_of(&self.triangles, h))
                .distance(self.at(end_of(&self.triangles, h)))
        });
        let mean = lengths.sum::<f64>() / open.len() as f64;
        let grid = Grid::new(self, &border, mean.max(2.0 * tolerance));
        let mut places: BTreeSet<u32> = BTreeSet::new();
        // Triangles by their open sides, each with the vertices on it.
        let mut on_sides: BTreeMap<usize, Vec<(usize, Vec<u32>)>> = BTreeMap::new();
        for &half_edge in &open {
            let triangle = triangle_of(half_edge);
            let [from, to] = [
                start_of(&self.triangles, half_edge),
                end_of(&self.triangles, half_edge),
            ];
            let [start, end] = [from, to].map(|vertex| self.at(vertex));
            let along = end - start;
            let length = along.length();
            let box_of = [start.min(end) - tolerance, start.max(end) + tolerance];
            let near = grid.within(box_of[0], box_of[1], &mut self.work);
            if self.is_beyond_mending() {
                return;
            }
            let mut on: Vec<(f64, u32)> = Vec::new();
            for vertex in near
                .into_iter()
                .filter(|vertex| !self.triangles[triangle].contains(vertex))
            {
                let offset = self.at(vertex) - start;
                let share = offset.dot(along) / (length * length);
                let aside = (offset - share * along).length();
                // At its ends it would be the end itself.
                let margin = tolerance / length;
                if aside <= tolerance && share > margin && share < 1.0 - margin {
                    on.push((share, vertex));
                    self.open_volume += self.area(triangle) * aside / 3.0;
                }
            }
            if !on.is_empty() {
                on.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
                let vertices: Vec<u32> = on.into_iter().map(|(_, vertex)| vertex).collect();
                places.extend(&vertices);
                on_sides
                    .entry(triangle)
                    .or_default()
                    .push(((half_edge % 3) as usize, vertices));
            }
        }
        let mut added = Vec::new();
        for (triangle, sides) in on_sides {
            let mut pieces = split(self.triangles[triangle], &sides).into_iter();
            if let Some(first) = pieces.next() {
                self.triangles[triangle] = first;
            }
            added.extend(pieces);
        }
        self.triangles.extend(added);
        let places: Vec<DVec3> = places.into_iter().map(|vertex| self.at(vertex)).collect();
        self.record(Flaw::OnSide, places);
    }
}

/// A triangle split at vertices on its sides, one side after the other.
fn split(triangle: [u32; 3], sides: &[(usize, Vec<u32>)]) -> Vec<[u32; 3]> {
    let mut pieces = vec![triangle];
    for (side, vertices) in sides {
        let (from, to) = (triangle[*side], triangle[(side + 1) % 3]);
        let Some(index) = pieces
            .iter()
            .position(|piece| (0..3).any(|k| piece[k] == from && piece[(k + 1) % 3] == to))
        else {
            continue;
        };
        let piece = pieces.swap_remove(index);
        let Some(&apex) = piece.iter().find(|&&vertex| vertex != from && vertex != to) else {
            continue;
        };
        let mut last = from;
        for &vertex in vertices.iter().chain([&to]) {
            pieces.push([last, vertex, apex]);
            last = vertex;
        }
    }
    pieces
}
