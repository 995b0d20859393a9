//! Finds the sharp edges of a part and chains them into curves.
//!
//! A mesh edge is sharp where the outward normals of its two triangles differ by more than a
//! threshold. Triangles connected over edges that are not sharp form smooth faces (*patches*). Two
//! views of the same sharp edges are offered: *edges*, smooth chains that end at corners and where
//! several meet, and *loops*, the closed outlines of patches with their corners listed.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::curve::{Convexity, CurveParts, EdgeCurve};
use super::edge_list::EdgeList;
use super::mesh::TriangleMesh;
use super::topology::{end_of, next_in_triangle, start_of, triangle_of};

/// Criteria of an edge, and of a corner on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeSearch {
    /// Smallest angle between the normals of two faces that makes their edge sharp [rad].
    pub sharp_angle: f64,
    /// Smallest change of direction along an edge that makes a corner [rad].
    pub corner_angle: f64,
}

impl Default for EdgeSearch {
    fn default() -> Self {
        Self {
            sharp_angle: 30_f64.to_radians(),
            corner_angle: 20_f64.to_radians(),
        }
    }
}

/// Finds edges and loops.
pub fn list_edges(mesh: &TriangleMesh, search: &EdgeSearch) -> EdgeList {
    let finder = Finder::new(mesh, search);
    EdgeList {
        edges: finder.edges(),
        loops: finder.loops(),
    }
}

/// The search's working state; half-edges as in [`super::topology`].
struct Finder<'a> {
    mesh: &'a TriangleMesh,
    corner_angle: f64,
    sharp: Vec<bool>,
    patch_of: Vec<u32>,
}

impl<'a> Finder<'a> {
    fn new(mesh: &'a TriangleMesh, search: &EdgeSearch) -> Self {
        let normals = mesh.face_normals();
        let sharp: Vec<bool> = (0..3 * mesh.triangles().len() as u32)
            .map(|half_edge| {
                let twin = mesh.topology().twin(half_edge);
                let angle =
                    normals[triangle_of(half_edge)].angle_between(normals[triangle_of(twin)]);
                angle >= search.sharp_angle
            })
            .collect();
        let patch_of = patches(mesh, &sharp);
        Self {
            mesh,
            corner_angle: search.corner_angle,
            sharp,
            patch_of,
        }
    }

    fn twin(&self, half_edge: u32) -> u32 {
        self.mesh.topology().twin(half_edge)
    }

    fn from(&self, half_edge: u32) -> DVec3 {
        self.mesh.vertices()[start_of(self.mesh.triangles(), half_edge) as usize]
    }

    fn direction(&self, half_edge: u32) -> DVec3 {
        self.from(next_in_triangle(half_edge)) - self.from(half_edge)
    }

    fn patch(&self, half_edge: u32) -> u32 {
        self.patch_of[triangle_of(half_edge)]
    }

    fn is_convex(&self, half_edge: u32) -> bool {
        let twin = self.twin(half_edge);
        let far = self.from(next_in_triangle(next_in_triangle(twin)));
        let normal = self.mesh.face_normals()[triangle_of(half_edge)];
        normal.dot(far - self.from(half_edge)) < 0.0
    }

