//! What keeps a scenario from being run to its end.

use crate::cell::CellError;
use crate::metrics::MetricsError;
use crate::recording::RecordingError;
use crate::scenario::ScenarioError;

/// A scenario that cannot be run, or whose run cannot be recorded or measured.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The scenario file.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The cell.
    #[error(transparent)]
    Cell(#[from] CellError),
    /// A bound on a metric, or what it is measured against.
    #[error("{file}: {source}")]
    Metrics {
        /// Scenario file.
        file: String,
        /// The fault.
        source: MetricsError,
    },
    /// An effect that cannot be put in as it is asked for.
    #[error("--with: {reason}")]
    With {
        /// The fault, and what was expected.
        reason: String,
    },
    /// The recording.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

impl RunError {
    /// A fault of the metrics of a scenario file.
    pub(crate) fn metrics(file: &std::path::Path) -> impl Fn(MetricsError) -> Self {
        let file = file.display().to_string();
        move |source| Self::Metrics {
            file: file.clone(),
            source,
        }
    }
}
