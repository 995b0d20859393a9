//! Where recordings and a model differ, when, and in which link.

pub mod bumps;
pub mod comparison;
pub(super) mod extent;
pub mod links;
pub mod localise;
pub mod mismatch;
pub mod regime;
pub mod remaining;
pub mod spectrum;
