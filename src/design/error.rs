//! Errors that can end a design study.

use std::path::PathBuf;

use crate::keys::error::Location;
use crate::scenario::ScenarioError;

/// A study that cannot be done.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// The study file.
    #[error(transparent)]
    File(#[from] ScenarioError),
    /// A variable that a scenario cannot take.
    #[error("{location}: `variables.{key}` does not fit a scenario of the study: {reason}")]
    Variable {
        /// Where.
        location: Location,
        /// The variable's key.
        key: String,
        /// Message on the scenario.
        reason: Box<ScenarioError>,
    },
    /// A drawn value that a scenario cannot take.
    #[error(
        "{location}: `robustness.variables.{key}` draws {value}, which a scenario of the study does not take: {reason}"
    )]
    Scatter {
        /// Where.
        location: Location,
        /// The key.
        key: String,
        /// A value near an end of what is drawn.
        value: f64,
        /// Message on the scenario.
        reason: Box<ScenarioError>,
    },
    /// The starting design, to which everything is compared.
    #[error("{}: the starting design cannot be simulated: {detail}", file.display())]
    Start {
        /// The study.
        file: PathBuf,
        /// Message of the evaluation.
        detail: String,
    },
    /// A metric that no scenario gives.
    #[error(
        "{location}: `{key}` names the metric `{metric}`, which no scenario gives for the starting design; known here are {known}"
    )]
    UnknownMetric {
        /// Where.
        location: Location,
        /// The key.
        key: String,
        /// The metric.
        metric: String,
        /// Those that there are.
        known: String,
    },
    /// The limits are too tight.
    #[error(
        "no design within the bounds keeps the limits: the best of {designs} violates {limit} by {excess}, with {value}"
    )]
    NoDesign {
        /// Designs tried.
        designs: usize,
        /// The limit, bound and unit included.
        limit: String,
        /// By how much, unit included.
        excess: String,
        /// Value reached, unit included.
        value: String,
    },
    /// Nothing but failures.
    #[error(
        "no design but the starting one could be simulated: {count} of {designs} failed, most with: {reason}"
    )]
    OnlyFailures {
        /// Designs tried.
        designs: usize,
        /// Number that failed.
        count: usize,
        /// Most frequent reason.
        reason: String,
    },
    /// The optimiser refused.
    #[error("the optimiser stopped: {0}")]
    Optimiser(String),
}

impl DesignError {
    /// Whether it is a finding of the study, and not a fault of its input.
    pub fn is_verdict(&self) -> bool {
        matches!(self, Self::NoDesign { .. } | Self::OnlyFailures { .. })
    }
}
