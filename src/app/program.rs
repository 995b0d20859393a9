//! The program from its command line to its exit code.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{CommandFactory as _, FromArgMatches as _};

use super::cli::{Cli, execute};
use super::complaint::{complain, refuse_arguments, wants_json};
use super::interrupt::listen;
use super::this_program::name_this_program;

/// Does what a command line asks for, its first word the program's name, and gives the exit code. `program` is the file to call for more of it, where that is not the
/// process's own.
pub fn run_program(arguments: impl IntoIterator<Item = OsString>, program: Option<PathBuf>) -> u8 {
    if let Some(program) = program {
        name_this_program(program);
    }
    let matches = match Cli::command().try_get_matches_from(arguments) {
        Ok(matches) => matches,
        Err(error) => refuse_arguments(&error),
    };
    let json = wants_json(&matches);
    let cli = match Cli::from_arg_matches(&matches) {
        Ok(cli) => cli,
        Err(error) => refuse_arguments(&error),
    };
    cli.colour.write_global();
    listen(json);
    match execute(&cli) {
        Ok(code) => code as u8,
        Err(error) => {
            complain(&error, json);
            error.exit_code() as u8
        }
    }
}
