//! Bodies of a scene as meshes in the world, few enough triangles for a page.

use std::collections::BTreeMap;

use glam::DVec3;

use super::faces::{Face, faces};
use super::simplify::{Bodies, simplify};
use crate::scene::Scene;
use crate::scene::colour::Colour;

/// Corners within this are one, as fine as the page's numbers [m].
const ONE: f64 = 1e-8;

/// A body at a moment, of one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Name of the body.
    pub entity: String,
    /// Its colour.
    pub colour: Colour,
    /// Corners in the world [m].
    pub corners: Vec<DVec3>,
    /// Corner indices, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Triangles that it has where it is not simplified.
    pub whole: usize,
}

/// The bodies at a frame; where they have more triangles than `most` together, those are left out that are seen least.
pub(super) fn solids(scene: &Scene, frame: usize, most: usize) -> Vec<Solid> {
    let mut groups: BTreeMap<(u16, Colour), Vec<Face>> = BTreeMap::new();
    for face in faces(scene, frame, |_| true) {
        let own = groups.entry((face.body, face.colour));
        own.or_default().push(face);
    }
    let mut bodies = Bodies {
        corners: Vec::new(),
        triangles: Vec::new(),
        sizes: Vec::new(),
    };
    // Of each group where its corners begin, and its triangles.
    let mut ranges = Vec::new();
    for faces in groups.values() {
        let (low, high) = bounds(faces);
        let (corners, triangles) = merged(faces, low, ONE);
        let first = bodies.corners.len() as u32;
        ranges.push((first, triangles.len()));
        let size = (high - low).max_element().max(ONE);
        bodies
            .sizes
            .extend(std::iter::repeat_n(size, corners.len()));
        bodies.corners.extend(corners);
        let shifted = triangles
            .iter()
            .map(|triangle| triangle.map(|corner| first + corner));
        bodies.triangles.extend(shifted);
    }
    let mut kept = vec![Vec::new(); ranges.len()];
    for triangle in simplify(&bodies, most) {
        let group = ranges.partition_point(|(first, _)| *first <= triangle[0]) - 1;
        kept[group].push(triangle);
    }
    let solids = groups.keys().zip(ranges).zip(kept);
    let solids = solids.map(|(((body, colour), (_, whole)), triangles)| {
        let (corners, triangles) = compact(&bodies.corners, &triangles);
        Solid {
            entity: scene.bodies[usize::from(*body) - 1].entity.clone(),
            colour: *colour,
            corners,
            triangles,
            whole,
        }
    });
    solids.collect()
}

/// Opposite corners of the box about triangles.
fn bounds(faces: &[Face]) -> (DVec3, DVec3) {
    let corners = || faces.iter().flat_map(|face| face.corners);
    let start = corners().next().unwrap_or_default();
    corners().fold((start, start), |(low, high), corner| {
        (low.min(corner), high.max(corner))
    })
}

/// Triangles over the corners that they use.
fn compact(corners: &[DVec3], triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut known: BTreeMap<u32, u32> = BTreeMap::new();
    let mut used = Vec::new();
    let numbered = triangles.iter().map(|triangle| {
        triangle.map(|corner| {
            *known.entry(corner).or_insert_with(|| {
                used.push(corners[corner as usize]);
                used.len() as u32 - 1
            })
        })
    });
    let numbered = numbered.collect();
    (used, numbered)
}

/// The first corner in each cell stands for all in it; triangles that lose their area by it are left out.
fn merged(faces: &[Face], low: DVec3, cell: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut known: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let mut corners = Vec::new();
    let mut triangles = Vec::new();
    for face in faces {
        let triangle = face.corners.map(|corner| {
            let place = ((corner - low) / cell).to_array();
            let next = corners.len() as u32;
            let number = *known.entry(place.map(|v| v.round() as i64)).or_insert(next);
            if number == next {
                corners.push(corner);
            }
            number
        });
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            triangles.push(triangle);
        }
    }
    (corners, triangles)
}

#[cfg(test)]
mod tests {
    use glamx::DPose3;

    use super::*;
    use crate::arm::VisualShape;
    use crate::scene::{SceneBody, ScenePoses, SceneShape};

    fn ball(radius: f64) -> Scene {
        Scene {
            bodies: vec![SceneBody {
                entity: "ball".to_owned(),
                shapes: vec![SceneShape {
                    body_from_shape: DPose3::IDENTITY,
                    geometry: VisualShape::Sphere { radius },
                    colour: [1, 2, 3, 255],
                }],
                world_from_body: ScenePoses::Static(DPose3::IDENTITY),
            }],
            ..Scene::default()
        }
    }

    fn volume(solid: &Solid) -> f64 {
        let of = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|index| solid.corners[index as usize]);
            a.dot(b.cross(c)) / 6.0
        };
        solid.triangles.iter().map(of).sum()
    }

    #[test]
    fn a_simplified_body_has_few_triangles_and_its_shape() {
        let scene = ball(0.3);
        let exact = &solids(&scene, 0, usize::MAX)[0];
        // 15 rings of 32 corners and two poles; the poles' triangles have no area twice.
        assert_eq!([exact.corners.len(), exact.triangles.len()], [482, 960]);
        assert_eq!(exact.whole, 960);
        let few = &solids(&scene, 0, 300)[0];
        assert!((200..=300).contains(&few.triangles.len()) && few.whole == 960);
        assert!((volume(few) / volume(exact) - 1.0).abs() < 0.1);
        assert_eq!(few.entity, "ball");
        // All on the ball still, and all round it.
        assert!(
            few.corners
                .iter()
                .all(|corner| (corner.length() - 0.3).abs() < 1e-9)
        );
        let sum: DVec3 = few.corners.iter().sum();
        assert!(sum.length() / few.corners.len() as f64 <= 0.02, "{sum}");
    }

    #[test]
    fn a_bore_keeps_its_radius_and_its_corners_where_plane_faces_lose_theirs() {
        // A plate of 100 x 100 mm in squares of 2 mm, with a tube of 96 sides in it.
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for i in 0..=50_u32 {
            for j in 0..=50_u32 {
                vertices.push(DVec3::new(2e-3 * f64::from(i), 2e-3 * f64::from(j), 0.0));
                if i < 50 && j < 50 {
                    let at = |i: u32, j: u32| 51 * i + j;
                    triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                    triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        let first = vertices.len() as u32;
        for side in 0..96_u32 {
            let angle = std::f64::consts::TAU * f64::from(side) / 96.0;
            let rim = DVec3::new(0.05 + 0.01 * angle.cos(), 0.05 + 0.01 * angle.sin(), 0.0);
            vertices.extend([rim, rim - DVec3::Z * 0.02]);
            let [here, next] = [side, (side + 1) % 96].map(|side| first + 2 * side);
            triangles.push([here, here + 1, next + 1]);
            triangles.push([here, next + 1, next]);
        }
        let mut scene = ball(0.1);
        scene.bodies[0].shapes[0].geometry = VisualShape::Mesh {
            vertices,
            triangles,
        };
        let solid = &solids(&scene, 0, 300)[0];
        assert!(solid.triangles.len() <= 300 && solid.whole == 5192);
        let radius = |corner: &DVec3| (corner.truncate() - glam::DVec2::splat(0.05)).length();
        let on_tube = |corner: &&DVec3| (radius(corner) - 0.01).abs() < 1e-9 && corner.z < -0.01;
        let kept = solid.corners.iter().filter(on_tube).count();
        assert!(kept >= 90, "{kept} of 96 corners of the bore's far rim");
    }
}
