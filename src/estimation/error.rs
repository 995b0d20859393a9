//! Reasons to refuse an estimator.

use thiserror::Error;

/// Refusals, each with the value at fault.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EstimationError {
    /// A standard deviation, period or density that must be above zero.
    #[error("estimator: {name} is {value}, but must be a finite number above 0 {unit}")]
    NotPositive {
        /// Its name.
        name: &'static str,
        /// As given.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A tolerance that is negative or not a number.
    #[error("estimator: tolerance of {name} is {value}, but must be 0 or more {unit}")]
    Tolerance {
        /// Of what.
        name: &'static str,
        /// As given.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A relative tolerance so wide that the part could be absent.
    #[error(
        "estimator: relative tolerance of {name} is {value}, but must be below 1 (the part would be absent)"
    )]
    WholeOfIt {
        /// Of what.
        name: &'static str,
        /// As given.
        value: f64,
    },
    /// A period that the chambers' equations are not integrated over.
    #[error(
        "estimator: sampling period is {period} s, but must be above 0 and at most {longest} s"
    )]
    Period {
        /// As given [s].
        period: f64,
        /// The longest accepted [s].
        longest: f64,
    },
    /// A stroke or gravity that is not a number.
    #[error("estimator: {name} is {value}, but must be a finite number")]
    NotFinite {
        /// Its name.
        name: &'static str,
        /// As given.
        value: f64,
    },
    /// A device with a part that the estimator has no equation for.
    #[error("estimator: the device has {part}, which the estimator does not model")]
    NotModelled {
        /// The part.
        part: &'static str,
    },
    /// No process model at all.
    #[error("estimator: no process model was given, but at least one is needed")]
    NoModel,
}
