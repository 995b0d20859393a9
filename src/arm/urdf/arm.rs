//! What is loaded from a URDF file, and what is chosen of it.

use crate::arm::chain::KinematicChain;
use glam::{DQuat, DVec3};
use glamx::DPose3;
use std::collections::BTreeMap;
use std::path::PathBuf;

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
    /// Masses that replace those of the file, by link name [kg].
    pub link_masses: BTreeMap<String, f64>,
    /// Mass of the whole robot with its base, of which links without a mass take the share of their volume [kg].
    pub whole_mass: Option<f64>,
    /// The frame on which something is mounted, in that of the tip link; turned, not moved.
    pub tip_from_mount: DQuat,
    /// Whether to leave out everything that is only drawn, and what would meet other things.
    pub skip_visuals: bool,
    /// Whether the arm is known by its recordings and nothing has to move it: it may then have another number of joints, drives without limits and links
    /// without mass.
    pub is_recorded: bool,
}

/// Drive limits that replace those of the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LimitOverride {
    /// Largest torque or force [N m or N].
    pub effort: Option<f64>,
    /// Largest speed [rad/s or m/s].
    pub velocity: Option<f64>,
}

/// A serial arm of five to seven moving joints; a recorded one may have others.
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    /// Name of the robot in the file.
    pub name: String,
    /// Joints, bodies and tip.
    pub chain: KinematicChain,
    /// The base link's name, then the link's behind each moving joint.
    pub link_names: Vec<String>,
    /// Shapes to draw.
    pub visuals: Vec<Visual>,
    /// Shapes that nothing may meet.
    pub collisions: Vec<CollisionShape>,
    /// Links whose mass or its distribution is estimated, base first.
    pub estimated: Vec<EstimatedMass>,
    /// Changes to the file's content that its reader may not expect, one sentence each.
    pub notes: Vec<String>,
}

/// A link of which the file does not say all that its weight does.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimatedMass {
    /// Joint that carries it, counted from 0.
    pub joint: usize,
    /// Name of the link behind that joint.
    pub link: String,
    /// Its mass with all that is fixed to it [kg].
    pub mass: f64,
    /// Whether the mass itself is estimated, not only where it lies.
    pub by_volume: bool,
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

/// One shape that nothing may meet.
#[derive(Debug, Clone, PartialEq)]
pub struct CollisionShape {
    /// Link it moves with: 0 is the base, `i` the link behind joint `i - 1` of the chain.
    pub link_index: usize,
    /// Pose of the shape in that link's frame.
    pub link_from_shape: DPose3,
    /// The shape; of a mesh its convex hull counts.
    pub shape: VisualShape,
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
