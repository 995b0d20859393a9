//! The load cell: bridge, INA125P, ADC, and the software that assumes a gain resistor.
//!
//! ```text
//! V_b = s V_x (F + b + sigma n) / F_c,   F_read = F_c (V_adc - V_ref) / (s V_x G_a)
//! ```
//!
//! s rated output [V/V], V_x excitation [V], F_c capacity [N], b zero offset [N], G_a gain with the resistor that is assumed.
//! Source paper, section 3: 50 kg, 2.0 mV/V, INA125P with 100 ohm (121 ohm as assumption), taken here as 100 ohm fitted and
//! 121 ohm in the software: it reads 604 / 499.87 = 1.208 times the force, and the ADC is full at 41 kg.
//! Leaves out: hysteresis, creep, temperature.

use super::adc::AdcParameters;
use super::channel::Sensor;
use super::instrumentation_amplifier::InstrumentationAmplifierParameters;
use super::noise::Noise;

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadCellParameters {
    /// Capacity [N], above 0.
    pub capacity: f64,
    /// Bridge voltage at capacity over excitation [V/V], above 0.
    pub rated_output: f64,
    /// Excitation [V], above 0.
    pub excitation: f64,
    /// Zero offset of the bridge, as a force [N].
    pub zero_offset: f64,
    /// Standard deviation of the noise before the amplifier, as a force [N], at least 0.
    pub noise: f64,
    /// The amplifier with the gain resistor that is fitted.
    pub amplifier: InstrumentationAmplifierParameters,
    /// Gain resistor that the software assumes [ohm], above 0.
    pub assumed_gain_resistor: f64,
    /// The ADC.
    pub adc: AdcParameters,
}

impl LoadCellParameters {
    /// Relative error of the reading for the resistor that is not the assumed one [1].
    pub fn gain_error(&self) -> f64 {
        self.amplifier.gain() / self.assumed_gain() - 1.0
    }

    /// Force at which the reading stops growing [N]: the ADC's highest code or the amplifier's swing.
    pub fn clipping_force(&self) -> f64 {
        let highest = self.adc.highest().min(self.amplifier.highest_output);
        (highest - self.amplifier.reference_voltage) / (self.amplifier.gain() * self.sensitivity())
            - self.zero_offset
    }

    /// Step of the reading [N].
    pub fn step(&self) -> f64 {
        self.adc.step() / (self.assumed_gain() * self.sensitivity())
    }

    fn assumed_gain(&self) -> f64 {
        InstrumentationAmplifierParameters::gain_with(self.assumed_gain_resistor)
    }

    /// Bridge voltage per force [V/N].
    fn sensitivity(&self) -> f64 {
        self.rated_output * self.excitation / self.capacity
    }
}

impl Sensor for LoadCellParameters {
    fn read(&self, truth: f64, noise: &mut Noise) -> f64 {
        let force = truth + self.zero_offset + self.noise * noise.normal();
        let output = self.amplifier.output(self.sensitivity() * force);
        let converted = self.adc.convert(output, noise);
        (converted - self.amplifier.reference_voltage) / (self.assumed_gain() * self.sensitivity())
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::Stream;
    use super::super::parameters::paper_load_cell;
    use super::*;

    /// Weight of a kilogram [N].
    const KILOGRAM: f64 = 9.80665;

    fn quiet() -> LoadCellParameters {
        LoadCellParameters {
            noise: 0.0,
            ..paper_load_cell()
        }
    }

    fn read(cell: &LoadCellParameters, truth: f64) -> f64 {
        cell.read(truth, &mut Noise::new(0, Stream::Force))
    }

    #[test]
    fn the_wrong_resistor_reads_20_8_per_cent_too_much() {
        let cell = quiet();
        assert!((cell.gain_error() - 0.208).abs() < 5e-4);
        for truth in [50.0, 200.0, 390.0] {
            let expected = 604.0 / (4.0 + 60e3 / 121.0) * truth;
            assert!((read(&cell, truth) - expected).abs() <= 0.5 * cell.step());
        }
        let known = LoadCellParameters {
            assumed_gain_resistor: 100.0,
            ..cell
        };
        assert_eq!(known.gain_error(), 0.0);
        assert!((read(&known, 200.0) - 200.0).abs() <= 0.5 * known.step());
    }

    #[test]
    fn the_adc_clips_at_41_kilograms() {
        let cell = quiet();
        // 5 V / 604 of 10 mV of 50 kg, less a step.
        let full: f64 = 5.0 / 604.0 / 0.010 * 50.0;
        assert!((full - 41.39).abs() < 0.01);
        let clipping = cell.clipping_force() / KILOGRAM;
        assert!((clipping - full * 1023.0 / 1024.0).abs() < 1e-9);
        // What it shows then is the cell's capacity: nothing looks wrong.
        let highest = read(&cell, cell.clipping_force() + 1e-6);
        assert!((highest / KILOGRAM - 50.0).abs() < 0.04);
        assert_eq!(read(&cell, 50.0 * KILOGRAM), highest);
        assert_eq!(read(&cell, 400.0 * KILOGRAM), highest);
        let step = cell.step() / (1.0 + cell.gain_error());
        assert!(read(&cell, cell.clipping_force() - step) < highest - 0.9 * cell.step());
        // A zero offset takes its share of the range.
        let offset = LoadCellParameters {
            zero_offset: 10.0,
            ..cell
        };
        assert!((cell.clipping_force() - offset.clipping_force() - 10.0).abs() < 1e-9);
        assert_eq!(read(&offset, offset.clipping_force() + 1e-6), highest);
        // With the resistor that was meant, 50 kg are just not clipped.
        let mut meant = cell;
        meant.amplifier.gain_resistor = 121.0;
        assert!((meant.clipping_force() / KILOGRAM - 50.0).abs() < 0.04);
    }

    #[test]
    fn a_pull_is_lost_unless_the_reference_is_raised() {
        let mut cell = quiet();
        assert_eq!(read(&cell, -30.0), 0.0);
        cell.amplifier.reference_voltage = 1.0;
        let expected = -30.0 * (1.0 + cell.gain_error());
        assert!((read(&cell, -30.0) - expected).abs() <= 0.51 * cell.step());
    }

    #[test]
    fn the_amplifiers_swing_can_clip_first() {
        let mut cell = quiet();
        cell.amplifier.highest_output = 3.8;
        assert!((cell.clipping_force() / KILOGRAM - 3.8 / 6.04 * 50.0).abs() < 1e-9);
        assert_eq!(
            read(&cell, cell.clipping_force()),
            read(&cell, 50.0 * KILOGRAM)
        );
    }

    #[test]
    fn offset_and_noise_are_amplified_like_the_force() {
        let cell = LoadCellParameters {
            zero_offset: 4.0,
            noise: 2.5,
            ..paper_load_cell()
        };
        let mut noise = Noise::new(3, Stream::Force);
        let count = 100_000;
        let readings: Vec<f64> = (0..count).map(|_| cell.read(150.0, &mut noise)).collect();
        let mean = readings.iter().sum::<f64>() / f64::from(count);
        let variance = readings.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / f64::from(count);
        let gain = 1.0 + cell.gain_error();
        assert!((mean / (154.0 * gain) - 1.0).abs() < 5e-4);
        let expected = (2.5 * gain).powi(2) + cell.step().powi(2) / 12.0;
        assert!((variance / expected - 1.0).abs() < 0.02);
    }
}
