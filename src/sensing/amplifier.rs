//! The amplifier from the RC's 0-5 V to the regulator's 0-8 V: non-inverting, its gain set by two resistors.
//!
//! ```text
//! V_out = G V_in,   G = 1 + R_f / R_g = 1 + (G_n - 1) (1 + e_f) / (1 + e_g)
//! ```
//!
//! G_n nominal gain [1], R_f feedback and R_g ground resistor [ohm], e_f and e_g their relative errors [1].
//! The source paper shows no amplifier, but a 5 V PWM through an RC cannot give its 8 V: 1.6 is the gain that does.
//! The circuit is judged: it is the one stage that has this gain without turning the sign.

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmplifierParameters {
    /// Gain meant, which the software assumes [1], above 1.
    pub nominal_gain: f64,
    /// Relative error of the feedback resistor [1], between -0.5 and 0.5.
    pub feedback_resistor_error: f64,
    /// Relative error of the resistor to ground [1], between -0.5 and 0.5.
    pub ground_resistor_error: f64,
}

impl AmplifierParameters {
    /// With the resistors that were meant.
    pub fn exact(nominal_gain: f64) -> Self {
        Self {
            nominal_gain,
            feedback_resistor_error: 0.0,
            ground_resistor_error: 0.0,
        }
    }

    /// Gain that it has [1].
    pub fn gain(&self) -> f64 {
        1.0 + (self.nominal_gain - 1.0) * (1.0 + self.feedback_resistor_error)
            / (1.0 + self.ground_resistor_error)
    }

    /// Relative error of the gain [1].
    pub fn gain_error(&self) -> f64 {
        self.gain() / self.nominal_gain - 1.0
    }

    /// Greatest gain error [1] of resistors within a tolerance [1]: feedback high and ground low.
    pub fn greatest_gain_error(&self, tolerance: f64) -> f64 {
        Self {
            feedback_resistor_error: tolerance,
            ground_resistor_error: -tolerance,
            ..*self
        }
        .gain_error()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gain_is_that_of_the_two_resistors() {
        let (feedback, ground) = (6e3 * 1.05, 10e3 * 0.98);
        let amplifier = AmplifierParameters {
            nominal_gain: 1.6,
            feedback_resistor_error: 0.05,
            ground_resistor_error: -0.02,
        };
        assert!((amplifier.gain() - (1.0 + feedback / ground)).abs() < 1e-15);
        assert!((AmplifierParameters::exact(1.6).gain() * 5.0 - 8.0).abs() < 1e-15);
    }

    #[test]
    fn resistors_of_five_per_cent_cannot_make_the_deviations_of_the_paper() {
        let amplifier = AmplifierParameters::exact(1.6);
        // 0.6 / 1.6 ((1 + t) / (1 - t) - 1) = 0.75 t / (1 - t)
        for tolerance in [0.01, 0.05, 0.1] {
            let closed = 0.75 * tolerance / (1.0 - tolerance);
            assert!((amplifier.greatest_gain_error(tolerance) - closed).abs() < 1e-15);
        }
        assert!(amplifier.greatest_gain_error(0.05) < 0.060);
        assert!(amplifier.greatest_gain_error(0.10) > 0.065);
    }
}
