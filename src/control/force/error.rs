//! Faults of a controller's parameters.

use std::fmt;

/// A controller that cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ControllerError {
    /// A parameter outside its range.
    #[error("{key} is {value}, expected {expected}")]
    OutOfRange {
        /// The parameter.
        key: &'static str,
        /// Its value, strict SI.
        value: f64,
        /// Values that would do.
        expected: &'static str,
    },
    /// A parameter with which the loop is unstable.
    #[error(
        "{key} {value} is unstable: at {frequency:.0} rad/s the loop turns by 180 degrees with a gain of {gain:.2}{assumption}; {limit}"
    )]
    Unstable {
        /// The parameter.
        key: &'static str,
        /// Its value, strict SI.
        value: f64,
        /// Where the loop turns by 180 degrees [rad/s].
        frequency: f64,
        /// The loop's gain there [1].
        gain: f64,
        /// Assumption on the loop, if not the device as described; starts with a space.
        assumption: &'static str,
        /// Up to where it would be stable.
        limit: StabilityLimit,
    },
}

/// Up to where a loop is stable, strict SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StabilityLimit {
    /// The largest stable value.
    AtMost(f64),
    /// The smallest stable value.
    AtLeast(f64),
}

impl fmt::Display for StabilityLimit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtMost(value) => write!(formatter, "at most {value:.3}"),
            Self::AtLeast(value) => write!(formatter, "at least {value:.5}"),
        }
    }
}
