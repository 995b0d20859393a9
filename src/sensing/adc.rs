//! Analogue to digital converter: mid-tread, and its input clips.
//!
//! ```text
//! code = round(V / q + sigma n), kept within 0 .. 2^b - 1,   q = V_ref / 2^b
//! ```
//!
//! V input [V], V_ref reference [V], b bits, sigma noise in steps, n a standard normal number.
//! The ATmega2560's: 10 bits, and ideally its first transition at half a step (data sheet, "ADC Accuracy Definitions").
//! Leaves out: nonlinearity, the time that a conversion takes.

use super::noise::Noise;

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdcParameters {
    /// Bits, 1 to 24.
    pub bits: u32,
    /// Reference voltage [V], above 0.
    pub reference: f64,
    /// Standard deviation of its own noise, in steps [1]; at least 0.
    pub noise: f64,
}

impl AdcParameters {
    /// The Arduino MEGA 2560's, without noise of its own.
    pub const ARDUINO: Self = Self {
        bits: 10,
        reference: 5.0,
        noise: 0.0,
    };

    /// Step [V].
    pub fn step(&self) -> f64 {
        self.reference / f64::from(1 << self.bits)
    }

    /// Voltage of the highest code [V], one step below the reference.
    pub fn highest(&self) -> f64 {
        self.volts((1 << self.bits) - 1)
    }

    /// Code of an input [V], shifted by noise in steps [1].
    pub fn code(&self, input: f64, noise: f64) -> u32 {
        // A cast from f64 keeps within u32: below 0 becomes 0.
        ((input / self.step() + noise).round() as u32).min((1 << self.bits) - 1)
    }

    /// Voltage that the software makes of a code [V].
    pub fn volts(&self, code: u32) -> f64 {
        f64::from(code) * self.step()
    }

    /// Voltage that the software makes of an input [V].
    pub fn convert(&self, input: f64, noise: &mut Noise) -> f64 {
        self.volts(self.code(input, self.noise * noise.normal()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::Stream;
    use super::*;

    #[test]
    fn codes_change_half_way_between_steps_and_clip_at_both_ends() {
        let adc = AdcParameters::ARDUINO;
        let step = 5.0 / 1024.0;
        assert_eq!(adc.step(), step);
        for code in [0, 1, 511, 1022] {
            let border = (f64::from(code) + 0.5) * step;
            assert_eq!(adc.code(border - 1e-9, 0.0), code);
            assert_eq!(adc.code(border + 1e-9, 0.0), code + 1);
        }
        assert_eq!(adc.code(-3.0, 0.0), 0);
        assert_eq!(adc.code(7.0, 0.0), 1023);
        assert_eq!(adc.highest(), 5.0 - step);
    }

    #[test]
    fn quantisation_error_is_uniform_over_a_step() {
        let adc = AdcParameters::ARDUINO;
        let mut noise = Noise::new(1, Stream::Force);
        let count = 100_000;
        let mut squares = 0.0;
        for k in 0..count {
            let input = 0.1 + 4.5 * f64::from(k) / f64::from(count);
            let error = adc.convert(input, &mut noise) - input;
            assert!(error.abs() <= 0.5 * adc.step() * (1.0 + 1e-9));
            squares += error * error;
        }
        let deviation = (squares / f64::from(count)).sqrt();
        assert!((deviation / (adc.step() / 12f64.sqrt()) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn noise_is_counted_in_steps() {
        let adc = AdcParameters {
            noise: 3.0,
            ..AdcParameters::ARDUINO
        };
        let mut noise = Noise::new(8, Stream::Force);
        let count = 100_000;
        let squares: f64 = (0..count)
            .map(|_| (adc.convert(2.5, &mut noise) - 2.5).powi(2))
            .sum();
        let steps = (squares / f64::from(count)).sqrt() / adc.step();
        // Rounding adds the variance of a uniform step.
        assert!((steps / (9.0f64 + 1.0 / 12.0).sqrt() - 1.0).abs() < 0.01);
    }
}
