//! A mass flow and how it changes with a pressure, for implicit steps.

/// A flow [kg/s] and its slope over a pressure [kg/(s Pa)].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowSlope {
    /// The flow.
    pub flow: f64,
    /// Its slope.
    pub slope: f64,
}
