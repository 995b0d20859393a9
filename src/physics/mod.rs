//! Pure equations of the pneumatic device: no engine, no files, no clock. One effect a file.
//!
//! Pressures are absolute [Pa], mass flows positive into the chamber, forces positive in extension.

pub mod chamber;
pub mod end_stop;
pub mod gas;
pub mod orifice;
pub mod piston;
pub mod regulator;
pub mod valve;
