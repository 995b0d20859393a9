//! Faults of a plan, its tasks and the engines.

use crate::quantity::counted;
use crate::recording::RecordingError;

/// A plan that cannot be read or done.
#[derive(Debug, thiserror::Error)]
pub enum TaskError {
    /// A file that cannot be read or written.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A file that is no plan.
    #[error("{file}:{line}: {reason}; expected a plan that `idc vary` or `idc fleet` wrote")]
    NoPlan {
        /// The file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The fault.
        reason: String,
    },
    /// A plan of another version.
    #[error(
        "{file} was made by {made}, and this is {this}: the same task would have another result; expected the same version on every machine, or the plan made anew"
    )]
    OtherVersion {
        /// The plan.
        file: String,
        /// Its program.
        made: String,
        /// This one.
        this: String,
    },
    /// A task that the plan does not have.
    #[error("{file} has no task {id}; expected one of the names in it")]
    NoTask {
        /// The plan.
        file: String,
        /// The name.
        id: String,
    },
    /// A file that is not what it was when the tasks were named.
    #[error(
        "{file} has changed since the plan {plan} was made: its tasks are named by what stood in it; expected the plan made anew (the command that made it, with --resume)"
    )]
    Changed {
        /// The file.
        file: String,
        /// The plan.
        plan: String,
    },
    /// Tasks that did not come to a result.
    #[error(
        "{} of {} came to no result: {first}; the others are kept, and the same command with --resume tries these again",
        failed,
        counted(*of, "task")
    )]
    Failed {
        /// Their number.
        failed: usize,
        /// Of how many.
        of: usize,
        /// Why, of the first.
        first: String,
    },
    /// An engine that there is not.
    #[error(
        "`{text}` is no engine; expected local, dask=local:N with a number of workers, or dask=ADDRESS of a scheduler, as in dask=tcp://10.0.0.1:8786"
    )]
    NoEngine {
        /// As typed.
        text: String,
    },
    /// Python, or Dask in it.
    #[error(
        "{python}: {reason}; expected a Python with Dask (pip install distributed), which --python names"
    )]
    NoPython {
        /// The program.
        python: String,
        /// The fault.
        reason: String,
    },
    /// Dask, a worker or its folder.
    #[error("Dask: {reason}")]
    Refused {
        /// The fault, and what was expected.
        reason: String,
    },
    /// The driver ended before the tasks.
    #[error(
        "the driver of Dask ended early ({how}): {message}; finished tasks are kept, and the same command with --resume does the others"
    )]
    DriverExited {
        /// Its exit.
        how: String,
        /// Its last words.
        message: String,
    },
}
