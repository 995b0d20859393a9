//! The accelerometer: orthogonal acceleration of the device, along its axis, gravity removed.
//!
//! ```text
//! a_read = q round(A / q),   A = a + b + sigma n, kept within -r .. r
//! ```
//!
//! b bias [m/s2], sigma noise [m/s2], r range [m/s2], q resolution [m/s2]; a resolution of 0 does not round.
//! The source paper names the sensor and gives no number. Leaves out: bandwidth, cross axes, and the error of the gravity that
//! is removed, which acts like the bias.

use super::channel::{Sensor, quantised};
use super::noise::Noise;

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccelerometerParameters {
    /// Bias [m/s2].
    pub bias: f64,
    /// Standard deviation of the noise [m/s2], at least 0.
    pub noise: f64,
    /// Range to either side [m/s2], above 0.
    pub range: f64,
    /// Resolution [m/s2], at least 0.
    pub resolution: f64,
}

impl Sensor for AccelerometerParameters {
    fn read(&self, truth: f64, noise: &mut Noise) -> f64 {
        let sensed = truth + self.bias + self.noise * noise.normal();
        quantised(sensed.clamp(-self.range, self.range), self.resolution)
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::Stream;
    use super::*;

    #[test]
    fn adds_the_bias_rounds_and_clips() {
        let sensor = AccelerometerParameters {
            bias: 0.12,
            noise: 0.0,
            range: 30.0,
            resolution: 0.25,
        };
        let mut noise = Noise::new(0, Stream::Acceleration);
        assert_eq!(sensor.read(1.0, &mut noise), 1.0);
        assert_eq!(sensor.read(1.01, &mut noise), 1.25);
        assert_eq!(sensor.read(200.0, &mut noise), 30.0);
        assert_eq!(sensor.read(-200.0, &mut noise), -30.0);
    }

    #[test]
    fn noise_and_bias_have_their_size() {
        let sensor = AccelerometerParameters {
            bias: -0.3,
            noise: 0.05,
            range: 30.0,
            resolution: 0.0,
        };
        let mut noise = Noise::new(6, Stream::Acceleration);
        let count = 100_000;
        let errors: Vec<f64> = (0..count)
            .map(|_| sensor.read(2.0, &mut noise) - 2.0)
            .collect();
        let mean = errors.iter().sum::<f64>() / f64::from(count);
        let variance = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / f64::from(count);
        assert!((mean + 0.3).abs() < 8e-4);
        assert!((variance.sqrt() / 0.05 - 1.0).abs() < 0.012);
    }
}
