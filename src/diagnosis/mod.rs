//! Finds what physics recordings contain that the believed model leaves out.

pub mod answer;
pub mod clean;
pub mod estimate;
pub mod evidence;
pub mod fit;
pub mod free;
pub mod latent;
pub mod mismatch;
pub mod recorded;
mod scale;
pub mod search;
pub mod spectrum;
