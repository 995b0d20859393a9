//! From loose triangles to a connected surface: equal vertices merged, triangles without area removed.
//!
//! Files hold 32-bit coordinates, and STL repeats each vertex in every triangle. A triangle that
//! collapses to an edge is dropped; a needle (three distinct vertices on one line, which exporters
//! put where a vertex lies on a neighbour's edge) is removed by flipping its longest edge, because
//! dropping it would open a crack.

use std::collections::HashMap;

use glam::DVec3;

/// Vertices closer than this share of the part's extent are one vertex; triangles flatter than it
/// are needles. Some eight units in the last place of a 32-bit coordinate.
const MERGE_SHARE: f64 = 1e-6;

/// Passes of needle removal; each pass can only remove needles whose neighbour is not one itself.
const NEEDLE_PASSES: usize = 8;

/// Largest side of the bounding box [same unit as the points].
pub(crate) fn extent(points: &[DVec3]) -> f64 {
    let Some(&first) = points.first() else {
        return 0.0;
    };
    let (low, high) = points.iter().fold((first, first), |(low, high), &point| {
        (low.min(point), high.max(point))
    });
    (high - low).max_element()
}

/// A surface with shared vertices.
pub(crate) struct Connected {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Where needles were.
    pub(crate) needles: Vec<DVec3>,
}

/// Merges vertices and removes triangles without area.
pub(crate) fn connect(points: &[DVec3], triangles: &[[u32; 3]]) -> Connected {
    let tolerance = MERGE_SHARE * extent(points);
    let (vertices, index_of) = weld(points, tolerance);
    let mut connected: Vec<[u32; 3]> = triangles
        .iter()
        .map(|triangle| triangle.map(|vertex| index_of[vertex as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    let needles = flip_needles(&vertices, &mut connected, tolerance);
    let mut needles: Vec<DVec3> = needles
        .iter()
        .map(|apex| vertices[*apex as usize])
        .collect();
    needles.dedup();
    Connected {
        vertices,
        triangles: connected,
        needles,
    }
}

/// The merged vertices, and for each point the vertex that stands for it.
fn weld(points: &[DVec3], tolerance: f64) -> (Vec<DVec3>, Vec<u32>) {
    let cell_size = if tolerance > 0.0 {
        2.0 * tolerance
    } else {
        1.0
    };
    let cell_of = |point: DVec3| (point / cell_size).floor().to_array().map(|x| x as i64);
    let mut vertices: Vec<DVec3> = Vec::new();
    // Only looked up, never iterated: the hash order cannot reach a result.
    let mut exact: HashMap<[u64; 3], u32> = HashMap::new();
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut index_of = Vec::with_capacity(points.len());
    for &point in points {
        let bits = (point + DVec3::ZERO).to_array().map(f64::to_bits);
        let index = *exact.entry(bits).or_insert_with(|| {
            // A ball of the tolerance reaches only the cells of its bounding box's corners.
            let low = cell_of(point - tolerance);
            let high = cell_of(point + tolerance);
            let mut found: Option<u32> = None;
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        for &vertex in cells.get(&[x, y, z]).into_iter().flatten() {
                            let near = vertices[vertex as usize].distance(point) <= tolerance;
                            if near && found.is_none_or(|other| vertex < other) {
                                found = Some(vertex);
                            }
                        }
                    }
                }
            }
            found.unwrap_or_else(|| {
                let new = vertices.len() as u32;
                vertices.push(point);
                cells.entry(cell_of(point)).or_default().push(new);
                new
            })
        });
        index_of.push(index);
    }
    (vertices, index_of)
}

/// If the triangle is a needle, its longest edge and apex as `(from, to, apex)`.
fn needle(vertices: &[DVec3], triangle: [u32; 3], tolerance: f64) -> Option<(u32, u32, u32)> {
    let at = |vertex: u32| vertices[vertex as usize];
    let mut longest = (0.0, 0);
    for corner in 0..3 {
        let length = at(triangle[corner]).distance(at(triangle[(corner + 1) % 3]));
        if length > longest.0 {
            longest = (length, corner);
        }
    }
    let (length, corner) = longest;
    let [from, to, apex] = [0, 1, 2].map(|step| triangle[(corner + step) % 3]);
    let doubled_area = (at(to) - at(from)).cross(at(apex) - at(from)).length();
    (doubled_area <= tolerance * length).then_some((from, to, apex))
}

