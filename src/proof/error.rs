//! Errors of a proof, apart from its score.

use std::path::{Path, PathBuf};

use crate::laboratory::{LaboratoryError, RigError};
use crate::recording::RecordingError;

/// A proof that cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum ProofError {
    /// No case.
    #[error("{}: no case here, expected folders that hold rig.toml{}", folder.display(), besides(only))]
    NoCases {
        /// Where they were looked for.
        folder: PathBuf,
        /// Names that were asked for.
        only: Vec<String>,
    },
    /// No case of a name.
    #[error(
        "the laboratory has no case `{name}`, expected one of those that it writes with the same --devices or --laws, --draw and --duration-s"
    )]
    NoCase {
        /// The name.
        name: String,
    },
    /// A device of the laboratory that does not carry out what it is asked for.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        cause: String,
    },
    /// No such effect.
    #[error("the laboratory has no effect `{name}`; it has {known}")]
    Effect {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// Outcomes of another sweep stand there.
    #[error("{} holds outcomes already: --resume goes on with them, --force puts new ones in their place, another --out starts anew", folder.display())]
    OutcomesExist {
        /// The folder.
        folder: PathBuf,
    },
    /// Outcomes were made in another way.
    #[error("{} was made with {found}, expected {expected}: a sweep goes on only as it began", path.display())]
    OtherPlan {
        /// The outcome.
        path: PathBuf,
        /// The text found.
        found: String,
        /// The request.
        expected: String,
    },
    /// The laboratory.
    #[error(transparent)]
    Laboratory(#[from] LaboratoryError),
    /// A file cannot be written.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

fn besides(only: &[String]) -> String {
    if only.is_empty() {
        String::new()
    } else {
        format!(" and are named {}", only.join(" or "))
    }
}

impl ProofError {
    /// A file cannot be read.
    pub(super) fn read(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Read {
            path: path.to_owned(),
            cause: cause.to_string(),
        }
    }
}
