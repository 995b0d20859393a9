//! The bench rig: the device without an arm, on a load cell, on a moved surface, or free.
//!
//! It shares every line of the device with the cell; only the piston is its own.

mod carrier;
mod error;
mod estimator;
mod sample;
mod simulation;

pub use carrier::BenchCarrier;
pub use error::RigError;
pub use sample::RigTruth;
pub use simulation::{Rig, RigSimulation};
