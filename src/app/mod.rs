//! The program: subcommands, files that they write, messages and exit codes.

mod cli;
mod edges;
mod error;
mod files;
mod output;
mod picture;
mod run;

pub use cli::{Cli, execute};
pub use error::{AppError, ExitCode};
pub use picture::scene_of;
pub use run::{Finished, run_cell};
