//! Edges at which the surface touches itself: of the faces about them those that bound the same wedge of the part belong together.

use std::collections::BTreeMap;

use glam::DVec3;

use super::sides::{Side, Sides};
use super::{Flaw, Surface};
use crate::workpiece::topology::{next_in_triangle, start_of};

impl Surface {
    pub(super) fn separate_touching(&mut self) {
        let sides = Sides::new(&self.triangles);
        let mut twins = sides.twins();
        let mut touching: Vec<(Side, Vec<[u32; 2]>)> = Vec::new();
        for side in sides.all() {
            let count = side.half_edges.len();
            if count > 2
                && side.forwards * 2 == count
                && let Some(pairs) = self.wedges(&side)
            {
                for &[one, other] in &pairs {
                    twins[one as usize] = Some(other);
                    twins[other as usize] = Some(one);
                }
                touching.push((side, pairs));
            }
        }
        let places: Vec<DVec3> = touching
            .iter()
            .map(|(side, _)| 0.5 * (self.at(side.ends[0]) + self.at(side.ends[1])))
            .collect();
        if places.is_empty() {
            return;
        }
        self.split_vertices(&touching, &twins);
        self.split_edges(&touching);
        self.record(Flaw::Touching, places);
    }

    /// Half-edges of an edge in pairs that bound a wedge of the part; none where the edge has no direction.
    fn wedges(&self, side: &Side) -> Option<Vec<[u32; 2]>> {
        let [low, high] = side.ends.map(|vertex| self.at(vertex));
        let along = (high - low).try_normalize()?;
        let across = along.any_orthonormal_vector();
        let aside = along.cross(across);
        let mut around: Vec<(f64, bool, u32)> = Vec::new();
        for &half_edge in &side.half_edges {
            let apex = start_of(
                &self.triangles,
                next_in_triangle(next_in_triangle(half_edge)),
            );
            let out = self.at(apex) - low;
            let angle = out.dot(aside).atan2(out.dot(across));
            around.push((
                angle,
                start_of(&self.triangles, half_edge) == side.ends[0],
                half_edge,
            ));
        }
        around.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.2.cmp(&other.2)));
        // A face's normal points to where the angle grows if it runs along the edge: so the part begins at a face that runs against it.
        // From where no wedge is open, each face that ends one ends the one that was begun last: wedges lie in each other, and none cross.
        let (mut depth, mut lowest, mut first) = (0_i32, 0, 0);
        for (index, (_, forwards, _)) in around.iter().enumerate() {
            depth += if *forwards { -1 } else { 1 };
            if depth < lowest {
                (lowest, first) = (depth, index + 1);
            }
        }
        let count = around.len();
        around.rotate_left(first % count);
        let (mut begun, mut pairs) = (Vec::new(), Vec::new());
        for (_, forwards, half_edge) in around {
            if forwards {
                pairs.push([begun.pop()?, half_edge]);
            } else {
                begun.push(half_edge);
            }
        }
        Some(pairs)
    }

    /// Gives each fan of triangles about a vertex of such an edge a vertex of its own.
    fn split_vertices(&mut self, touching: &[(Side, Vec<[u32; 2]>)], twins: &[Option<u32>]) {
        let mut fan_of: BTreeMap<u32, u32> = BTreeMap::new();
        for vertex in touching.iter().flat_map(|(side, _)| side.ends) {
            let corners: Vec<u32> = (0..3 * self.triangles.len() as u32)
                .filter(|&h| start_of(&self.triangles, h) == vertex)
                .collect();
            let mut fans = 0;
            for &seed in &corners {
                if fan_of.contains_key(&seed) {
                    continue;
                }
                let mut own = vertex;
                if fans > 0 {
                    own = self.vertices.len() as u32;
                    self.vertices.push(self.at(vertex));
                }
                fans += 1;
                let mut waiting = vec![seed];
                fan_of.insert(seed, own);
                while let Some(corner) = waiting.pop() {
                    let before = next_in_triangle(next_in_triangle(corner));
                    // Across the side that leaves the vertex, and the one that comes to it.
                    let next = [
                        twins[corner as usize].map(next_in_triangle),
                        twins[before as usize],
                    ];
                    for other in next
                        .into_iter()
                        .flatten()
                        .filter(|&other| start_of(&self.triangles, other) == vertex)
                    {
                        if fan_of.insert(other, own).is_none() {
                            waiting.push(other);
                        }
                    }
                }
            }
        }
        for (corner, vertex) in fan_of {
            self.triangles[corner as usize / 3][corner as usize % 3] = vertex;
        }
    }

    /// Where the fans hang together at both ends of an edge, its pairs get a vertex each in its middle.
    fn split_edges(&mut self, touching: &[(Side, Vec<[u32; 2]>)]) {
        let still: Vec<Vec<u32>> = Sides::new(&self.triangles)
            .all()
            .filter(|side| side.half_edges.len() > 2)
            .map(|side| side.half_edges)
            .collect();
        // Triangles by number with the sides to be split: new vertices, each in its side's middle.
        let mut middles: BTreeMap<u32, u32> = BTreeMap::new();
        for pairs in touching.iter().map(|(_, pairs)| pairs) {
            for &[one, other] in pairs
                .iter()
                .filter(|pair| still.iter().any(|half_edges| half_edges.contains(&pair[0])))
            {
                let [from, to] = [one, next_in_triangle(one)]
                    .map(|half_edge| self.at(start_of(&self.triangles, half_edge)));
                let vertex = self.vertices.len() as u32;
                self.vertices.push(0.5 * (from + to));
                middles.extend([(one, vertex), (other, vertex)]);
            }
        }
        let mut by_triangle: BTreeMap<usize, Vec<(usize, u32)>> = BTreeMap::new();
        for (half_edge, vertex) in middles {
            by_triangle
                .entry(half_edge as usize / 3)
                .or_default()
                .push((half_edge as usize % 3, vertex));
        }
        for (triangle, sides) in by_triangle {
            let corners = self.triangles[triangle];
            let mut outline = Vec::new();
            for (corner, vertex) in corners.iter().enumerate() {
                outline.push(*vertex);
                outline.extend(
                    sides
                        .iter()
                        .filter(|(side, _)| *side == corner)
                        .map(|(_, vertex)| *vertex),
                );
            }
            // From a new vertex, so that no piece is flat.
            let first = outline
                .iter()
                .position(|vertex| !corners.contains(vertex))
                .unwrap_or(0);
            outline.rotate_left(first);
            let mut pieces =
                (1..outline.len() - 1).map(|i| [outline[0], outline[i], outline[i + 1]]);
            if let Some(piece) = pieces.next() {
                self.triangles[triangle] = piece;
            }
            let rest: Vec<[u32; 3]> = pieces.collect();
            self.triangles.extend(rest);
        }
    }
}
