//! Mesh files as other programs write them: STL, Wavefront OBJ, COLLADA, PLY and glTF.
//!
//! A file is read as its format's specification has it, into triangles of one colour each; what cannot be read rightly is refused by
//! name. Nothing here knows whether the triangles are a part, a robot's link or an obstacle.
//!
//! The readers are our own, over `roxmltree` and `serde_json`. Of crates were tried: `mesh-loader` (nested COLLADA nodes in the wrong
//! order, second instances lost, concave OBJ faces folded, text STL taken for binary), `dae-parser` (refuses files with any element
//! that it does not know, and overflows the stack on deep ones), `ply-rs` (reserves as much memory as a file claims to need), `gltf`
//! (panics on accessors beyond their buffers), `earcut` (drops vertices on straight sides, which leaves cracks to neighbouring faces).

mod collada;
mod error;
mod gltf;
mod kind;
mod obj;
mod ply;
mod polygon;
mod read;
mod scene;
mod stl;
mod text;

pub use error::MeshFileError;
pub use kind::pointer_size;
pub use polygon::{Split, split_polygon};
pub use read::read;
pub use scene::{MeshFile, MeshPart, Up};

#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod tests;
