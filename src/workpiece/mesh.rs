//! A part's surface as a closed mesh of triangles with outward normals.

use glam::DVec3;

use super::error::{EdgeFault, MeshFault, NO_VOLUME};
use super::mend::{Mended, mended};
use super::repair::{connect, extent};
use super::topology::Topology;

/// Smallest and largest plausible part [m].
const PLAUSIBLE_EXTENT: [f64; 2] = [1e-3, 10.0];

/// A closed, orientable, outward-facing triangle surface in the part frame.
#[derive(Debug, Clone)]
pub struct TriangleMesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    face_normals: Vec<DVec3>,
    topology: Topology,
    mended: Vec<Mended>,
    notes: Vec<String>,
}

impl TriangleMesh {
    /// Takes triangles with shared vertices [m], counter-clockwise seen from outside, and checks them.
    ///
    /// # Errors
    /// The first fault of the surface.
    pub fn new(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshFault> {
        check_numbers(&vertices, &triangles)?;
        if triangles.is_empty() {
            return Err(MeshFault::Empty);
        }
        let topology = Topology::new(&triangles).map_err(|faults| {
            let edge = |fault: EdgeFault<u32>| EdgeFault {
                flaw: fault.flaw,
                ends: fault.ends.map(|vertex| vertices[vertex as usize]),
            };
            MeshFault::NotClosed {
                edges: faults.into_iter().map(edge).collect(),
            }
        })?;
        let face_normals = triangles
            .iter()
            .enumerate()
            .map(|(triangle, corners)| {
                let [a, b, c] = corners.map(|vertex| vertices[vertex as usize]);
                (b - a)
                    .cross(c - a)
                    .try_normalize()
                    .ok_or(MeshFault::NoArea { triangle, place: a })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let mesh = Self {
            vertices,
            triangles,
            face_normals,
            topology,
            mended: Vec::new(),
            notes: Vec::new(),
        };
        let volume = mesh.volume();
        if volume < NO_VOLUME {
            return Err(MeshFault::InsideOut { volume });
        }
        Ok(mesh)
    }

    /// Builds the surface from loose triangles in any unit: scales to metres, merges vertices, drops
    /// triangles without area, mends small flaws, and checks the result.
    ///
    /// # Errors
    /// The first fault of the surface.
    pub fn from_loose_triangles(
        points: &[DVec3],
        triangles: &[[u32; 3]],
        scale: f64,
    ) -> Result<Self, MeshFault> {
        check_numbers(points, triangles)?;
        let scaled: Vec<DVec3> = points.iter().map(|&point| point * scale).collect();
        let used: Vec<DVec3> = triangles
            .iter()
            .flatten()
            .map(|&vertex| scaled[vertex as usize])
            .collect();
        if used.is_empty() {
            return Err(MeshFault::Empty);
        }
        let extent = extent(&used);
        if !(PLAUSIBLE_EXTENT[0]..=PLAUSIBLE_EXTENT[1]).contains(&extent) {
            return Err(MeshFault::Implausible { extent, scale });
        }
        let corners: Vec<[u32; 3]> = (0..triangles.len() as u32)
            .map(|triangle| [3 * triangle, 3 * triangle + 1, 3 * triangle + 2])
            .collect();
        let (vertices, triangles, mended) = mended(&connect(&used, &corners));
        let mesh = Self::new(vertices, triangles)?;
        let notes = mended.iter().map(Mended::note).collect();
        Ok(Self {
            mended,
            notes,
            ..mesh
        })
    }

    /// The surface with notes on how its file was read before those on what was mended.
    #[must_use]
    pub(crate) fn with_notes(mut self, mut notes: Vec<String>) -> Self {
        notes.append(&mut self.notes);
        self.notes = notes;
        self
    }

    /// What was mended of the file's surface, and where.
    pub fn mended(&self) -> &[Mended] {
        &self.mended
    }

    /// What a user should know of how the file was read and what of it was mended, a sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Vertices in the part frame [m].
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Triangles as vertex indices, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Outward unit normal of each triangle.
    pub fn face_normals(&self) -> &[DVec3] {
        &self.face_normals
    }

    /// Enclosed volume [m^3], by the divergence theorem.
    pub fn volume(&self) -> f64 {
        let origin = self.vertices[self.triangles[0][0] as usize];
        let sum: f64 = self
            .triangles
            .iter()
            .map(|corners| corners.map(|vertex| self.vertices[vertex as usize] - origin))
            .map(|[a, b, c]| a.dot(b.cross(c)))
            .sum();
        sum / 6.0
    }

    /// Opposite corners of the bounding box in the part frame [m].
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let first = self.vertices[0];
        self.vertices
            .iter()
            .fold((first, first), |(low, high), &vertex| {
                (low.min(vertex), high.max(vertex))
            })
    }

    /// Connectivity of the half-edges.
    pub(crate) fn topology(&self) -> &Topology {
        &self.topology
    }
}

fn check_numbers(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), MeshFault> {
    if let Some(vertex) = vertices.iter().position(|vertex| !vertex.is_finite()) {
        return Err(MeshFault::NonFinite { vertex });
    }
    let count = vertices.len();
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
            return Err(MeshFault::VertexIndex {
                triangle,
                vertex,
                count,
            });
        }
    }
    Ok(())
}

