//! A number of the rig's description that a fit may move: how to read it, how to change it, what is believed of it.

use crate::plant::PlantParameters;

/// A number of the rig's description.
#[derive(Clone, Copy)]
pub struct Quantity {
    /// Name with its unit, as in an answer: `coulomb_force_n`.
    pub name: &'static str,
    /// Reads it.
    pub get: fn(&PlantParameters) -> f64,
    /// Changes it.
    pub set: fn(&mut PlantParameters, f64),
}

impl std::fmt::Debug for Quantity {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name)
    }
}

/// How the fit's coordinate u relates to a value.
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
