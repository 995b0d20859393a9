//! Which format a file is of: by its first bytes where they say it, else by its name.

use std::path::Path;

/// A format that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Stl,
    Obj,
    Collada,
    Ply,
    Gltf,
}

/// What a file is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Found {
    Known(Kind),
    /// A format that is not read, and what to do.
    Foreign(&'static str, String),
    Unknown,
}

/// Size of the file that a Git LFS pointer stands for, as it says it; none if this is no pointer.
#[must_use]
pub fn pointer_size(bytes: &[u8]) -> Option<String> {
    if !bytes.starts_with(b"version https://git-lfs") {
        return None;
    }
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(1024)]);
    let size = text.lines().find_map(|line| line.strip_prefix("size "));
    Some(size.unwrap_or("unknown").trim().to_owned())
}

/// What a file of a path with these bytes is.
pub(super) fn found(path: &Path, bytes: &[u8]) -> Found {
    let extension = path
        .extension()
        .and_then(std::ffi::OsStr::to_str)
        .map(str::to_ascii_lowercase)
        .unwrap_or_default();
    let shown = path.display().to_string();
    if let Some(kind) = by_bytes(bytes) {
        return Found::Known(kind);
    }
    let head = &bytes[..bytes.len().min(4096)];
    if let Some((what, way)) = foreign_bytes(head) {
        return Found::Foreign(what, remedy(way, &shown));
    }
    let known = match extension.as_str() {
        "stl" | "stla" | "stlb" => Kind::Stl,
        "obj" => Kind::Obj,
        "dae" => Kind::Collada,
        "ply" => Kind::Ply,
        "gltf" | "glb" => Kind::Gltf,
        other => {
            return match FOREIGN_NAMES
                .iter()
                .find(|(names, ..)| names.contains(&other))
            {
                Some((_, what, way)) => Found::Foreign(what, remedy(*way, &shown)),
                None => Found::Unknown,
            };
        }
    };
    Found::Known(known)
}

/// A format whose first bytes leave no doubt.
fn by_bytes(bytes: &[u8]) -> Option<Kind> {
    let start = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let start = start.trim_ascii_start();
    let head = &start[..start.len().min(4096)];
    let has = |word: &[u8]| head.windows(word.len()).any(|window| window == word);
    if bytes.starts_with(b"glTF") {
        return Some(Kind::Gltf);
    }
    if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
        return Some(Kind::Ply);
    }
    (start.starts_with(b"<") && has(b"<COLLADA")).then_some(Kind::Collada)
}

/// How a file is brought into a format that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// Boundary representations that Gmsh and FreeCAD open.
    Gmsh,
    /// Parts for printing.
    Slicer,
    /// A file of a CAD program.
    Cad,
    /// A scene of an animation program.
    Blender,
    /// A mesh that MeshLab opens.
    MeshLab,
    /// An archive.
    Unpack,
    /// A page in place of the file.
    Fetch,
}

fn remedy(way: Way, file: &str) -> String {
    let (stem, _) = file.rsplit_once('.').unwrap_or((file, ""));
    match way {
        Way::Gmsh => format!(
            "convert it, for example with Gmsh (`gmsh \"{file}\" -2 -clcurv 60 -o \"{stem}.stl\"`), or in FreeCAD (export as STL)"
        ),
        Way::Slicer => format!(
            "convert it, for example with PrusaSlicer (`prusa-slicer --export-stl \"{file}\"`), or in FreeCAD (export as STL)"
        ),
        Way::Cad => "export the part from the CAD program as STL, or as STEP and convert that with Gmsh or FreeCAD".to_owned(),
        Way::Blender => "open it in Blender and export it as STL, OBJ or glTF".to_owned(),
        Way::MeshLab => format!(
            "convert it, for example with MeshLab, or in Python (`trimesh.load(\"{file}\").export(\"{stem}.stl\")`)"
        ),
        Way::Unpack => "unpack it and name the mesh in it".to_owned(),
        Way::Fetch => "download the raw file".to_owned(),
    }
}

