//! The bench rig: the device without an arm, on a load cell, on a moved surface, or free.
//!
//! It shares every line of the device with the cell; only the piston is its own.

mod error;
mod estimator;
mod load;
mod running;
mod sample;
mod simulation;

pub use error::RigError;
pub use load::{load_at, load_under};
pub use running::{PausedRig, RunningRig};
pub use sample::RigTruth;
pub use simulation::{Rig, RigSimulation};
