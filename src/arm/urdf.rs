//! Loads a serial arm from a URDF file: everything is honoured, noted by name or refused by name.
//!
//! The path from base to tip becomes a [`KinematicChain`]; whatever hangs on it by fixed joints, or by moving joints
//! off the path (gripper fingers), is welded on with its mass. Format: <http://wiki.ros.org/urdf/XML>.

mod arm;
mod collisions;
mod draft;
mod error;
mod fixed;
mod format;
mod graph;
mod identified;
mod inertia;
mod joints;
mod masses;
mod mesh;
mod mount;
mod robot;
mod solid;
mod source;
mod tree;
mod visuals;
mod walk;
mod xacro;
mod xml_fault;

#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod said_tests;
#[cfg(test)]
mod tests;

pub use arm::{Arm, ArmOptions, CollisionShape, EstimatedMass, LimitOverride, Visual, VisualShape};
pub use draft::{ArmDraft, draft_of, mount_of_recorded};
pub use error::{ArmError, Refusal};
pub use fixed::fixed_frame;
pub use identified::{Identified, identified_urdf};
pub use mount::Mount;

use crate::arm::chain::{KinematicChain, MAX_JOINTS};
use glamx::DPose3;
use masses::Masses;
use source::Source;
use std::path::Path;
use tree::{OF_A_CELL, Tree};

/// Loads the arm in the URDF file `path`.
///
/// # Errors
/// The file or a mesh cannot be read, or holds something that cannot be honoured.
pub fn load_arm(path: &Path, options: &ArmOptions) -> Result<Arm, ArmError> {
    let source = Source::read(path)?;
    assemble(&source, options).map_err(|refusal| refused(path, &source, refusal))
}

/// The mesh files that a URDF file leads to; those that are not found are left out, as they are of the arm.
///
/// # Errors
/// The URDF file cannot be read.
pub fn mesh_files(path: &Path, options: &ArmOptions) -> Result<Vec<std::path::PathBuf>, ArmError> {
    let source = Source::read(path)?;
    Ok(mesh::files(&source.robot, &source.folder, options))
}

/// A refusal with the line of the link or joint that it is about.
fn refused(path: &Path, source: &Source, refusal: Refusal) -> ArmError {
    let line = refusal.subject().and_then(|(what, name)| {
        let key = (what, name.to_owned());
        source.walked.lines.get(&key).copied()
    });
    ArmError::Refused {
        file: path.to_path_buf(),
        line,
        refusal: Box::new(refusal),
    }
}

fn assemble(source: &Source, options: &ArmOptions) -> Result<Arm, Refusal> {
    let mut notes = source.walked.notes.clone();
    let tree = Tree::build(
        &source.robot,
        options.base_link.as_deref(),
        &options.tip_link,
        match options.is_recorded {
            true => 1..=MAX_JOINTS,
            false => OF_A_CELL,
        },
        &mut notes,
    )?;
    check_loops(&tree, source, &mut notes)?;
    for name in options.limit_overrides.keys() {
        if !tree.path_joints().any(|joint| joint.name == *name) {
            return Err(Refusal::OverrideUnknown {
                joint: name.clone(),
            });
        }
    }
    let folder = &source.folder;
    let visuals = match options.skip_visuals {
        true => Vec::new(),
        false => visuals::load(&tree, folder, options, &mut notes)?,
    };
    let without_inertia = &source.walked.without_inertia;
    let shapes = match options.skip_visuals && !Masses::needs_shapes(options, without_inertia) {
        true => Vec::new(),
        false => collisions::load(&tree, folder, options, &mut notes)?,
    };
    let masses = Masses {
        options,
        shapes: &shapes,
        without_inertia,
    };
    masses.check(&tree)?;
    let (bodies, estimated) = inertia::merged_bodies(&tree, &masses, &mut notes)?;
    let mut joints = Vec::with_capacity(tree.moving.len());
    for (moving, body) in tree.moving.iter().zip(bodies) {
        joints.push(joints::path_joint(moving, body, options, &mut notes)?);
    }
    if let Some(angle) = mount::askew(&tree, options.tip_from_mount)?
        && !options.is_recorded
    {
        notes.push(format!(
            "the device is mounted {:.0} degrees off the outward axis of the last joint, along z of link `{}`; arm.flange_rotation_deg turns it, and `idc new cell --urdf` finds by how much",
            angle.to_degrees(),
            options.tip_link
        ));
    }
    Ok(Arm {
        name: source.robot.name.clone(),
        chain: KinematicChain {
            joints,
            tip_from_last: tree.tip_from_last * DPose3::from_rotation(options.tip_from_mount),
        },
        link_names: tree.link_names(),
        visuals,
        collisions: match options.skip_visuals {
            true => Vec::new(),
            false => shapes.into_iter().map(|(_, shape)| shape).collect(),
        },
        estimated,
        notes,
    })
}

/// Joints that close a chain: passed over where they hold together what is rigid already.
fn check_loops(tree: &Tree, source: &Source, notes: &mut Vec<String>) -> Result<(), Refusal> {
    for (line, name, links) in &source.walked.loops {
        let indices: Vec<_> = links.iter().map(|link| tree.index_of(link)).collect();
        match (&links[..], &indices[..]) {
            ([_, _], [one, two]) if one == two && one.is_some() => notes.push(format!(
                "<loop_joint> `{name}` (line {line}) joins links that do not move against each other"
            )),
            _ => {
                let link = |index: usize| links.get(index).cloned().unwrap_or_default();
                return Err(Refusal::Loop {
                    joint: name.clone(),
                    line: *line,
                    first: link(0),
                    second: link(1),
                });
            }
        }
    }
    Ok(())
}
