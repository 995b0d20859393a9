//! Bodies of a scene as meshes in the world, few enough triangles for a page.

use std::collections::BTreeMap;

use glam::DVec3;

use super::faces::{Face, faces};
use super::simplify::{Surface, simplify, split_at_edges};
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
    /// Corners in the world [m]; faces that meet at a sharp edge do not share them.
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
    let surface = |faces: &Vec<Face>| {
        let (corners, triangles) = merged(faces, ONE);
        split_at_edges(&corners, &triangles)
    };
    let mut bodies: Vec<Surface> = groups.values().map(surface).collect();
    let whole: Vec<usize> = bodies.iter().map(|body| body.triangles.len()).collect();
    simplify(&mut bodies, most);
    let solids = groups.keys().zip(bodies).zip(whole);
    let solids = solids.map(|(((body, colour), surface), whole)| {
        let (corners, triangles) = compact(&surface.corners, &surface.triangles);
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
fn merged(faces: &[Face], cell: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut known: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let mut corners = Vec::new();
    let mut triangles = Vec::new();
    for face in faces {
        let triangle = face.corners.map(|corner| {
            let place = (corner / cell).to_array();
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

    #[test]
    fn sharp_edges_stay_where_they_are_and_part_the_faces_that_meet_there() {
        // A cube of 20 mm, each face in 20 x 20 squares.
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
            let [out, along] = [side * axes[axis], axes[(axis + 1) % 3]];
            let across = out.cross(along);
            let first = vertices.len() as u32;
            for (i, j) in (0..=20_u32).flat_map(|i| (0..=20_u32).map(move |j| (i, j))) {
                let [u, v] = [i, j].map(|step| 1e-3 * f64::from(step) - 0.01);
                vertices.push(0.01 * out + u * along + v * across);
                if i < 20 && j < 20 {
                    let at = |i: u32, j: u32| first + 21 * i + j;
                    triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                    triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        let mut scene = ball(0.1);
        scene.bodies[0].shapes[0].geometry = VisualShape::Mesh {
            vertices,
            triangles,
        };
        let solid = &solids(&scene, 0, 100)[0];
        assert!(solid.triangles.len() <= 100 && solid.whole == 4800);
        assert!((volume(solid) / 8e-6 - 1.0).abs() < 1e-9);
        let normal = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|index| solid.corners[index as usize]);
            (b - a).cross(c - a).normalize()
        };
        for corner in 0..solid.corners.len() as u32 {
            let own = solid.triangles.iter().filter(|t| t.contains(&corner));
            let normals: Vec<DVec3> = own.map(|triangle| normal(*triangle)).collect();
            assert!(normals.iter().all(|n| n.dot(normals[0]) > 0.999));
        }
    }
}
