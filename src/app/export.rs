//! `idc export`: a cell's path as a robot's program, a bench rig as a co-simulation unit.

mod archive;
mod description;
mod error;
mod fmu;
mod program;
mod version;

use clap::{Args, Subcommand};

pub use error::ExportError;

use super::error::{AppError, ExitCode};

/// For the help.
pub(super) const EXAMPLES: &str = "\
Each --help says what is written and how it is used. Exit codes: 0 written,
2 bad input.

Examples:
  # A robot's program, of a cell.
  idc export program scenarios/plate_edge.toml --dialect urscript \\
      --out runs/robot
  # What can be exported of a bench or a rig, and how.
  idc export fmu --help";

#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    #[command(subcommand)]
    what: Export,
}

/// What is written.
#[derive(Debug, Subcommand)]
enum Export {
    /// The planned path of a cell as a program for its robot, and as joints over time.
    #[command(after_help = program::EXAMPLES)]
    Program(program::ProgramArguments),
    /// A bench or a rig file as a functional mock-up unit (FMI), for co-simulation.
    #[command(after_help = fmu::EXAMPLES)]
    Fmu(fmu::FmuArguments),
}

/// Writes what was asked for.
pub(super) fn run(arguments: &ExportArguments) -> Result<ExitCode, AppError> {
    match &arguments.what {
        Export::Program(arguments) => program::run(arguments),
        Export::Fmu(arguments) => fmu::run(arguments),
    }
}
