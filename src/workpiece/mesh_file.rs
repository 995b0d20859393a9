//! Reading a part's mesh from STL (binary or text), Wavefront OBJ or COLLADA (.dae).
//!
//! The formats are parsed by the `mesh-loader` crate, which keeps 32-bit coordinates. What it would
//! pass over in silence is refused here: a binary STL of another length than its header says, OBJ
//! faces that a fan may fold, and COLLADA node transforms and axes, which it does not apply reliably.

use std::ffi::OsStr;
use std::path::Path;

use glam::DVec3;
use mesh_loader::Scene;

use super::error::{WorkpieceError, require};
use super::mesh::TriangleMesh;

/// Length of a binary STL's header with the triangle count, and of each triangle [bytes].
const STL_HEADER: usize = 84;
const STL_TRIANGLE: usize = 50;

/// Most corners of an OBJ face: larger ones may be concave, and are split as fans.
const OBJ_CORNERS: usize = 4;

/// Reads a part. `scale` is the length of the file's unit [m]: 0.001 for a file in millimetres.
/// A COLLADA file states its unit; `scale` multiplies it, so it is normally 1 there.
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
    let extension = path
        .extension()
        .and_then(OsStr::to_str)
        .map(str::to_ascii_lowercase)
        .unwrap_or_default();
    let parse = match extension.as_str() {
        "stl" => parse_stl,
        "obj" => parse_obj,
        "dae" => parse_collada,
        _ => {
            return Err(WorkpieceError::Format {
                file: path.to_owned(),
            });
        }
    };
    let bytes = std::fs::read(path).map_err(|source| WorkpieceError::Read {
        file: path.to_owned(),
        source,
    })?;
    let scene = parse(path, &bytes)?;
    let (points, triangles) = flatten(path, &scene)?;
    TriangleMesh::from_loose_triangles(&points, &triangles, scale).map_err(|fault| {
        WorkpieceError::Mesh {
            file: path.to_owned(),
            fault,
        }
    })
}

fn malformed(path: &Path, reason: impl ToString) -> WorkpieceError {
    WorkpieceError::Malformed {
        file: path.to_owned(),
        reason: reason.to_string(),
    }
}

fn unsupported(path: &Path, feature: impl ToString, remedy: &'static str) -> WorkpieceError {
    WorkpieceError::Unsupported {
        file: path.to_owned(),
        feature: feature.to_string(),
        remedy,
    }
}

fn parse_stl(path: &Path, bytes: &[u8]) -> Result<Scene, WorkpieceError> {
    // Binary headers may begin with "solid" too; a text file also names facets or ends at once.
    let start = bytes.trim_ascii_start();
    let head = &start[..start.len().min(1024)];
    let has = |word: &[u8]| head.windows(word.len()).any(|window| window == word);
    let is_text = start.starts_with(b"solid") && (has(b"facet") || has(b"endsolid"));
    if !is_text {
        let Some(count) = bytes.get(STL_HEADER - 4..STL_HEADER) else {
            return Err(malformed(
                path,
                format!(
                    "{} bytes are too few for an STL header of {STL_HEADER}",
                    bytes.len()
                ),
            ));
        };
        let declared = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
        let present = bytes.len() - STL_HEADER;
        if declared * STL_TRIANGLE != present {
            return Err(malformed(
                path,
                format!(
                    "the STL header announces {declared} triangles ({} bytes), but {present} bytes follow it",
                    declared * STL_TRIANGLE
                ),
            ));
        }
    }
    mesh_loader::stl::from_slice(bytes).map_err(|error| malformed(path, error))
}

fn parse_obj(path: &Path, bytes: &[u8]) -> Result<Scene, WorkpieceError> {
    for (line, text) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let mut words = text
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        if words.next() == Some(b"f".as_slice()) && words.count() > OBJ_CORNERS {
            return Err(unsupported(
                path,
                format!(
                    "an OBJ face of more than {OBJ_CORNERS} corners (line {})",
                    line + 1
                ),
                "export the part with triangles",
            ));
        }
    }
    // Materials are of no interest, so that their files are not opened.
    let no_materials = |_: &Path| Err::<Vec<u8>, _>(std::io::ErrorKind::NotFound.into());
    mesh_loader::obj::from_slice(bytes, None, no_materials).map_err(|error| malformed(path, error))
}

