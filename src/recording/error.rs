//! Errors while a recording is built, written or read.

use std::path::{Path, PathBuf};

/// A recording that cannot be built, written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// A Parquet table, and no reader of such.
    #[cfg(not(feature = "parquet"))]
    #[error(
        "{file}: this program was built without the feature `parquet`; expected comma-separated values"
    )]
    WithoutParquet {
        /// The file.
        file: String,
    },
    /// A recording needs at least one sample.
    #[error("the recording has no samples; at least one is needed")]
    Empty,
    /// A channel has another number of values than there are sample times.
    #[error("channel `{quantity}` has {found} values, expected {expected}, one per sample time")]
    Length {
        /// The channel's quantity.
        quantity: String,
        /// Number of values found.
        found: usize,
        /// Number of sample times.
        expected: usize,
    },
    /// Sample times are not finite or do not increase.
    #[error(
        "sample time {index} is {value} s after {previous} s; times must be finite and increase"
    )]
    Time {
        /// Index of the offending sample.
        index: usize,
        /// The sample before it (negative infinity for the first) [s].
        previous: f64,
        /// Its time [s].
        value: f64,
    },
    /// The same quantity appears twice.
    #[error("channel `{quantity}` appears twice")]
    Duplicate {
        /// The quantity that appears twice.
        quantity: String,
    },
    /// A quantity whose column name could not be read back.
    #[error("channel name `{quantity}` with unit {unit} cannot be used: {reason}")]
    Quantity {
        /// The quantity refused.
        quantity: String,
        /// Its unit's symbol.
        unit: &'static str,
        /// Why it is refused.
        reason: &'static str,
    },
    /// A phase that ends before it starts, or overlaps the one before it.
    #[error("phase `{name}` from {start} s to {end} s cannot be used: {reason}")]
    Phase {
        /// The phase's name.
        name: String,
        /// Its start [s].
        start: f64,
        /// Its end [s].
        end: f64,
        /// Why it is refused.
        reason: &'static str,
    },
    /// A channel that was asked for is absent.
    #[error("the recording has no channel `{quantity}`")]
    Missing {
        /// The quantity asked for.
        quantity: String,
    },
    /// A scene whose parts do not fit together or do not fit the recording.
    #[error("the scene cannot be drawn: {what} is {found}, expected {expected}")]
    Scene {
        /// The part of the scene.
        what: String,
        /// The kind found.
        found: String,
        /// The expected value.
        expected: String,
    },
    /// A file could not be written; nothing was left in its place.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// Why it could not be.
        cause: String,
    },
    /// A viewer no longer takes a recording that is being made.
    #[error("the recording cannot be watched any longer: {cause}")]
    Live {
        /// Why.
        cause: String,
    },
    /// A file could not be read.
    #[error("cannot read {}: {cause}", path.display())]
    Read {
        /// The file that was to be read.
        path: PathBuf,
        /// Why it could not be.
        cause: String,
    },
    /// A line of a text file is not what a recording holds.
    #[error("{}:{line}: column `{column}` is {found}, expected {expected}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// The column's name.
        column: String,
        /// The content found there.
        found: String,
        /// Expected value or form.
        expected: String,
    },
    /// A line of a text file has not as many fields as there are columns.
    #[error("{}:{line}: {found} fields, expected {expected}, as many as the header names", path.display())]
    Fields {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// Number of fields.
        found: u64,
        /// Number of columns.
        expected: u64,
    },
    /// A column of a file is not what a recording holds.
    #[error("cannot read {}: column `{column}` is {found}, expected {expected}", path.display())]
    Column {
        /// The file.
        path: PathBuf,
        /// The column's name.
        column: String,
        /// The content found there.
        found: String,
        /// Expected value or form.
        expected: String,
    },
}

impl RecordingError {
    /// A write error at `path`, of a temporary folder at the place that it is for.
    pub(crate) fn write(path: &Path, cause: impl std::fmt::Display) -> Self {
        let is_temporary = |part: &std::path::Component<'_>| {
            let name = part.as_os_str().to_string_lossy();
            name.starts_with(super::unfinished::UNFINISHED)
        };
        Self::Write {
            path: path.components().filter(|c| !is_temporary(c)).collect(),
            cause: cause.to_string(),
        }
    }

    /// A read error at `path`.
    pub(crate) fn read(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Read {
            path: path.to_path_buf(),
            cause: cause.to_string(),
        }
    }

    /// A scene error about `what`.
    pub(crate) fn scene(
        what: impl Into<String>,
        found: impl std::fmt::Display,
        expected: impl std::fmt::Display,
    ) -> Self {
        Self::Scene {
            what: what.into(),
            found: found.to_string(),
            expected: expected.to_string(),
        }
    }
}
