//! Bodies of a scene as meshes in the world, few enough triangles for a page.

use std::collections::BTreeMap;

use glam::DVec3;

use super::faces::{Face, faces};
use crate::recording::scene::{Colour, Scene};

/// Cells along the longest side of what is simplified, at first.
const FINEST: f64 = 1024.0;
/// Triangles that a body keeps in any case.
const LEAST: usize = 50;

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

/// The bodies at a frame; where they have more triangles than `most` together, each is simplified to its share.
pub(super) fn solids(scene: &Scene, frame: usize, most: usize) -> Vec<Solid> {
    let mut groups: BTreeMap<(u16, Colour), Vec<Face>> = BTreeMap::new();
    let all = faces(scene, frame, |_| true);
    let share = most as f64 / all.len().max(1) as f64;
    for face in all {
        let own = groups.entry((face.body, face.colour));
        own.or_default().push(face);
    }
    let solid = |((body, colour), faces): ((u16, Colour), Vec<Face>)| {
        let most = (share * faces.len() as f64) as usize;
        let (corners, triangles, whole) = simplified(&faces, most.max(LEAST));
        Solid {
            entity: scene.bodies[usize::from(body) - 1].entity.clone(),
            colour,
            corners,
            triangles,
            whole,
        }
    };
    groups.into_iter().map(solid).collect()
}

/// Triangles over shared corners; where there are too many, corners in one cell of a grid become one. Beside them how many there are.
fn simplified(faces: &[Face], most: usize) -> (Vec<DVec3>, Vec<[u32; 3]>, usize) {
    let corners = || faces.iter().flat_map(|face| face.corners);
    let start = corners().next().unwrap_or_default();
    let (low, high) = corners().fold((start, start), |(low, high), corner| {
        (low.min(corner), high.max(corner))
    });
    // As fine as the page's numbers, so that equal corners are one.
    let (corners, triangles) = merged(faces, low, 1e-8);
    let whole = triangles.len();
    if whole <= most {
        return (corners, triangles, whole);
    }
    let mut cell = (high - low).max_element() / FINEST;
    loop {
        let (corners, triangles) = merged(faces, low, cell);
        if triangles.len() <= most {
            return (corners, triangles, whole);
        }
        cell *= 1.5;
    }
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
    use crate::recording::scene::{SceneBody, SceneGeometry, ScenePoses, SceneShape};

    fn ball(radius: f64) -> Scene {
        Scene {
            bodies: vec![SceneBody {
                entity: "ball".to_owned(),
                shapes: vec![SceneShape {
                    body_from_shape: DPose3::IDENTITY,
                    geometry: SceneGeometry::Sphere { radius },
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
        assert!((100..=300).contains(&few.triangles.len()) && few.whole == 960);
        assert!((volume(few) / volume(exact) - 1.0).abs() < 0.1);
        assert_eq!(few.entity, "ball");
    }
}
