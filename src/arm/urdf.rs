//! Loads a serial arm from a URDF file: everything is honoured, noted by name or refused by name.
//!
//! The path from base to tip becomes a [`Chain`]; whatever hangs on it by fixed joints, or by moving joints
//! off the path (gripper fingers), is welded on with its mass. Format: <http://wiki.ros.org/urdf/XML>.

mod error;
mod graph;
mod inertia;
mod joints;
mod mesh;
mod tree;
mod visuals;

#[cfg(test)]
mod tests;

pub use error::{ArmError, Refusal};

use crate::arm::chain::Chain;
use glam::DVec3;
use glamx::DPose3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use tree::Tree;

/// Choice of the parts taken from the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ArmOptions {
    /// Link that stands still; the file's root link if not given.
    pub base_link: Option<String>,
    /// Link whose frame is the chain's tip, such as the flange.
    pub tip_link: String,
    /// Folders of `package://` names; names that are missing here are looked for from the file upwards.
    pub package_directories: BTreeMap<String, PathBuf>,
    /// Drive limits that replace those of the file, by joint name.
    pub limit_overrides: BTreeMap<String, LimitOverride>,
    /// Whether to leave out everything that is only drawn.
    pub skip_visuals: bool,
}

/// Drive limits that replace those of the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LimitOverride {
    /// Largest torque or force [N m or N].
    pub effort: Option<f64>,
    /// Largest speed [rad/s or m/s].
    pub velocity: Option<f64>,
}

/// A serial arm of five to seven moving joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    /// Name of the robot in the file.
    pub name: String,
    /// Joints, bodies and tip.
    pub chain: Chain,
    /// The base link's name, then the link's behind each moving joint.
    pub link_names: Vec<String>,
    /// Shapes to draw.
    pub visuals: Vec<Visual>,
    /// Changes to the file's content that its reader may not expect, one sentence each.
    pub notes: Vec<String>,
}

/// One shape to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Visual {
    /// Link it moves with: 0 is the base, `i` the link behind joint `i - 1` of the chain.
    pub link_index: usize,
    /// Pose of the shape in that link's frame.
    pub link_from_visual: DPose3,
    /// The shape.
    pub shape: VisualShape,
    /// Red, green, blue, opacity [0 to 255].
    pub colour: [u8; 4],
}

/// Geometry of a [`Visual`], centred on its frame.
#[derive(Debug, Clone, PartialEq)]
pub enum VisualShape {
    /// A box.
    Box {
        /// Edge lengths [m].
        size: DVec3,
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius [m].
        radius: f64,
        /// Length [m].
        length: f64,
    },
    /// A sphere.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
    /// Triangles, wound anticlockwise seen from outside.
    Mesh {
        /// Corner points, scale applied [m].
        vertices: Vec<DVec3>,
        /// Indices into `vertices`.
        triangles: Vec<[u32; 3]>,
    },
}

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
    let visuals = if options.skip_visuals {
        Vec::new()
    } else {
        visuals::load(&tree, folder, options, &mut notes)?
    };
    notes.push("collision shapes of the arm are not simulated".to_string());
    Ok(Arm {
        name: robot.name.clone(),
        chain: Chain {
            joints,
            tip_from_last: tree.tip_from_last,
        },
        link_names: tree.link_names(),
        visuals,
        notes,
    })
}

/// Pose of a URDF `origin`, refused if it is not finite; `place` says where it stands.
fn pose_of(origin: &urdf_rs::Pose, place: impl FnOnce() -> String) -> Result<DPose3, Refusal> {
    let [roll, pitch, yaw] = *origin.rpy;
    // Fixed-axis roll, pitch, yaw: roll turns first.
    let rotation = glam::DQuat::from_rotation_z(yaw)
        * glam::DQuat::from_rotation_y(pitch)
        * glam::DQuat::from_rotation_x(roll);
    let pose = DPose3::from_parts(DVec3::from_array(*origin.xyz), rotation);
    if pose.translation.is_finite() && pose.rotation.is_finite() {
        Ok(pose)
    } else {
        Err(Refusal::NotFinite { place: place() })
    }
}
