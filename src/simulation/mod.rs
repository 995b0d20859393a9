//! The coupled simulation: the arm in Rapier, the device's pneumatics in sub-steps of every rigid-body step, recorded at each step.
//!
//! The step, in order (`Simulation::step`):
//! reference -> set pressure -> slide (device and contact, in sub-steps) -> joint laws (servo with feed-forward) -> cutting of a tool that turns -> rigid bodies with
//! friction -> sample.

pub mod contact;
mod cutting;
mod dispatch;
mod error;
mod held_arm;
mod lever;
mod rates;
mod run;
mod sample;
pub mod slide;
mod step;
pub mod world;

pub use error::SimulationError;
pub use run::CellRun;
pub use sample::{FrameLog, SampleLog};
pub use step::{Simulation, StepTimes};
