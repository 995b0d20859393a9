//! Relation between the coordinates of a fit and a number of the rig's description.

/// Relation between the fit's coordinate u and a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coordinate {
    /// value = scale u, scale in the quantity's unit.
    Linear(f64),
    /// value = exp(u): what is positive and of unknown size.
    Logarithmic,
}

impl Coordinate {
    /// Value at a coordinate.
    pub fn value(self, coordinate: f64) -> f64 {
        match self {
            Self::Linear(scale) => scale * coordinate,
            Self::Logarithmic => coordinate.exp(),
        }
    }

    /// Coordinate of a value.
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear(scale) => value / scale,
            Self::Logarithmic => value.ln(),
        }
    }

    /// d value / d coordinate at a value.
    pub fn slope(self, value: f64) -> f64 {
        match self {
            Self::Linear(scale) => scale,
            Self::Logarithmic => value,
        }
    }
}