fn parse_collada(path: &Path, bytes: &[u8]) -> Result<Scene, WorkpieceError> {
    let text = std::str::from_utf8(bytes).map_err(|error| malformed(path, error))?;
    let up_axis = element_texts(text, "up_axis").next().map(str::trim);
    if up_axis != Some("Z_UP") {
        return Err(unsupported(
            path,
            format!("COLLADA up_axis {}", up_axis.unwrap_or("Y_UP (not stated)")),
            "export the part with Z_UP, or as STL",
        ));
    }
    for transform in ["translate", "rotate", "scale", "skew", "lookat", "matrix"] {
        for values in element_texts(text, transform) {
            if !is_identity(transform, values) {
                return Err(unsupported(
                    path,
                    format!("COLLADA node transform <{transform}>"),
                    "apply all transforms before exporting, or export as STL",
                ));
            }
        }
    }
    // The parser indexes a malformed file's arrays unchecked.
    std::panic::catch_unwind(|| mesh_loader::collada::from_slice(bytes))
        .map_err(|_| malformed(path, "the COLLADA indices do not fit their arrays"))?
        .map_err(|error| malformed(path, error))
}

/// The texts of all `<name ...>text</name>`.
fn element_texts<'a>(text: &'a str, name: &'a str) -> impl Iterator<Item = &'a str> {
    text.split('<').filter_map(move |piece| {
        let rest = piece.strip_prefix(name)?;
        let (attributes, content) = rest.split_once('>')?;
        (attributes.is_empty() || attributes.starts_with(char::is_whitespace)).then_some(content)
    })
}

/// Whether a COLLADA transform leaves everything where it is.
fn is_identity(transform: &str, values: &str) -> bool {
    let numbers: Vec<f64> = values
        .split_whitespace()
        .map(|word| word.parse().unwrap_or(f64::NAN))
        .collect();
    let is = |expected: &[f64]| numbers == expected;
    match transform {
        "translate" => is(&[0.0; 3]),
        "scale" => is(&[1.0; 3]),
        "rotate" => numbers.len() == 4 && numbers[3] == 0.0,
        "matrix" => is(&[
            1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,
        ]),
        _ => false,
    }
}

/// All meshes of a scene as one list of points and triangles.
fn flatten(path: &Path, scene: &Scene) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), WorkpieceError> {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for mesh in &scene.meshes {
        let base = points.len() as u32;
        points.extend(
            mesh.vertices
                .iter()
                .map(|vertex| DVec3::from_array(vertex.map(f64::from))),
        );
        for face in &mesh.faces {
            if let Some(vertex) = face.iter().find(|&&v| v as usize >= mesh.vertices.len()) {
                return Err(malformed(
                    path,
                    format!("a face refers to the missing vertex {vertex}"),
                ));
            }
            triangles.push(face.map(|vertex| base + vertex));
        }
    }
    Ok((points, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workpiece::error::MeshFault;
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
        assert!(matches!(missing, WorkpieceError::Read { .. }));
        let stl = binary_stl();
        let text = text_stl();
        for (name, bytes, expected) in [
            ("part.step", stl.clone(), "unknown mesh format"),
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
    fn open_non_finite_and_inverted_surfaces_are_refused() {
        let message = |bytes: &[u8]| load("part.stl", bytes, 1e-3).unwrap_err().to_string();
        let mut open = binary_stl();
        open.truncate(open.len() - 50);
        open[80..84].copy_from_slice(&107_u32.to_le_bytes());
        assert!(message(&open).contains("3 open edges"));
        let mut infinite = binary_stl();
        infinite[84 + 12..84 + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(message(&infinite).contains("not a finite number"));
        let mut inverted = binary_stl();
        for triangle in inverted[84..].chunks_exact_mut(50) {
            let (first, rest) = triangle[12..48].split_at_mut(12);
            first.swap_with_slice(&mut rest[..12]);
        }
        assert!(message(&inverted).contains("inside out"));
    }

    #[test]
    fn collada_axes_and_transforms_are_refused_by_name() {
        let message = |text: String| {
            load("part.dae", text.as_bytes(), 1.0)
                .unwrap_err()
                .to_string()
        };
        assert!(message(collada("Y_UP", IDENTITY)).contains("up_axis Y_UP"));
        let moved = IDENTITY.replacen("1 0 0 0", "1 0 0 0.009", 1);
        assert!(message(collada("Z_UP", &moved)).contains("<matrix>"));
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
