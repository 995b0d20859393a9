//! The magnetic position sensor on the cylinder.
//!
//! ```text
//! x_read = q round((g x + b + sigma n) / q)
//! ```
//!
//! g gain [1], b offset [m], sigma noise [m], q resolution [m]; a resolution of 0 does not round.
//! The source paper names the sensor and gives no number. Leaves out: nonlinearity along the stroke, lag.

use super::channel::{Sensor, quantised};
use super::noise::Noise;

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionSensorParameters {
    /// Reading over stroke [1], above 0.
    pub gain: f64,
    /// Offset of the reading [m].
    pub offset: f64,
    /// Standard deviation of the noise [m], at least 0.
    pub noise: f64,
    /// Resolution [m], at least 0.
    pub resolution: f64,
}

impl Sensor for PositionSensorParameters {
    fn read(&self, truth: f64, noise: &mut Noise) -> f64 {
        let sensed = self.gain * truth + self.offset + self.noise * noise.normal();
        quantised(sensed, self.resolution)
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::Stream;
    use super::*;

    #[test]
    fn reads_gain_offset_and_the_nearest_step() {
        let mut sensor = PositionSensorParameters {
            gain: 1.01,
            offset: 0.3e-3,
            noise: 0.0,
            resolution: 0.05e-3,
        };
        let mut noise = Noise::new(0, Stream::Stroke);
        // 20.2 + 0.3 mm lies on a step; 24.24 + 0.3 mm is 0.01 mm below one.
        assert!((sensor.read(0.020, &mut noise) - 20.5e-3).abs() < 1e-15);
        assert!((sensor.read(0.024, &mut noise) - 24.55e-3).abs() < 1e-15);
        sensor.resolution = 0.0;
        assert!((sensor.read(0.024, &mut noise) - 24.54e-3).abs() < 1e-15);
    }

    #[test]
    fn noise_has_its_standard_deviation() {
        let sensor = PositionSensorParameters {
            gain: 1.0,
            offset: 0.0,
            noise: 2e-5,
            resolution: 0.0,
        };
        let mut noise = Noise::new(4, Stream::Stroke);
        let count = 100_000;
        let squares: f64 = (0..count)
            .map(|_| (sensor.read(0.025, &mut noise) - 0.025).powi(2))
            .sum();
        assert!(((squares / f64::from(count)).sqrt() / 2e-5 - 1.0).abs() < 0.012);
    }
}
