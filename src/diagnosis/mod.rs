//! Finds what physics recordings contain that the believed model leaves out.
pub mod evidence;
pub mod fit;
pub mod free;
pub mod search;
pub mod spectrum;
