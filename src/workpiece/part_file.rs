//! Reading a part from a mesh file: one closed surface in metres, z up.

use std::path::Path;

use glam::DVec3;

use super::error::{MeshFault, WorkpieceError, require};
use super::mesh::TriangleMesh;
use crate::mesh_file::{self, Up};

/// A part's file as it is read: loose triangles.
#[derive(Debug, Clone)]
pub struct PartFile {
    /// Points with z up, in metres where the file states its unit, else in its unit.
    pub points: Vec<DVec3>,
    /// Triangles as indices of points.
    pub triangles: Vec<[u32; 3]>,
    /// Whether the file states its unit, as COLLADA and glTF do.
    pub states_unit: bool,
    /// What a user should know of how it was read.
    notes: Vec<String>,
    doubtful: Option<String>,
}

impl PartFile {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, is malformed or of another format.
    pub fn read(path: &Path) -> Result<Self, WorkpieceError> {
        let file = mesh_file::read(path)?;
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for part in &file.parts {
            let base = points.len() as u32;
            points.extend(part.points.iter().map(|point| file.up.z_up(*point)));
            triangles.extend(
                part.triangles
                    .iter()
                    .map(|triangle| triangle.map(|corner| base + corner)),
            );
        }
        let mut notes = file.notes;
        if file.up != Up::Z {
            notes.push(format!(
                "{} is up in it: turned so that z is",
                file.up.axis()
            ));
        }
        Ok(Self {
            points,
            triangles,
            states_unit: file.in_metres,
            notes,
            doubtful: file.doubtful,
        })
    }

    /// The part. `scale` is the length of the file's unit [m]: 0.001 for a file in millimetres. It multiplies the unit that a file
    /// states, so it is normally 1 there.
    ///
    /// # Errors
    /// Its surface has a fault that cannot be mended.
    pub fn mesh(&self, scale: f64) -> Result<TriangleMesh, MeshFault> {
        if let Some(reason) = self.doubtful.clone() {
            return Err(MeshFault::Doubtful { reason });
        }
        let mesh = TriangleMesh::from_loose_triangles(&self.points, &self.triangles, scale)?;
        let mut notes = self.notes.clone();
        if self.states_unit && scale != 1.0 {
            let (low, high) = mesh.bounds();
            notes.push(format!(
                "its file states a unit of its own, which the unit given multiplies by {scale}: {:.3} mm long; `m` takes it as the file has it",
                1e3 * (high - low).max_element()
            ));
        }
        Ok(mesh.with_notes(notes))
    }
}

