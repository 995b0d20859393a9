//! The `idc` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    idc_cell::app::run_program(std::env::args_os(), None).into()
}
