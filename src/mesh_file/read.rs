//! Reads a mesh file of whichever format.

use std::path::Path;

use super::error::MeshFileError;
use super::kind::{Found, Kind, found, pointer_size};
use super::scene::{Fault, MeshFile};
use super::{collada, gltf, obj, ply, stl};

/// Reads a file.
///
/// # Errors
/// It cannot be read, or is not of a format that is read here, or not as its format has it.
pub fn read(path: &Path) -> Result<MeshFile, MeshFileError> {
    let file = path.to_owned();
    let bytes = match crate::file::read(path) {
        Ok(bytes) => bytes,
        Err(source) => return Err(MeshFileError::Read { file, source }),
    };
    if let Some(size) = pointer_size(&bytes) {
        return Err(MeshFileError::Pointer { file, size });
    }
    let kind = match found(path, &bytes) {
        Found::Known(kind) => kind,
        Found::Foreign(what, remedy) => {
            return Err(MeshFileError::Foreign { file, what, remedy });
        }
        Found::Unknown => return Err(MeshFileError::Unknown { file }),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let parsed = match kind {
        Kind::Stl => stl::parse(&bytes),
        Kind::Obj => obj::parse(&bytes, folder),
        Kind::Collada => collada::parse(&bytes),
        Kind::Ply => ply::parse(&bytes),
        Kind::Gltf => gltf::parse(&bytes, folder),
    };
    parsed
        .and_then(MeshFile::checked)
        .map_err(|fault| match fault {
            Fault::Malformed(reason) => MeshFileError::Malformed { file, reason },
            Fault::Unsupported { feature, remedy } => MeshFileError::Unsupported {
                file,
                feature,
                remedy: remedy.to_owned(),
            },
        })
}
