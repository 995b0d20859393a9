//! Finds what physics recordings contain that the believed model leaves out.
pub mod catalogue;
pub mod effect;
pub mod evidence;
pub mod fit;
pub mod quantity;
pub mod search;
pub mod spectrum;
