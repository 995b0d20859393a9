//! The tool on the workpiece: a law that pushes and never pulls, on a surface that may not be where the robot says.
//!
//! ```text
//! F = max(0, k d + c d_dot)            spring and damper
//! F = max(0, k d^(3/2) + c d_dot)      Hertz, a ball on a flat (Johnson, Contact Mechanics, 1985, eq. 4.23)
//! x_s = x_robot + o + sum a sin(2 pi f t + phi)
//! ```
//!
//! d penetration of the tool beyond the surface [m], x_s where the surface stands along the stroke [m], o offset [m], a amplitude [m], f frequency [Hz].

use super::registry;
use std::f64::consts::TAU;

/// Force against penetration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactLaw {
    /// In proportion; stiffness [N/m].
    Linear {
        /// Stiffness [N/m].
        stiffness: f64,
    },
    /// With the power 3/2.
    Hertz {
        /// Stiffness [N/m^1.5].
        stiffness: f64,
    },
}

/// Recordings that may each have a phase of their own; those beyond have that of the first.
pub const PHASES: usize = 16;

/// A periodic deviation of the surface along extension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Periodic {
    /// Amplitude of its sine [m].
    pub sine: f64,
    /// Amplitude of its cosine [m].
    pub cosine: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase at the start of each of the recordings that are fitted together, ahead of that of sine and cosine [rad].
    pub phases: [f64; PHASES],
}

impl Periodic {
    /// No deviation.
    pub const NONE: Self = Self {
        sine: 0.0,
        cosine: 0.0,
        frequency: 1.0,
        phases: [0.0; PHASES],
    };

    /// As one of the recordings has it, by its place among them.
    #[must_use]
    fn in_recording(&self, recording: usize) -> Self {
        let (sin, cos) = self
            .phases
            .get(recording)
            .map_or((0.0, 1.0), |phase| phase.sin_cos());
        Self {
            sine: self.sine * cos - self.cosine * sin,
            cosine: self.sine * sin + self.cosine * cos,
            phases: Self::NONE.phases,
            ..*self
        }
    }

    /// Zero to peak [m].
    pub fn amplitude(&self) -> f64 {
        self.sine.hypot(self.cosine)
    }

    /// Deviation [m] and its rate [m/s] at a time [s].
    pub fn at(&self, time: f64) -> (f64, f64) {
        let rate = TAU * self.frequency;
        let (sine, cosine) = (rate * time).sin_cos();
        (
            self.sine * sine + self.cosine * cosine,
            rate * (self.sine * cosine - self.cosine * sine),
        )
    }
}

/// Contact of tool and workpiece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactParameters {
    /// The elastic part.
    pub law: ContactLaw,
    /// Damping [N s/m].
    pub damping: f64,
    /// The surface lies off where the robot says, positive along extension [m].
    pub surface_offset: f64,
    /// Turns of the tool a second [Hz]; 0 where it is not known.
    pub spindle_frequency: f64,
    /// The tool turns off centre.
    pub runout: Periodic,
    /// The surface is wavy.
    pub waviness: Periodic,
}

impl ContactParameters {
    /// A smooth surface where the robot has it, of a stiffness [N/m] and a damping [N s/m].
    pub const fn linear(stiffness: f64, damping: f64) -> Self {
        Self {
            law: ContactLaw::Linear { stiffness },
            damping,
            surface_offset: 0.0,
            spindle_frequency: 0.0,
            runout: Periodic::NONE,
            waviness: Periodic::NONE,
        }
    }

    /// The contact of a device of which nothing else is said, of one that may be ideal.
    pub fn usual(ideal: bool) -> Self {
        let [stiffness, damping] = [&registry::CONTACT_STIFFNESS, &registry::CONTACT_DAMPING]
            .map(|number| number.default_of(ideal));
        Self::linear(stiffness, damping)
    }

    /// As one of the recordings that are fitted together has it, by its place among them.
    #[must_use]
    pub fn in_recording(&self, recording: usize) -> Self {
        Self {
            runout: self.runout.in_recording(recording),
            waviness: self.waviness.in_recording(recording),
            ..*self
        }
    }

    /// Distance of the surface beyond where the robot says [m] at a time [s], and the rate of that [m/s].
    pub fn deviation(&self, time: f64) -> (f64, f64) {
        let (mut deviation, mut rate) = (self.surface_offset, 0.0);
        for periodic in [&self.runout, &self.waviness] {
            if *periodic != Periodic::NONE {
                let (more, its_rate) = periodic.at(time);
                deviation += more;
                rate += its_rate;
            }
        }
        (deviation, rate)
    }

    /// The least that `deviation` can be at any time [m].
    pub fn least_deviation(&self) -> f64 {
        self.surface_offset - self.runout.amplitude() - self.waviness.amplitude()
    }

    /// Force at a penetration [m] and its rate [m/s] as it holds while it pushes [N].
    pub fn pushing(&self, penetration: f64, rate: f64) -> f64 {
        let elastic = match self.law {
            ContactLaw::Linear { stiffness } => stiffness * penetration,
            ContactLaw::Hertz { stiffness } => {
                let depth = penetration.max(0.0);
                stiffness * depth * depth.sqrt()
            }
        };
        elastic + self.damping * rate
    }

    /// Force at a penetration [m] and its rate [m/s] [N].
    pub fn force(&self, penetration: f64, rate: f64) -> f64 {
        if penetration > 0.0 {
            self.pushing(penetration, rate).max(0.0)
        } else {
            0.0
        }
    }

    /// Stiffness [N/m] at a force [N].
    pub fn stiffness_at(&self, force: f64) -> f64 {
        match self.law {
            ContactLaw::Linear { stiffness } => stiffness,
            // dF/dd = 3/2 k^(2/3) F^(1/3)
            ContactLaw::Hertz { stiffness } => 1.5 * (stiffness * stiffness * force).cbrt(),
        }
    }

    /// Fastest rate of a mass [kg] on it [1/s], under a force of the order of that of the device.
    pub fn rate(&self, mass: f64) -> f64 {
        /// A force that a deburring device does not exceed by much [N].
        const LARGE_FORCE: f64 = 600.0;
        (self.stiffness_at(LARGE_FORCE) / mass)
            .sqrt()
            .max(self.damping / mass)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_of_a_recording_is_a_shift_in_time_of_that_one_alone() {
        let mut contact = ContactParameters::linear(1e5, 100.0);
        contact.runout = Periodic {
            sine: 3e-5,
            cosine: -2e-5,
            frequency: 7.0,
            ..Periodic::NONE
        };
        let plain = contact;
        contact.runout.phases[2] = 0.8;
        for time in [0.0, 0.013, 1.7] {
            let ahead = time + 0.8 / (TAU * 7.0);
            let [(found, rate), (expected, its_rate)] = [
                contact.in_recording(2).deviation(time),
                plain.deviation(ahead),
            ];
            assert!((found - expected).abs() < 1e-15 && (rate - its_rate).abs() < 1e-12);
            assert_eq!(
                contact.in_recording(1).deviation(time),
                plain.deviation(time)
            );
            assert_eq!(
                contact.in_recording(PHASES).deviation(time),
                plain.deviation(time)
            );
        }
    }
}
