//! Errors that can stop a bench run.

/// A bench run that ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigError {
    /// The numbers went astray.
    #[error(
        "at {time:.4} s {quantity} became {value}; a smaller step_ms or more device_substeps may help"
    )]
    NotFinite {
        /// Time [s].
        time: f64,
        /// The quantity.
        quantity: &'static str,
        /// Its value, SI.
        value: f64,
    },
}
