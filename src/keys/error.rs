//! Faults of a scenario file or a device model file.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

/// A place in a file, as editors understand it: `file:line:column`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The file.
    pub file: PathBuf,
    /// Line and column, both from 1; none for a value that the file leaves to its default.
    pub position: Option<(u32, u32)>,
    /// The text that stands there.
    pub excerpt: Option<Box<Excerpt>>,
}

/// The line of a place, and what of it is meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excerpt {
    /// The line, without its end.
    pub line: String,
    /// Bytes of it.
    pub meant: Range<usize>,
}

impl fmt::Display for Location {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.file.display())?;
        match self.position {
            Some((line, column)) => write!(formatter, ":{line}:{column}"),
            None => Ok(()),
        }
    }
}

/// A scenario or device model that cannot be used. Keys are dotted, as in `process.force_n`.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScenarioError {
    /// The file is not there.
    #[error("there is no file {}", file.display())]
    NoSuchFile {
        /// File asked for.
        file: PathBuf,
    },
    /// The file is there but cannot be read.
    #[error("cannot read {}: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Message of the operating system.
        source: std::io::Error,
    },
    /// The file is not TOML.
    #[error("{location}: not valid TOML: {reason}")]
    Syntax {
        /// Where.
        location: Location,
        /// The fault and the expected form.
        reason: String,
    },
    /// A scenario of the other kind.
    #[error("{}: the scenario is a {found}, expected a {expected}", file.display())]
    OtherKind {
        /// The file.
        file: PathBuf,
        /// Its kind.
        found: &'static str,
        /// The kind that was asked for.
        expected: &'static str,
    },
    /// The file is written for another version of this format.
    #[error("{location}: schema is {found}, expected {}", versions(*expected))]
    Schema {
        /// Where.
        location: Location,
        /// Version found.
        found: i64,
        /// Version that this program reads.
        expected: u32,
    },
    /// A key that means nothing here.
    #[error("{location}: unknown key `{key}`; {advice}")]
    UnknownKey {
        /// Where.
        location: Location,
        /// The key.
        key: String,
        /// Which key was probably meant.
        advice: String,
    },
    /// A key without default is absent.
    #[error("{location}: `{key}` is missing, expected {expected}")]
    MissingKey {
        /// The table that lacks it.
        location: Location,
        /// The key.
        key: String,
        /// Its expected content.
        expected: String,
    },
    /// A value of another type, not among the choices, or at odds with another one.
    #[error("{location}: `{key}` is {found}, expected {expected}")]
    Value {
        /// Where.
        location: Location,
        /// The key.
        key: String,
        /// The value as written, unit included.
        found: String,
        /// Expected value or form.
        expected: String,
    },
    /// A law of a user's own that cannot be.
    #[error("{location}: `{key}`, {reason}")]
    Expression {
        /// Where.
        location: Location,
        /// The key.
        key: String,
        /// The fault, and the part of it that has it.
        reason: String,
    },
    /// A key that only has a meaning together with another one.
    #[error("{location}: `{key}` cannot stand here: {reason}")]
    Misplaced {
        /// Where.
        location: Location,
        /// The key.
        key: String,
        /// Why not.
        reason: String,
    },
}

/// Versions of a format up to the last.
fn versions(last: u32) -> String {
    match last {
        1 => "1".to_owned(),
        last => format!("1 to {last}"),
    }
}

impl ScenarioError {
    /// The dotted key that it is about, if it is about one.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::UnknownKey { key, .. }
            | Self::MissingKey { key, .. }
            | Self::Value { key, .. }
            | Self::Expression { key, .. }
            | Self::Misplaced { key, .. } => Some(key),
            _ => None,
        }
    }

    /// Where it is, if that is a place in a file.
    pub fn location(&self) -> Option<&Location> {
        match self {
            Self::Syntax { location, .. }
            | Self::Schema { location, .. }
            | Self::UnknownKey { location, .. }
            | Self::MissingKey { location, .. }
            | Self::Value { location, .. }
            | Self::Expression { location, .. }
            | Self::Misplaced { location, .. } => Some(location),
            Self::NoSuchFile { .. } | Self::Read { .. } | Self::OtherKind { .. } => None,
        }
    }

    /// The same at another place, if it has one.
    pub(crate) fn at(mut self, other: Location) -> Self {
        match &mut self {
            Self::Syntax { location, .. }
            | Self::Schema { location, .. }
            | Self::UnknownKey { location, .. }
            | Self::MissingKey { location, .. }
            | Self::Value { location, .. }
            | Self::Expression { location, .. }
            | Self::Misplaced { location, .. } => *location = other,
            Self::NoSuchFile { .. } | Self::Read { .. } | Self::OtherKind { .. } => {}
        }
        self
    }
}
