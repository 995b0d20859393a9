//! A measured quantity: read as it is, with white noise, or through a real sensor.
//!
//! ```text
//! reading = truth,   truth + sigma n,   or what the sensor makes of it
//! ```

use super::noise::Noise;

/// A real sensor with all that follows it up to the number in the software.
pub trait Sensor {
    /// Number that the software gets for a true value; both SI.
    fn read(&self, truth: f64, noise: &mut Noise) -> f64;
}

/// Measurement of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Measurement<S> {
    /// The truth.
    #[default]
    Ideal,
    /// The truth and white noise.
    White {
        /// Standard deviation, in the quantity's unit; at least 0.
        standard_deviation: f64,
    },
    /// A real sensor.
    Real(S),
}

impl<S: Sensor> Measurement<S> {
    /// Number that the software gets for a true value.
    pub fn read(&self, truth: f64, noise: &mut Noise) -> f64 {
        match self {
            Self::Ideal => truth,
            Self::White { standard_deviation } => truth + standard_deviation * noise.normal(),
            Self::Real(sensor) => sensor.read(truth, noise),
        }
    }
}

/// The multiple of `quantum` nearest to a value; the value itself for a quantum of 0.
pub(super) fn quantised(value: f64, quantum: f64) -> f64 {
    if quantum > 0.0 {
        (value / quantum).round() * quantum
    } else {
        value
    }
}
