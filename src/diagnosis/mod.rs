//! Finds what physics recordings contain that the believed model leaves out.
pub mod estimate;
pub mod evidence;
pub mod fit;
pub mod free;
pub mod mismatch;
pub mod search;
pub mod spectrum;
