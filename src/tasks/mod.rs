//! Runs and diagnoses as tasks named by content: a plan in one file, a folder for each that is whole or absent, and the engines that see to them.
//!
//! A [`Plan`] is a file of lines: a head, then a task a line, so that a hundred thousand are read and written one at a time. What a task's name (SHA-256) is
//! of is the caller's matter: the program, the scenario with its values, files. A [`Store`] holds a folder for each task that is done; what stands there is
//! never done again, whoever did it. Engines: threads of this program ([`local`]), Dask ([`dask`]), and Snakemake by a file for it ([`snakefile`]).

mod dask;
mod engine;
mod error;
mod local;
mod plan;
mod snakemake;
mod store;

pub use dask::{Dask, dask};
pub use engine::{Engine, TaskMessage};
pub use error::TaskError;
pub use local::local;
pub use plan::{Head, Made, Plan, Task, name_of};
pub use snakemake::snakefile;
pub use store::{RESULT, Store, TASKS, Unfit};
