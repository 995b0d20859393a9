//! The program's own file, for engines that call it for more.

use std::path::PathBuf;
use std::sync::OnceLock;

/// It, where it is not the process's own.
static FILE: OnceLock<PathBuf> = OnceLock::new();

/// Names it, where it is not the process's own.
pub(super) fn name_this_program(file: PathBuf) {
    // Named twice in a process it is the same.
    drop(FILE.set(file));
}

/// File to call for more of this program.
pub(super) fn this_program() -> std::io::Result<PathBuf> {
    match FILE.get() {
        Some(file) => Ok(file.clone()),
        None => std::env::current_exe(),
    }
}
