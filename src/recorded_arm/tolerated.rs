//! Numbers that are known within bounds.

use super::quantity::Quantity;

/// A number that is known within bounds: the truth lies anywhere between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerated {
    /// The number.
    pub quantity: Quantity,
    /// Least and largest value [its unit].
    pub bounds: [f64; 2],
}
