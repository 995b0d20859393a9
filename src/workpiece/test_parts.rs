//! Parts for unit tests.

use glam::DVec3;

use super::TriangleMesh;

/// A cube of 0.1 m whose top outline is a closed loop with four corners.
pub(crate) fn cube() -> TriangleMesh {
    let corner = |i: usize| {
        DVec3::new(
            0.1 * (i & 1) as f64,
            0.1 * (i >> 1 & 1) as f64,
            0.1 * (i >> 2 & 1) as f64,
        )
    };
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}
