//! The coupled simulation: the arm in Rapier, the device's pneumatics in sub-steps of every rigid-body step, recorded at each step.
//!
//! The step, in order (`Simulation::step`):
//! reference -> set pressure -> device (pneumatic sub-steps) -> joint laws (servo with feed-forward, slide) -> rigid bodies with contact -> sample.

pub mod contact;
mod dispatch;
mod error;
pub mod runout;
mod sample;
mod step;
pub mod world;

pub use error::SimulationError;
pub use sample::{FrameLog, SampleLog};
pub use step::{Simulation, StepTimes};
