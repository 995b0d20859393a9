//! Text on standard output.

use std::io::{ErrorKind, Write};

use super::error::AppError;
use super::files::OutputFolder;

/// Prints a text. A reader that has seen enough, such as `head`, is no error.
pub(super) fn say(text: &str) -> Result<(), AppError> {
    let mut output = std::io::stdout().lock();
    match output
        .write_all(text.as_bytes())
        .and_then(|()| output.flush())
    {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(AppError::Print(error)),
        _ => Ok(()),
    }
}

/// Prints what the user asked to see.
pub(super) fn show(
    [quiet, json]: [bool; 2],
    document: &str,
    table: &str,
    folder: &OutputFolder,
    names: &[&str],
) -> Result<(), AppError> {
    if json {
        say(&format!("{document}\n"))?;
    } else if !quiet {
        say(table)?;
        say(&format!(
            "written to {}: {}\n",
            folder.path().display(),
            names.join(", ")
        ))?;
    }
    Ok(())
}
