//! The program `idc`, called in the process of Python.

use std::ffi::OsString;
use std::path::PathBuf;

use pyo3::prelude::*;

use crate::app::run_program;

/// Does what a command line asks for, its first word the program's name, and gives the exit code.
#[pyfunction]
pub(super) fn main(py: Python<'_>, arguments: Vec<OsString>, program: Option<PathBuf>) -> u8 {
    py.detach(|| run_program(arguments, program))
}
