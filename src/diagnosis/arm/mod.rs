//! A recorded arm: what physics its log contains that its description leaves out.

pub mod account;
pub mod answer;
pub mod base_parameters;
pub mod contact;
pub mod diagnosed;
pub mod drives;
pub mod effect;
pub mod estimate;
pub mod evidence;
pub mod extent;
pub mod fit;
pub mod held;
pub mod hypothesis;
pub mod identifiability;
pub mod input;
pub mod inseparable;
pub mod laws;
pub mod pushed;
pub mod quadratic;
pub mod quantity_words;
pub mod search;

pub use diagnosed::{ArmDiagnosis, diagnose};

#[cfg(test)]
mod tests;
