//! How far a command is: a bar with the time that is left, in a terminal and nowhere else, and only once a second has passed.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Nothing is drawn of what takes less.
const PATIENCE: Duration = Duration::from_millis(700);
/// Between two turns of a spinner.
const TURN: Duration = Duration::from_millis(120);

/// A bar of so many parts, of which it has yet to be told.
pub(super) fn bar(verb: &str, hidden: bool) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
    let template = format!("{verb} {{wide_bar}} {{percent:>3}} %, {{eta}} left");
    let style = ProgressStyle::with_template(&template);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    show_later(&bar, hidden);
    bar
}

/// A bar of so many bytes to read.
pub(super) fn bytes(count: u64, hidden: bool) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::hidden());
    let template = "reading {wide_bar} {bytes} of {total_bytes}, {elapsed} so far";
    let style = ProgressStyle::with_template(template);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    show_later(&bar, hidden);
    bar
}

/// A bar of so many cases.
pub(super) fn cases(count: usize, hidden: bool) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(count as u64), ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template("{pos} of {len} cases {wide_bar} {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    show_later(&bar, hidden);
    bar
}

/// A line for what has stages but no known length.
pub(super) fn spinner(first: &str, hidden: bool) -> ProgressBar {
    let spinner = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template("{spinner} {elapsed}  {wide_msg}");
    spinner.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    spinner.set_message(first.to_owned());
    show_later(&spinner, hidden);
    spinner
}

/// Tells a bar how much is done.
pub(super) fn tell(bar: &ProgressBar, done: usize, total: usize) {
    bar.set_length(total as u64);
    bar.set_position(done as u64);
}

/// Shows a bar once it has been waited for, and from then on also between its steps.
fn show_later(bar: &ProgressBar, hidden: bool) {
    use std::io::IsTerminal as _;
    // Its thread is for a terminal alone.
    if hidden || !std::io::stderr().is_terminal() {
        return;
    }
    let waiting = bar.downgrade();
    std::thread::spawn(move || {
        std::thread::sleep(PATIENCE);
        if let Some(bar) = waiting.upgrade()
            && !bar.is_finished()
        {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(TURN);
        }
    });
}
