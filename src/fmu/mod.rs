//! A bench rig as a functional mock-up unit (FMI 3.0 and 2.0, co-simulation): one shared library for all rigs, which reads the rig from the unit's resources.
//!
//! ```text
//! resources/scenario.toml -> model (variables, token) -> instance: inputs -> the step of a bench -> outputs
//! ```
//!
//! All of it is safe but the functions in C of either version (`fmi2`, `fmi3`, and `interface`, which they share). Beside them `unsafe` is allowed only where
//! Python's macros need it.

mod error;
mod fmi2;
mod fmi3;
mod instance;
mod interface;
mod model;
mod variables;

pub use error::FmuError;
pub use instance::{Instance, Snapshot};
pub use model::{MARK, Model, SCENARIO};
pub use variables::{Causality, Kind, Variable};
