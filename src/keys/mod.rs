//! Keys of files, each declared once: read with their places, checked, turned into SI, as a schema; whatever the file.

pub(crate) mod check;
pub(crate) mod declaration;
pub(crate) mod document;
pub mod error;
pub(crate) mod schema;
pub(crate) mod suggestion;
