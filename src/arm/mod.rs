//! Serial robot arms: what a URDF file says about one, and its kinematics and dynamics.
//!
//! Nothing here knows a physics engine, a scenario or a recording.

pub mod chain;
pub mod dynamics;
pub mod inverse_kinematics;
pub mod kinematics;
pub mod payload;
pub mod urdf;

#[cfg(test)]
pub(crate) mod test_chains;

pub use chain::{BodyInertia, Joint, JointKind, KinematicChain, MAX_JOINTS};
pub use urdf::{
    Arm, ArmDraft, ArmError, ArmOptions, CollisionShape, EstimatedMass, Identified, LimitOverride,
    Mount, Visual, VisualShape, draft_of, identified_urdf, load_arm, mesh_files, mount_of_recorded,
};
