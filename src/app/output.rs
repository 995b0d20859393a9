//! Text on standard output.

use super::error::AppError;
use super::files::OutputFolder;
use super::terminal::{print, shown_path};

/// Prints a text.
pub(super) fn say(text: &str) -> Result<(), AppError> {
    print(text, false).map_err(AppError::Print)
}

/// Prints a document that may be coloured.
pub(super) fn say_styled(text: &str) -> Result<(), AppError> {
    print(text, true).map_err(AppError::Print)
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
        say_styled(table)?;
        say(&format!(
            "written to {}: {}\n",
            shown_path(folder.path()),
            names.join(", ")
        ))?;
    }
    Ok(())
}
