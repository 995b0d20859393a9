//! The `idc` program.

use std::process::ExitCode;

use clap::Parser;
use idc_cell::app::{Cli, ExitCode as Code, execute};

fn main() -> ExitCode {
    match execute(&Cli::parse()) {
        Ok(code) => code.into(),
        Err(error) => {
            let code = error.exit_code();
            let word = if code == Code::Stopped {
                "stopped"
            } else {
                "error"
            };
            eprintln!("{word}: {error}");
            code.into()
        }
    }
}