    fn sharp_half_edges(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.sharp.len() as u32).filter(|&half_edge| self.sharp[half_edge as usize])
    }

    /// The next half-edge along the outline of the patch on the left.
    fn next_on_outline(&self, half_edge: u32) -> u32 {
        let mut next = next_in_triangle(half_edge);
        while !self.sharp[next as usize] {
            next = next_in_triangle(self.twin(next));
        }
        next
    }

    fn loops(&self) -> Vec<EdgeCurve> {
        let mut visited = vec![false; self.sharp.len()];
        let mut chains = Vec::new();
        for first in self.sharp_half_edges() {
            let mut chain = Vec::new();
            let mut half_edge = first;
            while !visited[half_edge as usize] {
                visited[half_edge as usize] = true;
                chain.push(half_edge);
                half_edge = self.next_on_outline(half_edge);
            }
            if !chain.is_empty() {
                chains.push(chain);
            }
        }
        chains.sort_by_key(|chain| self.patch(chain[0]));
        let mut listed = BTreeSet::new();
        chains.retain(|chain| {
            let mut undirected: Vec<u32> = chain.iter().map(|&h| h.min(self.twin(h))).collect();
            undirected.sort_unstable();
            listed.insert(undirected)
        });
        self.named(
            "loop",
            chains.into_iter().map(|chain| (chain, true)).collect(),
        )
    }

    fn edges(&self) -> Vec<EdgeCurve> {
        let continuation = self.continuations();
        // The half-edge after one, and the one before it.
        let after = |half_edge: u32| continuation.get(&self.twin(half_edge)).copied();
        let before = |half_edge: u32| continuation.get(&half_edge).map(|&other| self.twin(other));
        let mut visited = vec![false; self.sharp.len()];
        let mut chains = Vec::new();
        for seed in self.sharp_half_edges() {
            if visited[seed as usize] {
                continue;
            }
            let mut first = seed;
            while let Some(previous) = before(first).filter(|&previous| previous != seed) {
                first = previous;
            }
            let (mut chain, mut closed) = (vec![first], false);
            let mut last = first;
            while let Some(next) = after(last) {
                if next == first {
                    closed = true;
                    break;
                }
                chain.push(next);
                last = next;
            }
            for &half_edge in &chain {
                visited[half_edge as usize] = true;
                visited[self.twin(half_edge) as usize] = true;
            }
            chains.push((self.with_first_patch_left(chain), closed));
        }
        self.named("edge", chains)
    }

    /// For each sharp half-edge the one that leaves the same vertex and goes on from it, where there
    /// is exactly one: it turns less than a corner, bends to the same side and shares a face.
    fn continuations(&self) -> BTreeMap<u32, u32> {
        let mut leaving: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for half_edge in self.sharp_half_edges() {
            let vertex = start_of(self.mesh.triangles(), half_edge);
            leaving.entry(vertex).or_default().push(half_edge);
        }
        let goes_on = |one: u32, other: u32| {
            let patches = |h: u32| [self.patch(h), self.patch(self.twin(h))];
            one != other
                && (-self.direction(one)).angle_between(self.direction(other)) < self.corner_angle
                && self.is_convex(one) == self.is_convex(other)
                && patches(one)
                    .iter()
                    .any(|patch| patches(other).contains(patch))
        };
        let mut continuation = BTreeMap::new();
        for star in leaving.values() {
            let only = |one: u32| {
                let mut fitting = star.iter().copied().filter(|&other| goes_on(one, other));
                let found = fitting.next()?;
                fitting.next().is_none().then_some(found)
            };
            for &one in star {
                if let Some(other) = only(one)
                    && only(other) == Some(one)
                {
                    continuation.insert(one, other);
                }
            }
        }
        continuation
    }

    /// Turns a chain so that the face that comes first is on its left.
    fn with_first_patch_left(&self, chain: Vec<u32>) -> Vec<u32> {
        let left = chain.iter().map(|&h| self.patch(h)).min();
        let right = chain.iter().map(|&h| self.patch(self.twin(h))).min();
        if left <= right {
            return chain;
        }
        chain.iter().rev().map(|&h| self.twin(h)).collect()
    }

    /// Makes curves of half-edge chains, sorts them and numbers them.
    fn named(&self, prefix: &str, chains: Vec<(Vec<u32>, bool)>) -> Vec<EdgeCurve> {
        let mut curves: Vec<(u32, EdgeCurve)> = chains
            .into_iter()
            .map(|(chain, closed)| {
                let right = self.patch(self.twin(chain[0]));
                (right, self.curve(chain, closed))
            })
            .collect();
        curves.sort_by(|(right, one), (other_right, other)| {
            (one.patch, right)
                .cmp(&(other.patch, other_right))
                .then_with(|| compare(lowest(&one.points), lowest(&other.points)))
                .then_with(|| compare(one.points[0], other.points[0]))
        });
        let numbered = curves.into_iter().enumerate();
        numbered
            .map(|(number, (_, mut curve))| {
                curve.id = format!("{prefix}-{number}");
                curve
            })
            .collect()
    }

    fn curve(&self, mut chain: Vec<u32>, closed: bool) -> EdgeCurve {
        let count = chain.len();
        let turns = |chain: &[u32], index: usize| {
            let before = chain[(index + count - 1) % count];
            self.direction(before)
                .angle_between(self.direction(chain[index]))
                >= self.corner_angle
        };
        if closed {
            // Start at the corner, or else the point, that comes first by position.
            let first = (0..count).min_by(|&one, &other| {
                turns(&chain, other)
                    .cmp(&turns(&chain, one))
                    .then_with(|| compare(self.from(chain[one]), self.from(chain[other])))
            });
            chain.rotate_left(first.unwrap_or(0));
        }
        let mut points: Vec<DVec3> = chain.iter().map(|&h| self.from(h)).collect();
        if !closed {
            let end = end_of(self.mesh.triangles(), chain[count - 1]);
            points.push(self.mesh.vertices()[end as usize]);
        }
        let normals = self.mesh.face_normals();
        let convex = chain.iter().filter(|&&h| self.is_convex(h)).count();
        EdgeCurve::new(CurveParts {
            id: String::new(),
            patch: self.patch(chain[0]),
            points,
            closed,
            normals: chain
                .iter()
                .map(|&h| (normals[triangle_of(h)], normals[triangle_of(self.twin(h))]))
                .collect(),
            convexity: match convex {
                0 => Convexity::Concave,
                all if all == count => Convexity::Convex,
                _ => Convexity::Mixed,
            },
            corners: (0..count)
                .filter(|&index| closed && turns(&chain, index))
                .collect(),
        })
    }
}

