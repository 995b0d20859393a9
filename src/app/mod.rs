//! The program: subcommands, files that they write, messages and exit codes.

mod bench;
mod bench_figures;
mod bench_picture;
mod cli;
mod design;
mod diagnose;
mod edges;
mod error;
mod estimate_figure;
mod files;
mod import;
mod output;
mod picture;
mod predict;
mod prove;
mod recordings;
mod report;
mod run;
mod view;
mod viewer;

pub use bench::{FinishedBench, run_rig};
pub use cli::{Cli, execute};
pub use design::ScenarioEvaluator;
pub use error::{AppError, ExitCode};
pub use picture::scene_of;
pub use run::{Finished, run_cell};
pub use viewer::ViewerError;
