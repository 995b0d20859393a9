//! Ctrl-C, or a request to end: what is half written goes, what is whole is kept, and a message says which that is and how to go on. The program then ends as
//! one does that is interrupted, so that a shell's loop ends with it (130 in `$?`; 143 after SIGTERM).

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

#[cfg(unix)]
use super::terminal::{clear_line, say_aside};

/// Words on the command that goes on; none where none are needed.
static TELL: Mutex<Option<Tell>> = Mutex::new(None);

type Tell = Box<dyn Fn() -> String + Send>;

/// A command that can be interrupted, until this is dropped.
pub(super) struct Interruptible {
    done: Arc<AtomicUsize>,
}

impl Interruptible {
    /// One with this message: what is kept, and how to go on. It is given how many parts are done.
    pub(super) fn new(tell: impl Fn(usize) -> String + Send + 'static) -> Self {
        let done = Arc::<AtomicUsize>::default();
        let own = Arc::clone(&done);
        set(Some(Box::new(move || tell(own.load(Ordering::SeqCst)))));
        Self { done }
    }

    /// One of which nothing is kept before its end.
    pub(super) fn of_one(what: &str, out: &Path) -> Self {
        let message = format!(
            "nothing of this {what} is kept in {}; the same command begins it anew",
            out.display()
        );
        Self::new(move |_| message.clone())
    }

    /// One of many parts, each kept once it is done, that goes on with --resume; `are` says what parts are when they are done.
    pub(super) fn of_many(count: usize, are: &'static str, out: &Path) -> Self {
        let out = out.display().to_string();
        Self::new(move |done| {
            format!(
                "{done} of {count} {are} and kept in {out}; the same command with --resume does the others"
            )
        })
    }

    /// Another part is done and kept.
    pub(super) fn one_more(&self) {
        self.done.fetch_add(1, Ordering::SeqCst);
    }

    /// Parts that are done.
    pub(super) fn done(&self) -> usize {
        self.done.load(Ordering::SeqCst)
    }

    /// So many parts are done.
    pub(super) fn at(&self, done: usize) {
        self.done.fetch_max(done, Ordering::SeqCst);
    }
}

impl Drop for Interruptible {
    fn drop(&mut self) {
        set(None);
    }
}

fn set(tell: Option<Tell>) {
    *TELL.lock().unwrap_or_else(PoisonError::into_inner) = tell;
}

/// Begins to listen. With `json` the message has the form of errors.
#[cfg(unix)]
pub fn listen(json: bool) {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    // Without, it ends at once, as any program does.
    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
        return;
    };
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            // In this order: what is counted as done is in its place.
            crate::recording::atomic::abandon();
            report(json, 128 + signal);
            drop(signal_hook::low_level::emulate_default_handler(signal));
        }
    });
}

/// Elsewhere a program ends at once.
#[cfg(not(unix))]
pub fn listen(_json: bool) {}

#[cfg(unix)]
fn report(json: bool, code: i32) {
    use std::io::IsTerminal as _;
    let tell = TELL.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(text) = tell.as_ref().map(|tell| tell()) else {
        return;
    };
    let line = if json {
        let error =
            serde_json::json!({"message": format!("interrupted: {text}"), "exit_code": code});
        serde_json::json!({ "error": error }).to_string()
    } else {
        // A bar stands in the line.
        if std::io::stderr().is_terminal() {
            clear_line();
        }
        format!("interrupted: {text}")
    };
    say_aside(&line);
}
