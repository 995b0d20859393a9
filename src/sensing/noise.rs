//! Noise of the sensors: one stream of standard normal numbers for each.
//!
//! ```text
//! n ~ N(0, 1), from stream k of ChaCha8 under the seed
//! ```
//!
//! The streams of one seed do not overlap, so that what one sensor draws leaves the others' noise as it is.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Whose noise; the number is that of the stream and must stay, or recordings change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stream {
    /// The load cell's.
    Force = 1,
    /// The position sensor's.
    Stroke = 2,
    /// The accelerometer's.
    Acceleration = 3,
    /// The actual value's.
    RegulatorPressure = 4,
    /// The joints' encoders'.
    Encoders = 5,
    /// The currents' or torques' of the joints' drives.
    Drives = 6,
    /// The wrench sensor's.
    Wrench = 7,
}

/// A stream of standard normal numbers.
#[derive(Debug, Clone)]
pub struct Noise {
    generator: ChaCha8Rng,
}

impl Noise {
    /// The stream of a sensor under a seed, from its start.
    pub fn new(seed: u64, stream: Stream) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream as u64);
        Self { generator }
    }

    /// Next number: mean 0, standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.generator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(seed: u64, stream: Stream, count: usize) -> Vec<f64> {
        let mut noise = Noise::new(seed, stream);
        (0..count).map(|_| noise.normal()).collect()
    }

    #[test]
    fn moments_are_those_of_the_normal_distribution() {
        let count = 200_000;
        let drawn = draw(11, Stream::Force, count);
        let moment = |power: i32| drawn.iter().map(|x| x.powi(power)).sum::<f64>() / count as f64;
        // Bounds of five standard errors: sqrt(1, 2, 15, 96 / count).
        let bound = |variance: f64| 5.0 * (variance / count as f64).sqrt();
        assert!(moment(1).abs() < bound(1.0));
        assert!((moment(2) - 1.0).abs() < bound(2.0));
        assert!(moment(3).abs() < bound(15.0));
        assert!((moment(4) - 3.0).abs() < bound(96.0));
    }

    #[test]
    fn streams_are_uncorrelated_and_white() {
        let count = 100_000;
        let force = draw(5, Stream::Force, count);
        let stroke = draw(5, Stream::Stroke, count);
        let bound = 5.0 / (count as f64).sqrt();
        let product =
            |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / count as f64;
        assert!(product(&force, &stroke).abs() < bound);
        assert!(product(&force[1..], &force).abs() < bound);
    }

    #[test]
    fn the_seed_decides() {
        assert_eq!(draw(1, Stream::Stroke, 9), draw(1, Stream::Stroke, 9));
        assert_ne!(draw(1, Stream::Stroke, 9), draw(2, Stream::Stroke, 9));
    }
}
