//! Progress of a command: in a terminal a bar with the time that is left, only once a second has passed; elsewhere the stages of long work, a line each.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use super::terminal::say_aside;
use crate::document::printable;

/// Nothing is drawn of what takes less.
const PATIENCE: Duration = Duration::from_millis(700);
/// Between two turns of a spinner.
const TURN: Duration = Duration::from_millis(120);

/// A bar of a count with a text around it.
fn of(count: u64, template: &str, hidden: bool) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template(template);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    show_later(&bar, hidden);
    bar
}

/// A bar of so many parts, none of them reported yet.
pub(super) fn bar(verb: &str, hidden: bool) -> ProgressBar {
    let template = format!("{verb} {{wide_bar}} {{percent:>3}} %, {{eta}} left");
    of(0, &template, hidden)
}

/// A bar of so many bytes to read.
pub(super) fn bytes(count: u64, hidden: bool) -> ProgressBar {
    let template = "reading {wide_bar} {bytes} of {total_bytes}, {elapsed} so far";
    of(count, template, hidden)
}

/// A bar of so many cases.
pub(super) fn cases(count: usize, hidden: bool) -> ProgressBar {
    tasks(count, "case", hidden)
}

/// A bar of so many tasks of a kind, a word that takes an s. What stood at the start is not counted for the time that is left.
pub(super) fn tasks(count: usize, word: &str, hidden: bool) -> ProgressBar {
    let template = format!("{{pos}} of {{len}} {word}s {{wide_bar}} {{eta}} left");
    of(count as u64, &template, hidden)
}

/// A bar of so many places.
pub(super) fn places(count: usize, hidden: bool) -> ProgressBar {
    tasks(count, "place", hidden)
}

/// A bar of so many runs, each of so many parts; its message is how many are done.
pub(super) fn runs(count: usize, parts: usize, hidden: bool) -> ProgressBar {
    let template = format!("{{msg}} of {count} runs {{wide_bar}} {{eta}} left");
    let bar = of((count * parts) as u64, &template, hidden);
    words(&bar, "0");
    bar
}

/// A line for what has stages but no known length.
pub(super) fn spinner(first: &str, hidden: bool) -> ProgressBar {
    let spinner = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template("{spinner} {elapsed}  {wide_msg}");
    spinner.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    words(&spinner, first);
    show_later(&spinner, hidden);
    spinner
}

/// A line for what has stages, of which it is known about what share of the work lies before each.
pub(super) struct StagedLine {
    line: ProgressBar,
    /// The stage that was printed last, where each is a line of its own; none where they are not.
    printed: Option<Mutex<String>>,
    /// When the last mark was passed, and the share of the work that lay before it.
    mark: Arc<Mutex<Option<(Duration, f64)>>>,
}

impl StagedLine {
    /// One that begins with these words.
    pub(super) fn new(first: &str, hidden: bool) -> Self {
        let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let mark: Arc<Mutex<Option<(Duration, f64)>>> = Arc::default();
        let own = Arc::clone(&mark);
        let left = move |state: &ProgressState, to: &mut dyn std::fmt::Write| {
            let mark = *own.lock().unwrap_or_else(PoisonError::into_inner);
            // A line that cannot be drawn is not missed.
            let _ = to.write_str(&left(state.elapsed(), mark));
        };
        let style = ProgressStyle::with_template("{spinner} {elapsed}{left}  {wide_msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_spinner());
        line.set_style(style.with_key("left", left));
        words(&line, first);
        show_later(&line, hidden);
        Self {
            line,
            printed: (!hidden && !is_terminal()).then(Mutex::default),
            mark,
        }
    }

    /// Shows other words; a share of the work [1] lies behind, if that is known.
    pub(super) fn tell(&self, words: String, share: Option<f64>) {
        if let Some(share) = share {
            let now = (self.line.elapsed(), share);
            *self.mark.lock().unwrap_or_else(PoisonError::into_inner) = Some(now);
        }
        if let Some(printed) = &self.printed {
            let stage = words.split(',').next().unwrap_or_default();
            let mut printed = printed.lock().unwrap_or_else(PoisonError::into_inner);
            if *printed != stage {
                say_aside(stage);
                stage.clone_into(&mut printed);
            }
        }
        self::words(&self.line, &words);
    }

    /// Takes it away.
    pub(super) fn end(self) {
        self.line.finish_and_clear();
    }
}

/// Time that is left after a mark, in words: to one digit, as it is a guess; nothing where it has been outlived.
fn left(elapsed: Duration, mark: Option<(Duration, f64)>) -> String {
    let Some((then, share)) = mark else {
        return String::new();
    };
    let whole = then.as_secs_f64() / share;
    let left = whole - elapsed.as_secs_f64();
    if left < 0.5 {
        return String::new();
    }
    let digit = 10f64.powf(left.log10().floor().max(0.0));
    format!(", about {:.0} s left", (left / digit).round() * digit)
}

/// Prints a line where no bar is drawn, as into a file or a pipe.
pub(super) fn without_bar(words: &str, hidden: bool) {
    if !hidden && !is_terminal() {
        say_aside(words);
    }
}

fn is_terminal() -> bool {
    use std::io::IsTerminal as _;
    std::io::stderr().is_terminal()
}

/// Shows words beside a bar, as a line of a terminal may have them.
pub(super) fn words(bar: &ProgressBar, words: &str) {
    bar.set_message(printable(words).into_owned());
}

/// Prints a line above a bar.
pub(super) fn above(bar: &ProgressBar, line: &str) {
    bar.println(printable(line));
}

/// Tells a bar how much is done.
pub(super) fn tell(bar: &ProgressBar, done: usize, total: usize) {
    bar.set_length(total as u64);
    bar.set_position(done as u64);
}

/// Shows a bar once it has been waited for, and from then on also between its steps.
fn show_later(bar: &ProgressBar, hidden: bool) {
    // Its thread is for a terminal alone.
    if hidden || !is_terminal() {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_shown_to_a_digit_and_no_longer_than_it_holds() {
        let after = |seconds: f64, mark| left(Duration::from_secs_f64(seconds), mark);
        assert_eq!(after(3.0, None), "");
        // A third was done after 10 s.
        let mark = Some((Duration::from_secs(10), 1.0 / 3.0));
        assert_eq!(after(10.0, mark), ", about 20 s left");
        assert_eq!(after(23.4, mark), ", about 7 s left");
        assert_eq!(after(29.7, mark), "");
        assert_eq!(after(60.0, mark), "");
    }
}