/// Shapes that the tests of this module share.
#[cfg(test)]
pub(crate) mod shapes {
    use super::*;

    /// A box between two corners; each side is a grid of `cells` x `cells` squares.
    pub(crate) fn gridded_box(low: DVec3, high: DVec3, cells: usize) -> TriangleMesh {
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for axis in 0..3 {
            for far in [false, true] {
                let mut corner = low;
                let (mut u, mut v) = (DVec3::ZERO, DVec3::ZERO);
                let size = high - low;
                u[(axis + 1) % 3] = size[(axis + 1) % 3];
                v[(axis + 2) % 3] = size[(axis + 2) % 3];
                if far {
                    corner[axis] = high[axis];
                } else {
                    std::mem::swap(&mut u, &mut v);
                }
                for i in 0..cells {
                    for j in 0..cells {
                        let at = |i: usize, j: usize| {
                            corner + u * (i as f64 / cells as f64) + v * (j as f64 / cells as f64)
                        };
                        let base = points.len() as u32;
                        points.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                        triangles.push([base, base + 1, base + 2]);
                        triangles.push([base, base + 2, base + 3]);
                    }
                }
            }
        }
        TriangleMesh::from_loose_triangles(&points, &triangles, 1.0).unwrap()
    }

    /// A polygon in x, y (counter-clockwise, triangulated as given) swept from z = -depth to 0.
    pub(crate) fn prism(outline: &[[f64; 2]], caps: &[[u32; 3]], depth: f64) -> TriangleMesh {
        let count = outline.len() as u32;
        let level = |z: f64| outline.iter().map(move |&[x, y]| DVec3::new(x, y, z));
        let vertices: Vec<DVec3> = level(0.0).chain(level(-depth)).collect();
        let mut triangles = caps.to_vec();
        triangles.extend(
            caps.iter()
                .map(|&[a, b, c]| [a + count, c + count, b + count]),
        );
        for from in 0..count {
            let to = (from + 1) % count;
            triangles.push([from, from + count, to + count]);
            triangles.push([from, to + count, to]);
        }
        TriangleMesh::new(vertices, triangles).unwrap()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_has_the_volume_and_normals_of_a_box() {
        let mesh = shapes::gridded_box(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.2, 0.5, 0.4), 3);
        assert!((mesh.volume() - 0.1 * 0.3 * 0.1).abs() < 1e-15);
        assert_eq!(mesh.triangles().len(), 6 * 9 * 2);
        assert_eq!(mesh.vertices().len(), 56);
        let centre = DVec3::new(0.15, 0.35, 0.35);
        for (corners, normal) in mesh.triangles().iter().zip(mesh.face_normals()) {
            let point = mesh.vertices()[corners[0] as usize];
            assert!(normal.dot(point - centre) > 0.0);
        }
    }

    #[test]
    fn faults_are_named() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let inward = vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
        let fault = TriangleMesh::new(vertices.clone(), inward).unwrap_err();
        assert!(
            matches!(fault, MeshFault::InsideOut { volume } if (volume + 1.0 / 6.0).abs() < 1e-12)
        );
        let fault = TriangleMesh::new(vertices.clone(), vec![[0, 1, 9]]).unwrap_err();
        assert!(matches!(fault, MeshFault::VertexIndex { vertex: 9, .. }));
        let mut broken = vertices.clone();
        broken[2].y = f64::NAN;
        let fault = TriangleMesh::new(broken, vec![[0, 1, 2]]).unwrap_err();
        assert_eq!(fault, MeshFault::NonFinite { vertex: 2 });
        let fault = TriangleMesh::from_loose_triangles(&vertices, &[[0, 2, 1]], 300.0).unwrap_err();
        assert!(fault.to_string().contains("300 m"));
        assert!(fault.to_string().contains("mesh_unit"));
    }
}