/// Reads a part. `scale` is the length of the file's unit [m], as in [`PartFile::mesh`].
///
/// # Errors
/// The file cannot be read, is malformed or of another format, or its surface has a fault.
pub fn load_mesh(path: &Path, scale: f64) -> Result<TriangleMesh, WorkpieceError> {
    require(
        "mesh scale [m per file unit]",
        scale,
        scale > 0.0,
        "a positive number",
    )?;
    PartFile::read(path)?
        .mesh(scale)
        .map_err(|fault| WorkpieceError::Mesh {
            file: path.to_owned(),
            fault,
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workpiece::mesh::shapes::gridded_box;
    use std::fmt::Write as _;
    use std::path::PathBuf;

    /// A 100 x 20 x 10 mm box in millimetres, off the origin so that coordinates round.
    fn part() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let (low, high) = (DVec3::new(0.1, -3.3, 7.7), DVec3::new(100.1, 16.7, 17.7));
        let metres = gridded_box(low * 1e-3, high * 1e-3, 3);
        let vertices = metres.vertices().iter();
        (
            vertices.map(|&v| (v * 1e3).as_vec3().to_array()).collect(),
            metres.triangles().to_vec(),
        )
    }

    fn binary_stl() -> Vec<u8> {
        let (vertices, triangles) = part();
        let mut bytes = vec![0; 80];
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            for coordinate in triangle.iter().flat_map(|&v| vertices[v as usize]) {
                bytes.extend(coordinate.to_le_bytes());
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn text_stl() -> String {
        let (vertices, triangles) = part();
        let mut text = "solid part\n".to_owned();
        for triangle in triangles {
            text += " facet normal 0 0 0\n  outer loop\n";
            for [x, y, z] in triangle.map(|v| vertices[v as usize]) {
                writeln!(text, "   vertex {x} {y} {z}").unwrap();
            }
            text += "  endloop\n endfacet\n";
        }
        text + "endsolid part\n"
    }

    fn obj() -> String {
        let (vertices, triangles) = part();
        let mut text = String::new();
        for [x, y, z] in vertices {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        for [a, b, c] in triangles {
            writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
        }
        text
    }

    fn collada(up_axis: &str, matrix: &str) -> String {
        let (vertices, triangles) = part();
        let numbers: Vec<String> = vertices.iter().flatten().map(f32::to_string).collect();
        let indices: Vec<String> = triangles.iter().flatten().map(u32::to_string).collect();
        format!(
            r##"<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>{up_axis}</up_axis></asset>
<library_geometries><geometry id="part"><mesh>
<source id="p"><float_array id="pa" count="{}">{}</float_array><technique_common>
<accessor source="#pa" count="{}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{}"><input semantic="VERTEX" source="#v" offset="0"/><p>{}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node id="n"><matrix>{matrix}</matrix><instance_geometry url="#part"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>"##,
            numbers.len(),
            numbers.join(" "),
            vertices.len(),
            triangles.len(),
            indices.join(" ")
        )
    }

    const IDENTITY: &str = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";

    fn load(name: &str, bytes: &[u8], scale: f64) -> Result<TriangleMesh, WorkpieceError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        load_mesh(&path, scale)
    }

    #[test]
    fn all_formats_give_the_same_part_in_metres() {
        let dae = collada("Z_UP", IDENTITY);
        for (name, bytes, scale) in [
            ("part.stl", binary_stl(), 1e-3),
            ("text.STL", text_stl().into_bytes(), 1e-3),
            ("part.obj", obj().into_bytes(), 1e-3),
            ("part.dae", dae.into_bytes(), 1.0),
        ] {
            let mesh = load(name, &bytes, scale).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(mesh.vertices().len(), 56, "{name}");
            assert!(
                (mesh.volume() - 100e-3 * 20e-3 * 10e-3).abs() < 1e-11,
                "{name}"
            );
            let (low, high) = mesh.bounds();
            assert!(
                low.distance(DVec3::new(0.1, -3.3, 7.7) * 1e-3) < 1e-8,
                "{name}"
            );
            assert!(
                high.distance(DVec3::new(100.1, 16.7, 17.7) * 1e-3) < 1e-8,
                "{name}"
            );
        }
    }

    #[test]
    fn wrong_scale_suggests_millimetres() {
        let error = load("part.stl", &binary_stl(), 1.0).unwrap_err();
        assert!(matches!(
            error,
            WorkpieceError::Mesh { fault: MeshFault::Implausible { extent, .. }, .. } if (extent - 100.0).abs() < 1e-4
        ));
        assert!(error.to_string().contains("millimetres"));
        assert!(load("part.stl", &binary_stl(), -1.0).is_err());
        assert!(load("part.stl", &binary_stl(), f64::NAN).is_err());
    }

    #[test]
    fn broken_files_are_refused_with_the_reason() {
        let missing = load_mesh(&PathBuf::from("/nowhere/part.stl"), 1.0).unwrap_err();
        assert!(
            missing
                .to_string()
                .contains("cannot read /nowhere/part.stl")
        );
        let stl = binary_stl();
        let text = text_stl();
        for (name, bytes, expected) in [
            ("part.step", stl.clone(), "a STEP file"),
            ("part.text", stl.clone(), "unknown mesh format"),
            ("short.stl", stl[..60].to_vec(), "too few"),
            // Cut at a whole triangle: only the header's count tells.
            (
                "cut.stl",
                stl[..84 + 50 * 20].to_vec(),
                "announces 108 triangles",
            ),
            (
                "cut_text.stl",
                text.as_bytes()[..text.len() / 2].to_vec(),
                "malformed",
            ),
            (
                "empty.stl",
                b"solid a\nendsolid a\n".to_vec(),
                "no triangle",
            ),
            ("empty.obj", Vec::new(), "no triangle"),
            (
                "index.obj",
                b"v 0 0 0\nv 1 0 0\nf 1 2 7\n".to_vec(),
                "malformed",
            ),
            ("word.obj", b"v 0 zero 0\n".to_vec(), "malformed"),
            ("fan.obj", b"f 1 2 3 4 5\n".to_vec(), "line 1"),
            (
                "cut.dae",
                b"<COLLADA><up_axis>Z_UP</up_axis>".to_vec(),
                "malformed",
            ),
        ] {
            let message = load(name, &bytes, 1e-3).unwrap_err().to_string();
            assert!(message.contains(expected), "{name}: {message}");
            assert!(message.contains(name), "{name}: {message}");
        }
    }

    #[test]
    fn open_and_non_finite_surfaces_are_refused_and_inverted_ones_turned() {
        let message = |bytes: &[u8]| load("part.stl", bytes, 1e-3).unwrap_err().to_string();
        // The side at the largest x is missing.
        let open = binary_stl();
        let kept = open[84..].chunks_exact(50).filter(|record| {
            let x = |corner: usize| {
                f32::from_le_bytes(
                    record[12 + 12 * corner..16 + 12 * corner]
                        .try_into()
                        .unwrap(),
                )
            };
            (0..3).any(|corner| x(corner) < 100.0)
        });
        let kept: Vec<u8> = kept.flatten().copied().collect();
        let mut open = open[..80].to_vec();
        open.extend((kept.len() as u32 / 50).to_le_bytes());
        open.extend(kept);
        let refused = message(&open);
        assert!(
            refused.contains("12 open edges") && refused.contains("open at (100.1, "),
            "{refused}"
        );
        let mut infinite = binary_stl();
        infinite[84 + 12..84 + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(message(&infinite).contains("not a finite number"));
        let mut inverted = binary_stl();
        for triangle in inverted[84..].chunks_exact_mut(50) {
            let (first, rest) = triangle[12..48].split_at_mut(12);
            first.swap_with_slice(&mut rest[..12]);
        }
        let turned = load("part.stl", &inverted, 1e-3).unwrap();
        assert!((turned.volume() - 100e-3 * 20e-3 * 10e-3).abs() < 1e-11);
        assert!(
            turned.notes()[0].contains("108 faces, all wound inwards turned"),
            "{:?}",
            turned.notes()
        );
    }

    #[test]
    fn axes_and_transforms_of_collada_are_honoured_and_a_unit_beside_its_own_is_reported() {
        let part = |text: String, scale| load("part.dae", text.as_bytes(), scale).unwrap();
        let turned = part(collada("Y_UP", IDENTITY), 1.0);
        let (low, _) = turned.bounds();
        assert!(
            low.distance(DVec3::new(0.1, -17.7, -3.3) * 1e-3) < 1e-8,
            "{low}"
        );
        assert!(turned.notes()[0].contains("y is up"));
        let moved = IDENTITY.replacen("1 0 0 0", "1 0 0 9", 1);
        let moved = part(collada("Z_UP", &moved), 1.0);
        assert!((moved.bounds().0.x - 9.1e-3).abs() < 1e-8);
        assert!(moved.notes().is_empty());
        let inches = part(collada("Z_UP", IDENTITY), 25.4);
        assert!(
            inches.notes()[0].contains("2540.000 mm long"),
            "{:?}",
            inches.notes()
        );
    }

    #[test]
    fn shared_vertices_differing_in_the_last_bits_leave_no_crack() {
        let mut bytes = binary_stl();
        for (triangle, record) in bytes[84..].chunks_exact_mut(50).enumerate() {
            for corner in 0..9 {
                let place = 12 + 4 * corner..16 + 4 * corner;
                let bits = u32::from_le_bytes(record[place.clone()].try_into().unwrap());
                let jitter = ((triangle * 7 + corner * 3) % 4) as u32;
                record[place].copy_from_slice(&(bits + jitter).to_le_bytes());
            }
        }
        let mesh = load("part.stl", &bytes, 1e-3).unwrap();
        assert_eq!(mesh.vertices().len(), 56);
    }
}
