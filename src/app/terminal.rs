//! The one door to the terminal: whatever is printed, by whichever command, goes through here, and what came in with a name or a text of a file is shown, not sent.

use std::io::{ErrorKind, Result, Write as _};
use std::path::Path;

use crate::document::{printable, printable_lines, printable_styled};

/// Prints a text on standard output; one that is styled has colours of this program in it. A reader that has seen enough, such as `head`, is no error.
pub(super) fn print(text: &str, styled: bool) -> Result<()> {
    let text = match styled {
        true => printable_styled(text).into(),
        false => printable_lines(text),
    };
    let mut output = std::io::stdout().lock();
    match output
        .write_all(text.as_bytes())
        .and_then(|()| output.flush())
    {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Prints a message of one line on standard error. That nobody may read it any more is no error: `eprintln!` would end the thread.
pub(super) fn say_aside(message: &str) {
    drop(writeln!(std::io::stderr(), "{}", printable(message)));
}

/// The same of a text of several lines, its colours where they can be seen.
pub(super) fn say_aside_styled(text: &str) {
    drop(write!(anstream::stderr(), "{}", printable_styled(text)));
}

/// A file as it is named within a text.
pub(super) fn shown_path(path: &Path) -> String {
    printable(&path.display().to_string()).into_owned()
}

/// Takes away what stands in the line, as a bar does.
pub(super) fn clear_line() {
    drop(write!(std::io::stderr(), "\r\x1b[2K"));
}