/// Numbers the smooth faces in the order of their first triangles.
fn patches(mesh: &TriangleMesh, sharp: &[bool]) -> Vec<u32> {
    let mut patch_of = vec![u32::MAX; mesh.triangles().len()];
    let mut count = 0;
    for seed in 0..patch_of.len() {
        if patch_of[seed] != u32::MAX {
            continue;
        }
        let mut waiting = vec![seed];
        patch_of[seed] = count;
        while let Some(triangle) = waiting.pop() {
            for half_edge in 3 * triangle as u32..3 * triangle as u32 + 3 {
                let neighbour = triangle_of(mesh.topology().twin(half_edge));
                if !sharp[half_edge as usize] && patch_of[neighbour] == u32::MAX {
                    patch_of[neighbour] = count;
                    waiting.push(neighbour);
                }
            }
        }
        count += 1;
    }
    patch_of
}

fn compare(one: DVec3, other: DVec3) -> std::cmp::Ordering {
    let axes = [(one.x, other.x), (one.y, other.y), (one.z, other.z)];
    axes.iter()
        .map(|(one, other)| one.total_cmp(other))
        .find(|order| order.is_ne())
        .unwrap_or(std::cmp::Ordering::Equal)
}

fn lowest(points: &[DVec3]) -> DVec3 {
    let mut points = points.iter().copied();
    let first = points.next().unwrap_or_default();
    points.fold(first, |low, point| {
        if compare(point, low).is_lt() {
            point
        } else {
            low
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::curve::CurveKind;
    use super::super::mesh::shapes::{gridded_box, prism};
    use super::super::part_file::load_mesh;
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    use std::path::Path;

    fn asset(name: &str) -> EdgeList {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("assets")
            .join(name);
        list_edges(&load_mesh(&path, 1e-3).unwrap(), &EdgeSearch::default())
    }

    /// Each curve's normals, direction and bisector agree with the stated orientation.
    fn check_orientation(curve: &EdgeCurve) {
        let sign = match curve.convexity {
            Convexity::Convex => 1.0,
            Convexity::Concave => -1.0,
            Convexity::Mixed => return,
        };
        for segment in 0..curve.normals.len() {
            let (normal_a, normal_b) = curve.normals[segment];
            let end = curve.points[(segment + 1) % curve.points.len()];
            let tangent = (end - curve.points[segment]).normalize();
            let across = sign * normal_a.cross(normal_b).normalize();
            assert!(tangent.distance(across) < 1e-4, "{}", curve.id);
        }
    }

    #[test]
    fn plate_has_twelve_edges_and_six_outlines() {
        let list = asset("plate.stl");
        assert_eq!(list.edges.len(), 12);
        assert_eq!(list.loops.len(), 6);
        let mut lengths: Vec<i64> = list
            .edges
            .iter()
            .map(|edge| (edge.length * 1e6).round() as i64)
            .collect();
        lengths.sort_unstable();
        let expected: Vec<i64> = [20_000, 120_000, 300_000]
            .iter()
            .flat_map(|&length| [length; 4])
            .collect();
        assert_eq!(lengths, expected);
        for edge in &list.edges {
            assert_eq!(edge.kind, CurveKind::Straight);
            assert_eq!(edge.convexity, Convexity::Convex);
            assert!((edge.angle_between_faces(0) - FRAC_PI_2).abs() < 1e-12);
            assert!(!edge.closed);
            check_orientation(edge);
        }
        for outline in &list.loops {
            assert_eq!(outline.corners, [0, 1, 2, 3]);
            check_orientation(outline);
        }
        // The edge to be deburred: from x = -150 to 150 mm at y = z = 0, top face on its left.
        let front = list
            .edges
            .iter()
            .find(|edge| edge.at(0.15).point.length() < 1e-9)
            .unwrap();
        let place = front.at(0.15);
        assert!(place.tangent.distance(DVec3::X) < 1e-12);
        assert!(place.normal_a.distance(DVec3::Z) < 1e-12);
        assert!(place.normal_b.distance(DVec3::NEG_Y) < 1e-12);
        assert!(
            place
                .bisector
                .distance(DVec3::new(0.0, -1.0, 1.0) / 2_f64.sqrt())
                < 1e-12
        );
    }

    #[test]
    fn bracket_outline_and_hole_have_their_closed_form_lengths() {
        let list = asset("bracket.stl");
        // Chords of 1 degree are shorter than their arcs by 1 - sin(a)/a, a = 0.5 deg: 1.3e-5.
        let outline = &list.loops[0];
        let straight = 140.0 + 20.0 + 65.0 + 45.0 + 40.0 + 140.0;
        let arcs = 3.0 * 20.0 * FRAC_PI_2 + 15.0 * FRAC_PI_2;
        assert!((outline.length * 1e3 - (straight + arcs)).abs() < 1.3e-5 * arcs + 1e-5);
        assert!(outline.length * 1e3 < straight + arcs);
        assert_eq!(outline.convexity, Convexity::Convex);
        assert!(outline.closed);
        let corners: Vec<DVec3> = outline.corners.iter().map(|&c| outline.points[c]).collect();
        assert_eq!(corners.len(), 2);
        assert!(corners[0].distance(DVec3::ZERO) < 1e-9);
        assert!(corners[1].distance(DVec3::Y * 0.14) < 1e-8);
        assert!(
            outline
                .normals
                .iter()
                .all(|pair| pair.0.distance(DVec3::Z) < 1e-9)
        );
        check_orientation(outline);

        let hole = &list.loops[1];
        assert!(matches!(hole.kind, CurveKind::Arc { radius, angle }
            if (radius - 0.02).abs() < 1e-8 && angle == TAU));
        assert!((hole.length * 1e3 - 40.0 * PI).abs() < 1.3e-5 * 40.0 * PI + 1e-5);
        assert_eq!(hole.convexity, Convexity::Convex);
        assert!(hole.corners.is_empty());
        check_orientation(hole);
        let towards_axis = (DVec3::new(0.035, 0.035, 0.0) - hole.points[0]).normalize();
        assert!(hole.at(0.0).normal_b.distance(towards_axis) < 1e-4);
    }

    #[test]
    fn bracket_edges_end_at_the_two_sharp_corners() {
        let list = asset("bracket.stl");
        // Top and bottom: the side x = 0, the rest of the outline, the hole; and two upright edges.
        assert_eq!(list.edges.len(), 8);
        let upright = list
            .edges
            .iter()
            .filter(|edge| edge.kind == CurveKind::Straight && (edge.length - 0.015).abs() < 1e-9);
        assert_eq!(upright.count(), 2);
        let closed = list.edges.iter().filter(|edge| edge.closed);
        assert_eq!(closed.count(), 2);
        assert!(
            list.edges
                .iter()
                .all(|edge| edge.convexity == Convexity::Convex)
        );
    }

    #[test]
    fn concave_edges_are_distinguished_from_convex_ones() {
        // An L without fillet: one upright edge of six is concave.
        let outline = [
            [0.0, 0.0],
            [0.2, 0.0],
            [0.2, 0.1],
            [0.1, 0.1],
            [0.1, 0.2],
            [0.0, 0.2],
        ];
        let caps = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];
        let list = list_edges(&prism(&outline, &caps, 0.05), &EdgeSearch::default());
        assert_eq!(list.edges.len(), 18);
        let concave: Vec<&EdgeCurve> = list
            .edges
            .iter()
            .filter(|edge| edge.convexity == Convexity::Concave)
            .collect();
        assert_eq!(concave.len(), 1);
        let place = concave[0].at(0.01);
        assert!(place.point.truncate().distance(glam::DVec2::splat(0.1)) < 1e-12);
        assert!(
            place
                .bisector
                .distance(DVec3::new(1.0, 1.0, 0.0).normalize())
                < 1e-12
        );
        list.edges.iter().for_each(check_orientation);
        let mixed = list
            .loops
            .iter()
            .filter(|l| l.convexity == Convexity::Mixed);
        assert_eq!(mixed.count(), 2);
    }

    #[test]
    fn subdivided_edges_are_chained_whole() {
        let mesh = gridded_box(DVec3::ZERO, DVec3::new(0.3, 0.2, 0.1), 7);
        let list = list_edges(&mesh, &EdgeSearch::default());
        assert_eq!(list.edges.len(), 12);
        assert!(list.edges.iter().all(|edge| edge.points.len() == 8));
        assert!(
            list.edges
                .iter()
                .all(|edge| edge.kind == CurveKind::Straight)
        );
        assert_eq!(list.loops.len(), 6);
        assert!(list.loops.iter().all(|outline| outline.corners.len() == 4));
    }

    /// The surface of unit cubes at whole places [decimetres].
    fn cubes(places: &[[i32; 3]]) -> TriangleMesh {
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for &place in places {
            for axis in 0..3 {
                for side in [0, 1] {
                    let mut beyond = place;
                    beyond[axis] += 2 * side - 1;
                    if places.contains(&beyond) {
                        continue;
                    }
                    let base = points.len() as u32;
                    for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                        let mut corner = place;
                        corner[axis] += side;
                        corner[(axis + 1) % 3] += if side == 1 { u } else { v };
                        corner[(axis + 2) % 3] += if side == 1 { v } else { u };
                        points.push(DVec3::from_array(corner.map(f64::from)));
                    }
                    triangles.push([base, base + 1, base + 2]);
                    triangles.push([base, base + 2, base + 3]);
                }
            }
        }
        TriangleMesh::from_loose_triangles(&points, &triangles, 0.1).unwrap()
    }

    #[test]
    fn edge_ends_where_it_turns_from_concave_to_convex() {
        // Along y = z = 1 the wall y = 1 stands on a step up to x = 1 and overhangs beyond.
        let mesh = cubes(&[[0, 1, 1], [1, 1, 1], [0, 0, 0], [0, 1, 0]]);
        let list = list_edges(&mesh, &EdgeSearch::default());
        let on_line = |point: &DVec3| point.y == 0.1 && point.z == 0.1;
        let along: Vec<&EdgeCurve> = list
            .edges
            .iter()
            .filter(|edge| edge.points.iter().all(on_line))
            .collect();
        assert_eq!(along.len(), 2);
        assert_ne!(along[0].convexity, along[1].convexity);
        for edge in &list.edges {
            assert_ne!(edge.convexity, Convexity::Mixed, "{}", edge.id);
            check_orientation(edge);
        }
    }

    #[test]
    fn first_face_is_on_the_left_whatever_the_order_of_triangles() {
        let plain = gridded_box(DVec3::ZERO, DVec3::new(0.3, 0.2, 0.1), 3);
        let count = plain.triangles().len();
        // 5 has no factor in common with the 108 triangles: a shuffle.
        let shuffled = (0..count).map(|i| plain.triangles()[5 * i % count]);
        let mesh = TriangleMesh::new(plain.vertices().to_vec(), shuffled.collect()).unwrap();
        let rank = |normal: DVec3| {
            let mut normals = mesh.face_normals().iter();
            normals.position(|other| other.distance(normal) < 1e-6)
        };
        let list = list_edges(&mesh, &EdgeSearch::default());
        assert_eq!(list.edges.len(), 12);
        for edge in &list.edges {
            let (normal_a, normal_b) = edge.normals[0];
            assert!(rank(normal_a) < rank(normal_b), "{}", edge.id);
        }
    }

    #[test]
    fn thresholds_decide_what_is_sharp_and_what_a_corner() {
        // A twelve-sided prism: 30 degrees between its sides.
        let outline: Vec<[f64; 2]> = (0..12)
            .map(|i| (TAU * f64::from(i) / 12.0).sin_cos())
            .map(|(sin, cos)| [0.1 * cos, 0.1 * sin])
            .collect();
        let caps: Vec<[u32; 3]> = (1..11).map(|i| [0, i, i + 1]).collect();
        let mesh = prism(&outline, &caps, 0.05);
        let count = |sharp: f64, corner: f64| {
            let search = EdgeSearch {
                sharp_angle: sharp.to_radians(),
                corner_angle: corner.to_radians(),
            };
            let list = list_edges(&mesh, &search);
            let corners = list.loops.first().map_or(0, |rim| rim.corners.len());
            (list.edges.len(), corners)
        };
        assert_eq!(count(29.0, 20.0), (36, 12));
        assert_eq!(count(31.0, 20.0), (24, 12));
        assert_eq!(count(31.0, 35.0), (2, 0));
        // Upright edges meet the rims, but the rims go on smoothly past them.
        assert_eq!(count(29.0, 35.0), (14, 0));
        assert_eq!(count(91.0, 20.0), (0, 0));
    }

    #[test]
    fn list_is_the_same_each_time_and_finds_ids() {
        let list = asset("bracket.stl");
        assert_eq!(list, asset("bracket.stl"));
        assert_eq!(list.find("loop-1").unwrap().id, "loop-1");
        let message = list.find("edge-99").unwrap_err().to_string();
        assert!(message.contains("edge-0 to edge-7"), "{message}");
        let table = list.table();
        assert_eq!(
            table.lines().count(),
            1 + list.edges.len() + list.loops.len()
        );
        let hole = table
            .lines()
            .find(|line| line.starts_with("loop-1"))
            .unwrap();
        assert!(hole.contains("arc r 20.000 x 360.0 deg"), "{hole}");
        assert!(hole.contains("125.662"), "{hole}");
        println!("{table}{}", asset("plate.stl").table());
    }
}
