//! Parts with which an effect is written.

pub use super::effect::{Clues, Effect, Parameter, Subsystem, effect};
pub use super::quantity::Coordinate::{self, Linear, Logarithmic};
pub use crate::plant::Quantity;
pub use crate::plant::registry::*;

/// Laws of a leak exclude one another.
pub(super) const LEAK: Option<&str> = Some("leak");

/// A number that is a part of the answer.
pub fn reported(quantity: Quantity, coordinate: Coordinate, bounds: [f64; 2]) -> Parameter {
    Parameter {
        quantity,
        coordinate,
        bounds,
        reported: true,
        choices: &[],
    }
}

/// A number that the model needs and the answer does not name.
pub fn hidden(quantity: Quantity, coordinate: Coordinate, bounds: [f64; 2]) -> Parameter {
    Parameter {
        reported: false,
        ..reported(quantity, coordinate, bounds)
    }
}

/// Starts of an effect of one number.
pub fn each(values: &[f64]) -> Vec<Vec<f64>> {
    values.iter().map(|value| vec![*value]).collect()
}

/// The same as shares of a value.
pub fn shares(shares: &[f64], of: f64) -> Vec<Vec<f64>> {
    shares.iter().map(|share| vec![share * of]).collect()
}
