//! The program: subcommands, files that they write, messages and exit codes.

mod bench;
mod bench_figures;
mod bench_picture;
mod check;
mod cli;
mod compare;
mod complaint;
mod design;
mod diagnose;
mod edges;
mod error;
mod estimate_figure;
mod files;
mod help;
mod import;
mod manual;
mod new;
mod output;
mod picture;
mod predict;
mod progress;
mod prove;
mod recordings;
mod report;
mod run;
mod schema;
mod view;
mod viewer;

pub use bench::{FinishedBench, run_rig};
pub use cli::{Cli, execute};
pub use complaint::{complain, wants_json};
pub use design::ScenarioEvaluator;
pub use error::{AppError, ExitCode};
pub use picture::scene_of;
pub use run::{Finished, run_cell};
pub use viewer::ViewerError;
