//! The `idc` program.

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};
use idc_cell::app::{Cli, complain, execute, listen, refuse_arguments, wants_json};

fn main() -> ExitCode {
    let matches = match Cli::command().try_get_matches() {
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
        Ok(code) => code.into(),
        Err(error) => {
            complain(&error, json);
            error.exit_code().into()
        }
    }
}
