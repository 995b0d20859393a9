//! Vertex normals for shading: smooth across gentle bends, sharp at edges.

use std::collections::BTreeMap;

use glam::DVec3;

/// Faces that meet at a smaller angle than this are shaded as one surface [rad].
const CREASE_ANGLE: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// A mesh with one normal per vertex and three vertices per triangle.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ShadedMesh {
    /// Triangle corners, three in a row per triangle [m].
    pub(super) positions: Vec<[f32; 3]>,
    /// Their unit normals.
    pub(super) normals: Vec<[f32; 3]>,
}

/// Gives every triangle corner the mean normal of the faces that meet there without a crease,
/// weighted by area. Triangles without area are left out. Indices must be in range.
pub(super) fn shade(vertices: &[DVec3], triangles: &[[u32; 3]]) -> ShadedMesh {
    let mut faces: Vec<([DVec3; 3], DVec3)> = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let corners = triangle.map(|index| vertices[index as usize]);
        let doubled_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if doubled_area.length() > 0.0 {
            faces.push((corners, doubled_area));
        }
    }
    // STL repeats every corner, so faces are joined by position and not by index.
    let mut around: BTreeMap<[u64; 3], Vec<DVec3>> = BTreeMap::new();
    for (corners, doubled_area) in &faces {
        for corner in corners {
            around.entry(key(*corner)).or_default().push(*doubled_area);
        }
    }
    let mut mesh = ShadedMesh::default();
    for (corners, doubled_area) in &faces {
        for corner in corners {
            let smooth = around[&key(*corner)]
                .iter()
                .filter(|other| other.angle_between(*doubled_area) < CREASE_ANGLE)
                .sum::<DVec3>();
            mesh.positions.push(corner.as_vec3().to_array());
            mesh.normals
                .push(smooth.normalize_or(*doubled_area).as_vec3().to_array());
        }
    }
    mesh
}

/// Key of a position; adding zero makes both zeros equal.
fn key(position: DVec3) -> [u64; 3] {
    (position + DVec3::ZERO).to_array().map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_stays_sharp() {
        let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        // Faces in the planes z = 0 (seen from below) and y = 0 share the x axis.
        let mesh = shade(&vertices, &[[0, 2, 1], [0, 1, 3]]);
        assert_eq!(mesh.normals[..3], [[0.0, 0.0, -1.0]; 3]);
        assert_eq!(mesh.normals[3..], [[0.0, -1.0, 0.0]; 3]);
    }

    #[test]
    fn a_gentle_bend_is_shaded_smooth_and_empty_triangles_vanish() {
        // Two faces either side of the x axis, bent by twice 5 degrees.
        let (sine, cosine) = 5.0_f64.to_radians().sin_cos();
        let left = DVec3::new(0.0, cosine, -sine);
        let right = DVec3::new(0.0, -cosine, -sine);
        let vertices = [DVec3::ZERO, DVec3::X, left, right];
        let mesh = shade(&vertices, &[[0, 1, 2], [1, 0, 3], [0, 0, 1]]);
        assert_eq!(mesh.positions.len(), 6);
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let expected_y = match position[1] {
                y if y > 0.5 => sine,
                y if y < -0.5 => -sine,
                _ => 0.0,
            };
            assert!(
                (f64::from(normal[1]) - expected_y).abs() < 1e-6,
                "{position:?} {normal:?}"
            );
        }
    }
}
