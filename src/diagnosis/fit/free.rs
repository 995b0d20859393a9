//! A quantity that a fit may move, and its prior before the recordings are looked at.

use crate::diagnosis::recordings::device::Device;
use crate::diagnosis::recordings::subject::Subject;
use crate::effects::{Coordinate, Effect};
use crate::plant::PlantParameters;
use crate::plant::registry::PRESSURE_DRIFT;

/// Standard deviations of a sensor's drift that its sheet allows [1].
const ALLOWED: f64 = 3.0;

/// Belief about a quantity before the recordings are looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prior {
    /// Normal, in the quantity's unit.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
    },
    /// Anything between the bounds.
    Flat,
    /// Held at its value: a channel of its own has determined it, with a standard deviation in the quantity's unit.
    Settled {
        /// Standard deviation.
        deviation: f64,
    },
}

/// A quantity that a fit may move.
#[derive(Debug, Clone, Copy)]
pub struct Free<S: Subject = Device> {
    /// The quantity.
    pub quantity: S::Quantity,
    /// Where it starts.
    pub start: f64,
    /// Coordinate of the fit.
    pub coordinate: Coordinate,
    /// Least and largest value.
    pub bounds: [f64; 2],
    /// The belief.
    pub prior: Prior,
}

impl Free {
    /// The same, of a sensor's drift no further than the sheet allows: a multiple of that explains any slow loss, and so hides a leak.
    #[must_use]
    pub fn within_sheet(&self) -> Self {
        match self.prior {
            Prior::Normal { mean, deviation } if self.quantity.is(&PRESSURE_DRIFT.quantity()) => {
                let half = ALLOWED * deviation;
                Self {
                    bounds: [mean - half, mean + half],
                    ..*self
                }
            }
            _ => *self,
        }
    }
}

impl<S: Subject> Free<S> {
    /// The same from another start.
    #[must_use]
    pub fn from(self, start: f64) -> Self {
        Self { start, ..self }
    }

    /// The same from where it stands in a description.
    #[must_use]
    pub fn from_where(self, plant: &S::Model) -> Self {
        self.from(self.clamp(S::value(&self.quantity, plant)))
    }

    /// The nearest value within the bounds.
    pub fn clamp(&self, value: f64) -> f64 {
        value.clamp(self.bounds[0], self.bounds[1])
    }

    /// Ways that a fit may move it from a value, in the fit's coordinate.
    pub fn room(&self, value: f64) -> [f64; 2] {
        match self.prior {
            Prior::Settled { .. } => [0.0, 0.0],
            _ => (self.bounds).map(|bound| self.coordinate.of(bound) - self.coordinate.of(value)),
        }
    }

    /// Departure from the prior in its standard deviations.
    pub fn departure(&self, value: f64) -> f64 {
        match self.prior {
            Prior::Normal { mean, deviation } => (value - mean) / deviation,
            Prior::Flat | Prior::Settled { .. } => 0.0,
        }
    }

    /// d departure / d coordinate at a value.
    pub fn departure_slope(&self, value: f64) -> f64 {
        match self.prior {
            Prior::Normal { deviation, .. } | Prior::Settled { deviation } => {
                self.coordinate.slope(value) / deviation
            }
            Prior::Flat => 0.0,
        }
    }
}

/// The numbers of an effect as free quantities from a start.
pub fn free_of(effect: &Effect, plant: &PlantParameters, start: &[f64]) -> Vec<Free> {
    effect
        .parameters(plant)
        .into_iter()
        .zip(start)
        .map(|(parameter, start)| Free {
            quantity: parameter.quantity,
            start: *start,
            coordinate: parameter.coordinate,
            bounds: parameter.bounds,
            prior: Prior::Flat,
        })
        .collect()
}
