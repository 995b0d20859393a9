//! Finds what physics recordings contain that the believed model leaves out.

pub mod answer;
pub mod bumps;
pub mod clean;
pub mod estimate;
pub mod evidence;
pub mod fit;
pub mod free;
pub mod mismatch;
pub mod recorded;
pub mod search;
pub mod spectrum;
