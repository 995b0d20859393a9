//! A recorded arm: what physics its log contains that its description leaves out.

pub mod diagnosed;
pub mod input;

pub use diagnosed::{ArmDiagnosis, diagnose};
