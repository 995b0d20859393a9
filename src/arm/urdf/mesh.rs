//! Finds and reads the mesh files that a URDF file names.

use super::ArmOptions;
use crate::mesh_file::{self, Up};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Triangles of one colour.
pub(super) struct MeshPart {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    pub colour: Option<[u8; 4]>,
}

/// Reads the mesh `name` of a URDF file in `folder`; the error says why it cannot be used.
pub(super) fn load(
    name: &str,
    scale: DVec3,
    folder: &Path,
    options: &ArmOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<MeshPart>, String> {
    if !scale.is_finite() || scale.x * scale.y * scale.z == 0.0 {
        return Err(format!(
            "its scale is {} {} {}; expected finite factors other than zero",
            scale.x, scale.y, scale.z
        ));
    }
    let path = resolve(name, folder, options)?;
    let file = mesh_file::read(&path).map_err(|error| error.to_string())?;
    let said = file.notes.iter().chain(&file.doubtful);
    notes.extend(said.map(|note| format!("mesh {name}: {note}")));
    if file.up != Up::Z {
        notes.push(format!(
            "mesh {name}: its up axis is {}; it is drawn in the axes it is written in",
            file.up.axis()
        ));
    }
    let parts = file
        .parts
        .into_iter()
        .filter(|part| !part.triangles.is_empty());
    let parts = parts.map(|part| scaled_part(part, scale, &path));
    let parts = parts.collect::<Result<Vec<_>, String>>()?;
    if parts.is_empty() {
        return Err(format!("{}: no triangles in it", path.display()));
    }
    Ok(parts)
}

/// One part of the file with the scale applied.
fn scaled_part(part: mesh_file::MeshPart, scale: DVec3, file: &Path) -> Result<MeshPart, String> {
    let vertices: Vec<_> = part.points.iter().map(|point| *point * scale).collect();
    if !vertices.iter().all(|point| point.is_finite()) {
        return Err(format!(
            "{}: a coordinate is not a finite number",
            file.display()
        ));
    }
    let mut triangles = part.triangles;
    // A mirrored mesh is inside out unless its triangles are wound the other way.
    if scale.x * scale.y * scale.z < 0.0 {
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
    }
    Ok(MeshPart {
        vertices,
        triangles,
        colour: part.colour.map(bytes),
    })
}

/// Shares of one to bytes.
pub(super) fn bytes(rgba: [f64; 4]) -> [u8; 4] {
    rgba.map(|share| (share.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// The files that a robot's meshes lead to, each once.
pub(super) fn files(robot: &urdf_rs::Robot, folder: &Path, options: &ArmOptions) -> Vec<PathBuf> {
    let shapes = robot.links.iter().flat_map(|link| {
        let seen = link.visual.iter().map(|visual| &visual.geometry);
        seen.chain(link.collision.iter().map(|body| &body.geometry))
    });
    let mut found = Vec::new();
    for shape in shapes {
        if let urdf_rs::Geometry::Mesh { filename, .. } = shape
            && let Ok(file) = resolve(filename, folder, options)
            && !found.contains(&file)
        {
            found.push(file);
        }
    }
    found
}

/// The file that a URDF `filename` means.
pub(super) fn resolve(name: &str, folder: &Path, options: &ArmOptions) -> Result<PathBuf, String> {
    let file = if let Some(in_package) = name.strip_prefix("package://") {
        let (package, rest) = in_package
            .split_once('/')
            .ok_or("expected package://NAME/FILE")?;
        return in_package_directory(package, rest, folder, options);
    } else if let Some(absolute) = name.strip_prefix("file://") {
        PathBuf::from(absolute)
    } else if let Some((scheme, _)) = name.split_once("://") {
        return Err(format!(
            "`{scheme}://` is not known; expected package://, file:// or a path"
        ));
    } else {
        folder.join(name)
    };
    if file.is_file() {
        Ok(file)
    } else {
        Err(format!("there is no file {}", file.display()))
    }
}

fn in_package_directory(
    package: &str,
    rest: &str,
    folder: &Path,
    options: &ArmOptions,
) -> Result<PathBuf, String> {
    if let Some(directory) = options.package_directories.get(package) {
        let file = directory.join(rest);
        return if file.is_file() {
            Ok(file)
        } else {
            Err(format!("there is no file {}", file.display()))
        };
    }
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf());
    let candidates = folder.ancestors().flat_map(|ancestor| {
        let named_so = ancestor.file_name().is_some_and(|name| name == package);
        let itself = named_so.then(|| ancestor.join(rest));
        itself
            .into_iter()
            .chain([ancestor.join(package).join(rest)])
    });
    candidates
        .into_iter()
        .find(|file| file.is_file())
        .ok_or_else(|| {
            format!(
                "no folder `{package}` from {} upwards holds {rest}; name the package's folder",
                folder.display()
            )
        })
}
