//! A recorded arm: what physics its log contains that its description leaves out.

pub mod input;
