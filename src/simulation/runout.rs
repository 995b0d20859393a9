//! Runout of the tool: the ball turns off its centre and stands out towards the part in turn.
//!
//!     l = a sin(2 pi f t),   F = k (d + l) + c (d' + l')
//!
//! a amplitude [m], f turns a second [Hz], d penetration without it [m]. The engine knows no rate of a contact's surface of its own, so that the lift given to
//! it stands ahead by c/k l'.

use std::f64::consts::TAU;

use crate::scenario::ContactScenario;

/// A tool's runout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Runout {
    /// Zero to peak [m].
    amplitude: f64,
    /// Angle that the tool turns in a second [rad/s].
    rate: f64,
    /// Time by which the lift stands ahead [s]: the contact's damping over its stiffness.
    lead: f64,
}

impl Runout {
    /// The runout of a contact's tool, if it has any.
    pub fn of(contact: &ContactScenario) -> Option<Self> {
        (contact.runout_amplitude > 0.0).then(|| Self {
            amplitude: contact.runout_amplitude,
            rate: TAU * contact.runout_frequency,
            lead: contact.damping / contact.stiffness,
        })
    }

    /// Lift [m] to be given to the engine at a time [s].
    pub fn lift(&self, time: f64) -> f64 {
        let (sine, cosine) = (self.rate * time).sin_cos();
        self.amplitude * (sine + self.lead * self.rate * cosine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lift_stands_ahead_by_what_the_damper_feels() {
        let mut contact = ContactScenario {
            stiffness: 1e5,
            damping: 300.0,
            friction: 0.0,
            runout_amplitude: 5e-5,
            runout_frequency: 20.0,
        };
        let runout = Runout::of(&contact).unwrap();
        for step in 0..50 {
            let time = f64::from(step) * 1.7e-3;
            let (sine, cosine) = (TAU * 20.0 * time).sin_cos();
            let force = 1e5 * 5e-5 * sine + 300.0 * 5e-5 * TAU * 20.0 * cosine;
            assert!((1e5 * runout.lift(time) - force).abs() < 1e-9);
        }
        contact.runout_amplitude = 0.0;
        assert!(Runout::of(&contact).is_none());
    }
}
