//! Finds and reads the mesh files that a URDF file names.

use super::{ArmOptions, visuals};
use glam::DVec3;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::path::{Path, PathBuf};
use std::sync::Once;

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
    let file = resolve(name, folder, options)?;
    let bytes = std::fs::read(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    if is_turned_collada(&file, &bytes) {
        notes.push(format!(
            "mesh {name}: its up axis is not Z_UP; it is drawn in the axes it is written in"
        ));
    }
    let loader = mesh_loader::Loader::default();
    let scene = without_panic(|| loader.load_from_slice(&bytes, &file))
        .ok_or_else(|| format!("{}: not a readable mesh", file.display()))?
        .map_err(|error| format!("{}: {error}", file.display()))?;
    let mut parts = Vec::new();
    for (index, mesh) in scene.meshes.iter().enumerate() {
        let diffuse = scene.materials.get(index).and_then(|m| m.color.diffuse);
        let colour = diffuse.map(|rgba| visuals::bytes(rgba.map(f64::from)));
        if let Some(part) = scaled_part(mesh, scale, colour, &file)? {
            parts.push(part);
        }
    }
    if parts.is_empty() {
        return Err(format!("{}: no triangles in it", file.display()));
    }
    Ok(parts)
}

/// Runs `work`; none, and nothing printed, if it panics. The mesh loader indexes out of bounds on some broken
/// COLLADA files.
fn without_panic<T>(work: impl FnOnce() -> T) -> Option<T> {
    thread_local! { static QUIET: Cell<bool> = const { Cell::new(false) } }
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                usual(panic);
            }
        }));
    });
    QUIET.set(true);
    let outcome = catch_unwind(AssertUnwindSafe(work));
    QUIET.set(false);
    outcome.ok()
}

/// One mesh of the file with the scale applied; none if it has no triangles.
fn scaled_part(
    mesh: &mesh_loader::Mesh,
    scale: DVec3,
    colour: Option<[u8; 4]>,
    file: &Path,
) -> Result<Option<MeshPart>, String> {
    if mesh.faces.is_empty() {
        return Ok(None);
    }
    let widened = mesh.vertices.iter().map(|point| point.map(f64::from));
    let vertices: Vec<_> = widened.map(|p| DVec3::from_array(p) * scale).collect();
    let count = vertices.len();
    let mut triangles = mesh.faces.clone();
    let inside = |triangle: &[u32; 3]| triangle.iter().all(|index| (*index as usize) < count);
    if !triangles.iter().all(inside) || !vertices.iter().all(|point| point.is_finite()) {
        return Err(format!("{}: broken vertices or indices", file.display()));
    }
    // A mirrored mesh is inside out unless its triangles are wound the other way.
    if scale.x * scale.y * scale.z < 0.0 {
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
    }
    Ok(Some(MeshPart {
        vertices,
        triangles,
        colour,
    }))
}

fn is_turned_collada(file: &Path, bytes: &[u8]) -> bool {
    let extension = file.extension().and_then(|extension| extension.to_str());
    let collada = extension.is_some_and(|extension| extension.eq_ignore_ascii_case("dae"));
    collada && {
        let text = String::from_utf8_lossy(bytes);
        text.contains("<up_axis>Y_UP") || text.contains("<up_axis>X_UP")
    }
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
