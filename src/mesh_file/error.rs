//! Why a mesh file cannot be read.

use std::path::PathBuf;

/// A mesh file that is not read.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// It could not be opened or read.
    #[error("cannot read {}: {source}", file.display())]
    Read {
        /// File.
        file: PathBuf,
        /// Message of the operating system.
        source: std::io::Error,
    },
    /// A Git LFS pointer in the file's place.
    #[error(
        "{}: this is a Git LFS pointer to a file of {size} bytes, not the file itself; expected the mesh: `git lfs pull` in its repository fetches it",
        file.display()
    )]
    Pointer {
        /// File.
        file: PathBuf,
        /// Size of the file that it points to [bytes].
        size: String,
    },
    /// A format that is known and not read.
    #[error("{}: this is {what}, which is not read here, expected {READ}; {remedy}", file.display())]
    Foreign {
        /// File.
        file: PathBuf,
        /// Its format.
        what: &'static str,
        /// A way to a format that is read.
        remedy: String,
    },
    /// Neither the file's name nor its first bytes are those of a format that is read.
    #[error("{}: unknown mesh format, expected {READ}", file.display())]
    Unknown {
        /// File.
        file: PathBuf,
    },
    /// The file is not a well-formed mesh of its format.
    #[error("{}: malformed mesh: {reason}", file.display())]
    Malformed {
        /// File.
        file: PathBuf,
        /// The fault.
        reason: String,
    },
    /// The file holds something that is not honoured, so that it is refused.
    #[error("{}: {feature} is not supported: {remedy}", file.display())]
    Unsupported {
        /// File.
        file: PathBuf,
        /// Feature that the file asks for.
        feature: String,
        /// The remedy.
        remedy: String,
    },
}

/// What is read.
const READ: &str =
    "STL (.stl), Wavefront OBJ (.obj), COLLADA (.dae), PLY (.ply) or glTF (.gltf, .glb)";
