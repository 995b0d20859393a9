//! Errors while a run is measured or compared with bounds.

/// A run that cannot be measured, or a bound that cannot be checked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MetricsError {
    /// A limit to measure against makes no sense.
    #[error("{what} is {value}; expected {expected}")]
    Limit {
        /// Which limit.
        what: String,
        /// Its value, with its unit.
        value: String,
        /// The expected value.
        expected: &'static str,
    },
    /// A channel is in another unit than its quantity has.
    #[error("channel `{quantity}` is in {found}; expected {expected}")]
    ChannelUnit {
        /// The channel's quantity.
        quantity: String,
        /// Symbol of its unit.
        found: &'static str,
        /// Symbol of the unit that is needed.
        expected: &'static str,
    },
    /// More than one phase over which uniformity could be judged.
    #[error("the recording has {count} phases named `{name}`; expected one")]
    RepeatedPhase {
        /// Name of the phase.
        name: &'static str,
        /// Number of times that it occurs.
        count: usize,
    },
    /// An expectation names no metric.
    #[error(
        "[expect] names `{metric}`, which is no metric; the nearest is `{nearest}` \
         (docs/METRICS.md lists all)"
    )]
    UnknownMetric {
        /// The name given.
        metric: String,
        /// The metric whose name is nearest to it.
        nearest: &'static str,
    },
    /// An expectation whose bounds make no sense.
    #[error("[expect] `{metric}` has {found}; expected {expected}")]
    Bound {
        /// Name of the metric.
        metric: String,
        /// Its bounds.
        found: String,
        /// The expected bounds.
        expected: &'static str,
    },
}
