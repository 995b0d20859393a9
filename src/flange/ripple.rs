//! The arm's own unrest while it carries the tool along a surface.
//!
//! ```text
//! v_n = r v w,    w white, twice behind a first-order low-pass at f, of variance 1
//! ```
//!
//! v_n speed towards the surface [m/s], v speed along it [m/s], r ripple [1], f bandwidth [Hz]. Gears and bearings of a serial arm make it: errors per turn,
//! so that their speed grows with the arm's, filtered by the arm's own structure. Friction of the seals follows the sign of v_n, which is what the force
//! then shows. Leaves out: single lines, and roughness under the tool.

use std::f64::consts::TAU;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Unrest of an arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ripple {
    /// Speed towards the surface by that along it [1].
    pub ratio: f64,
    /// Bandwidth [Hz].
    pub bandwidth: f64,
}

/// Adds a ripple to speeds towards the surface of an arm that goes along it at others [m/s], a period [s] between values. The same seed, the same ripple.
pub fn rippled(towards: &mut [f64], along: &[f64], period: f64, ripple: Ripple, seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let pole = (-TAU * ripple.bandwidth * period).exp();
    let mut filtered = [0.0f64; 2];
    // Variance of white noise behind the two low-passes: (1 - a)^4 (1 + a^2)/(1 - a^2)^3.
    let variance = (1.0 - pole).powi(4) * (1.0 + pole * pole) / (1.0 - pole * pole).powi(3);
    let scale = ripple.ratio / variance.sqrt();
    for (speed, along) in towards.iter_mut().zip(along) {
        let white: f64 = StandardNormal.sample(&mut random);
        filtered[0] = pole * filtered[0] + (1.0 - pole) * white;
        filtered[1] = pole * filtered[1] + (1.0 - pole) * filtered[0];
        *speed += scale * along * filtered[1];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_the_size_that_is_asked_for() {
        let ripple = Ripple {
            ratio: 0.02,
            bandwidth: 30.0,
        };
        let mut speed = vec![0.0; 200_000];
        rippled(&mut speed, &vec![0.1; 200_000], 0.002, ripple, 1);
        let square = speed.iter().map(|v| v * v).sum::<f64>() / 2e5;
        assert!((square.sqrt() / 0.002 - 1.0).abs() < 0.03);
    }
}
