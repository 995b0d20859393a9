//! The INA125P: gain of one resistor, output kept within its swing.
//!
//! ```text
//! V = V_ref + G V_in, kept within the swing,   G = 4 + 60 kohm / R_G      (INA125 data sheet, SBOS060)
//! ```
//!
//! V_in bridge voltage [V], V_ref voltage at its reference pin [V], R_G gain resistor [ohm].
//! Leaves out: its bandwidth, and its own offset and noise, for which the cell's zero offset and noise stand.

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InstrumentationAmplifierParameters {
    /// Gain resistor that is fitted [ohm], above 0.
    pub gain_resistor: f64,
    /// Voltage at the reference pin, which is the output without load [V], within the swing.
    pub reference_voltage: f64,
    /// Lowest output [V].
    pub lowest_output: f64,
    /// Highest output [V], above the lowest.
    pub highest_output: f64,
}

impl InstrumentationAmplifierParameters {
    /// Gain [1] with a gain resistor [ohm].
    pub fn gain_with(resistor: f64) -> f64 {
        4.0 + 60e3 / resistor
    }

    /// Gain with the resistor that is fitted [1].
    pub fn gain(&self) -> f64 {
        Self::gain_with(self.gain_resistor)
    }

    /// Output [V] for a bridge voltage [V].
    pub fn output(&self, bridge: f64) -> f64 {
        (self.reference_voltage + self.gain() * bridge)
            .clamp(self.lowest_output, self.highest_output)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_of_the_two_resistors_of_the_paper() {
        let gain = InstrumentationAmplifierParameters::gain_with;
        assert_eq!(gain(100.0), 604.0);
        assert!((gain(121.0) - 499.867_768_595).abs() < 1e-9);
        // 50 kg give 10 mV: with 121 ohm they fill 5 V, which is why that resistor was meant.
        assert!((gain(121.0) * 0.010 - 5.0).abs() < 0.0014);
    }

    #[test]
    fn output_stays_within_the_swing() {
        let amplifier = InstrumentationAmplifierParameters {
            gain_resistor: 100.0,
            reference_voltage: 0.5,
            lowest_output: 0.0,
            highest_output: 5.0,
        };
        assert!((amplifier.output(1e-3) - 1.104).abs() < 1e-12);
        assert!((amplifier.output(-5e-4) - 0.198).abs() < 1e-12);
        assert_eq!(amplifier.output(-1e-3), 0.0);
        assert_eq!(amplifier.output(1e-2), 5.0);
    }
}
