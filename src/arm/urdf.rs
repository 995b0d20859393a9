//! Loads a serial arm from a URDF file: everything is honoured, noted by name or refused by name.
//!
//! The path from base to tip becomes a [`KinematicChain`]; whatever hangs on it by fixed joints, or by moving joints
//! off the path (gripper fingers), is welded on with its mass. Format: <http://wiki.ros.org/urdf/XML>.

mod arm;
mod collisions;
mod error;
mod graph;
mod inertia;
mod joints;
mod mesh;
mod tree;
mod visuals;

#[cfg(test)]
mod tests;

pub use arm::{Arm, ArmOptions, CollisionShape, LimitOverride, Visual, VisualShape};
pub use error::{ArmError, Refusal};

use crate::arm::chain::KinematicChain;
use std::path::Path;
use tree::Tree;

/// Loads the arm in the URDF file `path`.
///
/// # Errors
/// The file or a mesh cannot be read, or holds something that cannot be honoured.
pub fn load_arm(path: &Path, options: &ArmOptions) -> Result<Arm, ArmError> {
    let text = std::fs::read_to_string(path).map_err(|source| ArmError::Unreadable {
        file: path.to_path_buf(),
        source,
    })?;
    // The parser says of both that there are no elements.
    for (part, fault) in [
        ("<robot", "it has no <robot> element"),
        ("</robot>", "it is cut off before </robot>"),
    ] {
        if !text.contains(part) {
            return Err(ArmError::Incomplete {
                file: path.to_path_buf(),
                fault,
            });
        }
    }
    let robot = urdf_rs::read_from_string(&text).map_err(|source| ArmError::Malformed {
        file: path.to_path_buf(),
        source,
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    assemble(&robot, folder, options).map_err(|refusal| ArmError::Refused {
        file: path.to_path_buf(),
        refusal: Box::new(refusal),
    })
}

/// The mesh files that a URDF file leads to; those that are not found are left out, as they are of the arm.
///
/// # Errors
/// The URDF file cannot be read.
pub fn mesh_files(path: &Path, options: &ArmOptions) -> Result<Vec<std::path::PathBuf>, ArmError> {
    let robot = urdf_rs::read_file(path).map_err(|source| ArmError::Malformed {
        file: path.to_path_buf(),
        source,
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    Ok(mesh::files(&robot, folder, options))
}

/// The link of a URDF file that a device would be mounted on: of those by which an arm can be loaded one with a usual name, else the last.
///
/// # Errors
/// The file cannot be read, or no link of it ends an arm; why not by its last link.
pub fn likely_flange(path: &Path) -> Result<String, ArmError> {
    const USUAL: [&str; 3] = ["tool0", "flange", "ee_link"];
    let text = std::fs::read_to_string(path).map_err(|source| ArmError::Unreadable {
        file: path.to_path_buf(),
        source,
    })?;
    let robot = urdf_rs::read_from_string(&text).map_err(|source| ArmError::Malformed {
        file: path.to_path_buf(),
        source,
    })?;
    let loads = |link: &str| {
        let options = ArmOptions {
            tip_link: link.to_owned(),
            skip_visuals: true,
            ..ArmOptions::default()
        };
        load_arm(path, &options).map(|_| link.to_owned())
    };
    let usual = USUAL.into_iter().find_map(|link| loads(link).ok());
    let last = || {
        let links = robot.links.iter().rev();
        links
            .map(|link| link.name.as_str())
            .find_map(|link| loads(link).ok())
    };
    match usual.or_else(last) {
        Some(link) => Ok(link),
        None => loads(robot.links.last().map_or("", |link| &link.name)),
    }
}

fn assemble(robot: &urdf_rs::Robot, folder: &Path, options: &ArmOptions) -> Result<Arm, Refusal> {
    let mut notes = Vec::new();
    let tree = Tree::build(
        robot,
        options.base_link.as_deref(),
        &options.tip_link,
        &mut notes,
    )?;
    for name in options.limit_overrides.keys() {
        if !tree.path_joints().any(|joint| joint.name == *name) {
            return Err(Refusal::OverrideUnknown {
                joint: name.clone(),
            });
        }
    }
    let bodies = inertia::merged_bodies(&tree, &mut notes)?;
    let mut joints = Vec::with_capacity(tree.moving.len());
    for (moving, body) in tree.moving.iter().zip(bodies) {
        joints.push(joints::path_joint(moving, body, options, &mut notes)?);
    }
    let (visuals, collisions) = if options.skip_visuals {
        (Vec::new(), Vec::new())
    } else {
        (
            visuals::load(&tree, folder, options, &mut notes)?,
            collisions::load(&tree, folder, options, &mut notes)?,
        )
    };
    Ok(Arm {
        name: robot.name.clone(),
        chain: KinematicChain {
            joints,
            tip_from_last: tree.tip_from_last,
        },
        link_names: tree.link_names(),
        visuals,
        collisions,
        notes,
    })
}