/// Removes needles by flipping the edge that they share with their neighbour along the long side; returns their apexes.
fn flip_needles(vertices: &[DVec3], triangles: &mut [[u32; 3]], tolerance: f64) -> Vec<u32> {
    let mut apexes = Vec::new();
    let is_needle = |triangle| needle(vertices, triangle, tolerance).is_some();
    if !triangles.iter().any(|&triangle| is_needle(triangle)) {
        return apexes;
    }
    let mut owner: HashMap<(u32, u32), usize> = HashMap::new();
    let sides = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
    for (index, &triangle) in triangles.iter().enumerate() {
        owner.extend(sides(triangle).map(|side| (side, index)));
    }
    for _ in 0..NEEDLE_PASSES {
        let mut flipped = false;
        for index in 0..triangles.len() {
            let Some((from, to, apex)) = needle(vertices, triangles[index], tolerance) else {
                continue;
            };
            let Some(&neighbour) = owner.get(&(to, from)) else {
                continue;
            };
            if is_needle(triangles[neighbour]) {
                continue;
            }
            let Some(&far) = triangles[neighbour]
                .iter()
                .find(|&&vertex| vertex != from && vertex != to)
            else {
                continue;
            };
            if far == apex || owner.contains_key(&(apex, far)) || owner.contains_key(&(far, apex)) {
                continue;
            }
            owner.remove(&(from, to));
            owner.remove(&(to, from));
            triangles[index] = [apex, from, far];
            triangles[neighbour] = [apex, far, to];
            for changed in [index, neighbour] {
                owner.extend(sides(triangles[changed]).map(|side| (side, changed)));
            }
            flipped = true;
            apexes.push(apex);
        }
        if !flipped {
            break;
        }
    }
    apexes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workpiece::topology::Topology;

    #[test]
    fn points_on_both_sides_of_a_grid_line_are_merged() {
        let points = [
            DVec3::ZERO,
            DVec3::new(-4e-7, 3e-7, 0.0),
            DVec3::X,
            DVec3::new(1.0, 0.0, 1e-5),
            DVec3::new(-0.0, 0.0, -0.0),
        ];
        let (vertices, index_of) = weld(&points, 1e-6);
        assert_eq!(vertices.len(), 3);
        assert_eq!(index_of, [0, 0, 1, 2, 0]);
    }

    #[test]
    fn needle_on_a_neighbours_edge_is_flipped_away() {
        // A tetrahedron whose edge 0-1 carries a vertex 4 on one side only, closed by the needle 0-4-1.
        let vertices = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::Y,
            DVec3::Z,
            DVec3::new(0.4, 0.0, 0.0),
        ];
        let triangles = [
            [0, 2, 1],
            [0, 4, 3],
            [4, 1, 3],
            [0, 1, 4],
            [1, 2, 3],
            [2, 0, 3],
        ];
        Topology::new(&triangles).unwrap();
        let Connected {
            vertices,
            triangles: connected,
            needles,
        } = connect(&vertices, &triangles);
        assert_eq!(needles, [DVec3::new(0.4, 0.0, 0.0)]);
        assert_eq!(connected.len(), 6);
        Topology::new(&connected).unwrap();
        for &triangle in &connected {
            assert!(needle(&vertices, triangle, 1e-6).is_none());
        }
        let volume: f64 = connected
            .iter()
            .map(|t| t.map(|v| vertices[v as usize]))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        assert!((volume - 1.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn collapsed_triangles_are_dropped() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1e-9, 0.0, 0.0)];
        let connected = connect(&points, &[[0, 1, 2], [0, 3, 2]]);
        assert_eq!(connected.triangles, [[0, 1, 2]]);
        assert!(connected.needles.is_empty());
    }
}
