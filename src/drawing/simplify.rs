//! Bodies with fewer triangles, by meshoptimizer: what is flat loses its own first, and edges and bores keep their form.

use std::iter::successors;

use glam::DVec3;
use meshopt::{SimplifyOptions, simplify_decoder};

/// Cosine of the angle between two faces beyond which the edge between them is sharp [1].
const SHARP: f64 = 0.88;
/// Errors that are allowed, as shares of a body's size [1]: the first, what each has over the one before, and the last.
const ERRORS: [f64; 3] = [5e-5, 1.41, 0.3];
/// From here on edges may go too: where nothing else is left, fewer triangles come before a form that nobody sees any more.
const EDGES_GO: f64 = 0.02;

/// A body's surface; faces that meet at a sharp edge do not share its corners.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Surface {
    /// Corners [m].
    pub(super) corners: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// At most so many triangles together, as far as that is possible, each body with the same error for its size.
pub(super) fn simplify(bodies: &mut [Surface], most: usize) {
    let [first, ratio, last] = ERRORS;
    let errors = successors(Some(first), |error| Some(ratio * error));
    for error in errors.take_while(|error| *error < last) {
        let count: usize = bodies.iter().map(|body| body.triangles.len()).sum();
        if count <= most {
            break;
        }
        for body in &mut *bodies {
            body.triangles = simplified(body, error);
        }
    }
}

fn simplified(body: &Surface, error: f64) -> Vec<[u32; 3]> {
    let origin = body.corners.first().copied().unwrap_or_default();
    let places = body.corners.iter();
    let places: Vec<[f32; 3]> = places
        .map(|corner| (*corner - origin).as_vec3().to_array())
        .collect();
    let mut options = SimplifyOptions::Prune;
    options.set(SimplifyOptions::Permissive, error > EDGES_GO);
    let indices = body.triangles.as_flattened();
    let kept = simplify_decoder(indices, &places, 0, error as f32, options, None);
    kept.as_chunks::<3>().0.to_vec()
}

/// A surface in which a corner is one for faces that pass smoothly into one another there, and several where an edge is sharp.
pub(super) fn split_at_edges(corners: &[DVec3], triangles: &[[u32; 3]]) -> Surface {
    let normal = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| corners[corner as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let normals: Vec<DVec3> = triangles.iter().copied().map(normal).collect();
    // Of each side its ends, and where in the list of all triangles' corners they stand.
    let mut sides: Vec<([u32; 2], [usize; 2])> = Vec::with_capacity(3 * triangles.len());
    for (number, triangle) in triangles.iter().enumerate() {
        for side in 0..3 {
            let ends = [side, (side + 1) % 3];
            let mut places = ends.map(|end| (triangle[end], 3 * number + end));
            places.sort_unstable();
            sides.push((places.map(|place| place.0), places.map(|place| place.1)));
        }
    }
    sides.sort_unstable();
    let mut groups: Vec<usize> = (0..3 * triangles.len()).collect();
    for shared in sides.chunk_by(|one, other| one.0 == other.0) {
        if let [(_, one), (_, other)] = shared
            && normals[one[0] / 3].dot(normals[other[0] / 3]) > SHARP
        {
            join(&mut groups, one[0], other[0]);
            join(&mut groups, one[1], other[1]);
        }
    }
    let mut numbers = vec![u32::MAX; groups.len()];
    let mut surface = Surface {
        corners: Vec::new(),
        triangles: Vec::with_capacity(triangles.len()),
    };
    for (number, triangle) in triangles.iter().enumerate() {
        surface.triangles.push([0, 1, 2].map(|end| {
            let group = first_of(&mut groups, 3 * number + end);
            if numbers[group] == u32::MAX {
                numbers[group] = surface.corners.len() as u32;
                surface.corners.push(corners[triangle[end] as usize]);
            }
            numbers[group]
        }));
    }
    surface
}

/// The member that stands for a group.
fn first_of(groups: &mut [usize], mut member: usize) -> usize {
    while groups[member] != member {
        groups[member] = groups[groups[member]];
        member = groups[member];
    }
    member
}

/// Makes one group of two.
fn join(groups: &mut [usize], one: usize, other: usize) {
    let [one, other] = [one, other].map(|member| first_of(groups, member));
    groups[one.max(other)] = one.min(other);
}
