//! How far a diagnosis is, in one line of a terminal; nothing where there is none.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// Between two turns of the spinner.
const TURN: Duration = Duration::from_millis(120);

/// The line of one case.
pub(super) fn spinner(hidden: bool) -> ProgressBar {
    if hidden {
        return ProgressBar::hidden();
    }
    let spinner = ProgressBar::new_spinner();
    let style = ProgressStyle::with_template("{spinner} {elapsed}  {wide_msg}");
    spinner.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    spinner.set_message("reading");
    // Its thread is for a terminal alone.
    if !spinner.is_hidden() {
        spinner.enable_steady_tick(TURN);
    }
    spinner
}
