//! A scenario run to its end: its recording, its numbers and the bounds on them, in one call.
//!
//! ```no_run
//! # fn main() -> Result<(), idc_cell::run::RunError> {
//! let job = idc_cell::run::Job::load(std::path::Path::new("scenarios/plate_edge.toml"))?;
//! for (metric, value) in job.run(&mut |_, _| ())?.metrics {
//!     println!("{metric} {value:?}");
//! }
//! # Ok(())
//! # }
//! ```

mod arm_sensors;
mod bench;
mod cell;
mod effects;
mod error;
mod job;
mod result;

pub use bench::{FinishedBench, finish_bench, run_bench};
pub use cell::{FinishedCell, finish_cell, run_cell};
pub use effects::{apply_effects, nominal_of};
pub use error::RunError;
pub use job::{Finished, Job, Outcome};
pub use result::{ChamferLimits, RunKind, RunOrigin, RunResult, RunSummary, outside};