/// Formats by the first bytes.
fn foreign_bytes(head: &[u8]) -> Option<(&'static str, Way)> {
    let start = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let start = start.trim_ascii_start();
    let lower = start[..start.len().min(64)].to_ascii_lowercase();
    let has = |word: &[u8]| head.windows(word.len()).any(|window| window == word);
    let begins = |words: &[&[u8]]| words.iter().any(|word| start.starts_with(word));
    // IGES: fixed lines of 80 letters, the first section's letter in column 73.
    let iges = head.get(72..80).is_some_and(|end| {
        end[0] == b'S'
            && end[1..]
                .iter()
                .all(|letter| letter.is_ascii_digit() || *letter == b' ')
    });
    let found = match () {
        () if begins(&[b"ISO-10303-21"]) => ("a STEP file", Way::Gmsh),
        () if iges => ("an IGES file", Way::Gmsh),
        () if begins(&[b"DBRep_DrawableShape", b"CASCADE Topology"]) => {
            ("an Open CASCADE shape (BREP)", Way::Gmsh)
        }
        () if begins(&[b"**ABCDEF", b"PS\x00\x00"]) || has(b"**PART1;") => {
            ("a Parasolid file", Way::Cad)
        }
        () if begins(&[b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"]) => (
            "a file of a CAD program (an OLE container, as SolidWorks and Inventor write)",
            Way::Cad,
        ),
        () if begins(&[b"PK\x03\x04"]) && has(b"3D/") => ("a 3MF file", Way::Slicer),
        () if begins(&[b"PK\x03\x04"]) => ("a zip archive, as 3MF files are", Way::Unpack),
        () if begins(&[b"\x1f\x8b", b"7z\xbc\xaf", b"Rar!"]) => ("a compressed file", Way::Unpack),
        () if begins(&[b"BLENDER"]) => ("a Blender file", Way::Blender),
        () if begins(&[b"Kaydara FBX", b"; FBX"]) => ("an FBX file", Way::Blender),
        () if begins(&[b"PXR-USDC", b"#usda"]) => ("a USD file", Way::Blender),
        () if begins(&[b"#VRML"]) => ("a VRML file", Way::MeshLab),
        () if begins(&[b"AC10"]) => ("an AutoCAD drawing (DWG)", Way::Cad),
        () if has(b"<X3D") => ("an X3D file", Way::MeshLab),
        () if begins(&[b"OFF\n", b"OFF\r", b"COFF", b"NOFF"]) => ("an OFF file", Way::MeshLab),
        () if lower.starts_with(b"<!doctype html") || lower.starts_with(b"<html") => {
            ("a web page", Way::Fetch)
        }
        () => return None,
    };
    Some(found)
}

/// Formats by the file's name.
const FOREIGN_NAMES: [(&[&str], &str, Way); 11] = [
    (&["step", "stp", "p21", "stpz"], "a STEP file", Way::Gmsh),
    (&["iges", "igs"], "an IGES file", Way::Gmsh),
    (&["brep", "brp"], "an Open CASCADE shape (BREP)", Way::Gmsh),
    (
        &["x_t", "x_b", "xmt_txt", "xmt_bin", "xmt"],
        "a Parasolid file",
        Way::Cad,
    ),
    (
        &[
            "sldprt",
            "sldasm",
            "ipt",
            "iam",
            "catpart",
            "catproduct",
            "prt",
            "par",
            "f3d",
            "sat",
            "sab",
            "jt",
            "3dm",
            "fcstd",
            "dwg",
            "dxf",
            "scad",
        ],
        "a file of a CAD program",
        Way::Cad,
    ),
    (&["3mf", "amf"], "a 3MF or AMF file", Way::Slicer),
    (
        &[
            "fbx", "blend", "usd", "usda", "usdc", "usdz", "3ds", "max", "mb", "ma",
        ],
        "a scene of an animation program",
        Way::Blender,
    ),
    (
        &["wrl", "x3d", "off", "vtk", "vtp", "vtu", "msh", "obj3d"],
        "a mesh in another format",
        Way::MeshLab,
    ),
    (
        &["zae", "zip", "gz", "7z", "tar", "rar"],
        "an archive",
        Way::Unpack,
    ),
    (&["html", "htm"], "a web page", Way::Fetch),
    (&["skp"], "a SketchUp file", Way::Blender),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_detected_by_their_first_bytes_then_by_their_names() {
        let step = b"ISO-10303-21;\nHEADER;\n".as_slice();
        let iges = format!("{:72}S      1\n", "a part");
        for (name, bytes, expected) in [
            ("a.step", step, "STEP"),
            ("a.stl", step, "STEP"),
            ("a.igs", iges.as_bytes(), "IGES"),
            ("a.x_t", b"**ABCDEFGHIJKLMNOPQRSTUVWXYZ", "Parasolid"),
            ("a.stl", b"PK\x03\x04..3D/3dmodel.model", "3MF"),
            ("a.stl", b"\n<!DOCTYPE html><html>", "web page"),
            ("a.stp", b"", "STEP"),
            ("a.fbx", b"", "animation"),
        ] {
            let Found::Foreign(what, way) = found(Path::new(name), bytes) else {
                panic!("{name}");
            };
            assert!(what.contains(expected), "{name}: {what}");
            assert!(!way.is_empty());
        }
        let known = |name: &str, bytes: &[u8]| found(Path::new(name), bytes);
        assert_eq!(known("a.STL", b"solid"), Found::Known(Kind::Stl));
        assert_eq!(known("a.stl", b"glTF"), Found::Known(Kind::Gltf));
        assert_eq!(known("a", b"ply\nformat"), Found::Known(Kind::Ply));
        assert_eq!(
            known("a.xml", b"<?xml version='1.0'?><COLLADA>"),
            Found::Known(Kind::Collada)
        );
        assert_eq!(known("a.txt", b"words"), Found::Unknown);
    }

    #[test]
    fn a_pointer_says_the_size_of_its_file() {
        let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:01\nsize 123\n";
        assert_eq!(pointer_size(pointer).as_deref(), Some("123"));
        assert_eq!(pointer_size(b"solid a"), None);
    }
}
