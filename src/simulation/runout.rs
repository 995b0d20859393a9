//! Runout of the tool: the ball turns off its centre and stands out towards the part in turn.
//!
//!     l = a sin(2 pi f t),   F = k (d + l) + c (d' + l')
//!
//! a amplitude [m], f turns a second [Hz], d penetration without it [m]. The engine knows no rate of a contact's surface of its own, so that the lift given to
//! it stands ahead by c/k l'.

use std::f64::consts::TAU;

use super::contact::PartContactParameters;

/// A tool's runout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Runout {
    /// Zero to peak [m].
    pub amplitude: f64,
    /// Turns a second [Hz].
    pub frequency: f64,
}

impl Runout {
    /// Lift [m] to be given to the engine at a time [s].
    pub fn lift(&self, time: f64, contact: &PartContactParameters) -> f64 {
        let rate = TAU * self.frequency;
        let (sine, cosine) = (rate * time).sin_cos();
        self.amplitude * (sine + contact.damping / contact.stiffness * rate * cosine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lift_stands_ahead_by_what_the_damper_feels() {
        let contact = PartContactParameters {
            stiffness: 1e5,
            damping: 300.0,
            friction: 0.0,
        };
        let runout = Runout {
            amplitude: 5e-5,
            frequency: 20.0,
        };
        for step in 0..50 {
            let time = f64::from(step) * 1.7e-3;
            let (sine, cosine) = (TAU * 20.0 * time).sin_cos();
            let force = 1e5 * 5e-5 * sine + 300.0 * 5e-5 * TAU * 20.0 * cosine;
            assert!((1e5 * runout.lift(time, &contact) - force).abs() < 1e-9);
        }
    }
}
