//! Long work called from Python: without its lock, with progress, and interrupted by Ctrl-C or by an exception of whoever observes the progress.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

use super::error::raised;
use crate::app::AppError;

/// Between two looks at signals, and two calls of whoever observes the progress.
const INTERVAL: Duration = Duration::from_millis(50);

/// What unwinds the work of a call that was interrupted: the exception that is to be raised. What is half written goes with it, as at any early end.
struct Interrupted(PyErr);

/// Whoever observes the progress.
pub(super) struct Reporter {
    callback: Option<Py<PyAny>>,
    last: Instant,
}

impl Reporter {
    /// Parts done and in all. At signals is looked as well.
    pub(super) fn report(&mut self, done: usize, total: usize) {
        if done < total && self.last.elapsed() < INTERVAL {
            return;
        }
        self.last = Instant::now();
        let called = Python::attach(|py| {
            py.check_signals()?;
            match &self.callback {
                Some(callback) => callback.call1(py, (done, total)).map(drop),
                None => Ok(()),
            }
        });
        if let Err(error) = called {
            resume_unwind(Box::new(Interrupted(error)));
        }
    }
}

/// Does work without Python's lock.
pub(super) fn detached<T: Send>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&mut Reporter) -> Result<T, AppError> + Send,
) -> PyResult<T> {
    let mut reporter = Reporter {
        callback,
        last: Instant::now(),
    };
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(|| work(&mut reporter))));
    match done {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(error)) => Err(raised(&error)),
        Err(payload) => match payload.downcast::<Interrupted>() {
            Ok(interrupted) => Err(interrupted.0),
            Err(payload) => resume_unwind(payload),
        },
    }
}
