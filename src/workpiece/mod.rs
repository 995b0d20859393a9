//! The workpiece: its mesh, its sharp edges, the burr on them, and where a ball touches its surface.
//!
//! Everything here is geometry in the part frame, in SI units; nothing here knows of a physics
//! engine, a scenario or a recording.
//!
//! - [`part_file`] reads a mesh file into a closed, outward-facing [`TriangleMesh`], with small flaws mended ([`mend`]);
//! - [`edges`] finds sharp edges and face outlines, [`EdgeCurve`]s in an [`EdgeList`];
//! - [`burr`] is a burr's height along an edge, [`ride`] what a ball makes of it;
//! - [`surface`] finds the genuine contact points of a ball ([`ContactSurface`]).

mod bvh;
mod curve_kind;
mod repair;
mod topology;

pub mod burr;
pub mod curve;
pub mod edge_list;
pub mod edges;
pub mod error;
pub mod mend;
pub mod mesh;
pub mod part_file;
pub mod ride;
pub mod surface;
#[cfg(test)]
pub(crate) mod test_parts;

pub use burr::BurrProfile;
pub use curve::{Convexity, CurveKind, EdgeCurve, EdgePoint};
pub use edge_list::EdgeList;
pub use edges::{EdgeSearch, list_edges};
pub use error::{EdgeFault, EdgeFlaw, MeshFault, WorkpieceError};
pub use mesh::TriangleMesh;
pub use part_file::{PartFile, load_mesh};
pub use ride::RiddenProfile;
pub use surface::{ContactSurface, SurfaceContact, SurfaceFeature};
