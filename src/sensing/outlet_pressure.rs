//! The actual value: the regulator's own outlet sensor, the linear converter, and the ADC.
//!
//! ```text
//! V_s = V_0 + (V_1 - V_0) (1 + e) p / p_fs,   V = c V_s,   p_read = p_fs (V_adc / c_a - V_0) / (V_1 - V_0)
//! ```
//!
//! V_0, V_1 the sensor's voltage at no and full pressure [V], p_fs full scale [Pa, gauge], e scale error of the sensor [1],
//! c gain of the converter [1] and c_a the one that the software assumes. Source paper, section 3: 1.25-6.25 V to 1-5 V, so
//! c = 0.8. Leaves out: offset and lag of the sensor.

use super::adc::AdcParameters;
use super::channel::Sensor;
use super::noise::Noise;

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutletPressureParameters {
    /// Pressure at the full voltage, gauge [Pa], above 0.
    pub full_scale: f64,
    /// The sensor's voltage without pressure [V], at least 0.
    pub zero_voltage: f64,
    /// The sensor's voltage at full scale [V], above `zero_voltage`.
    pub full_voltage: f64,
    /// Relative error of the sensor's scale [1], between -0.5 and 0.5.
    pub scale_error: f64,
    /// Gain of the converter [1], above 0.
    pub converter_gain: f64,
    /// Gain that the software assumes [1], above 0.
    pub assumed_converter_gain: f64,
    /// Standard deviation of the sensor's noise [Pa], at least 0.
    pub noise: f64,
    /// The ADC.
    pub adc: AdcParameters,
}

impl OutletPressureParameters {
    /// Step of the reading [Pa].
    pub fn step(&self) -> f64 {
        self.adc.step() / self.assumed_converter_gain * self.full_scale
            / (self.full_voltage - self.zero_voltage)
    }
}

impl Sensor for OutletPressureParameters {
    fn read(&self, truth: f64, noise: &mut Noise) -> f64 {
        let span = self.full_voltage - self.zero_voltage;
        let pressure = truth + self.noise * noise.normal();
        let sensed =
            self.zero_voltage + span * (1.0 + self.scale_error) * pressure / self.full_scale;
        let converted = self.adc.convert(self.converter_gain * sensed, noise);
        (converted / self.assumed_converter_gain - self.zero_voltage) / span * self.full_scale
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::Stream;
    use super::super::parameters::paper_outlet_pressure;
    use super::*;

    fn read(sensor: &OutletPressureParameters, truth: f64) -> f64 {
        sensor.read(truth, &mut Noise::new(0, Stream::RegulatorPressure))
    }

    #[test]
    fn reads_within_half_a_step_up_to_the_highest_code() {
        let sensor = paper_outlet_pressure();
        // 4 V of 5 V carry the full scale.
        let step = sensor.full_scale / (0.8 * 1024.0);
        assert!((sensor.step() - step).abs() < 1e-9);
        for k in 0..=99 {
            let truth = sensor.full_scale * f64::from(k) / 100.0;
            assert!((read(&sensor, truth) - truth).abs() <= 0.5 * step * (1.0 + 1e-9));
        }
        let highest = sensor.full_scale - step;
        assert!((read(&sensor, 2.0 * sensor.full_scale) - highest).abs() < 1e-6);
    }

    #[test]
    fn a_scale_error_is_proportional_and_a_converter_error_is_not() {
        let mut sensor = paper_outlet_pressure();
        sensor.adc.bits = 24;
        sensor.scale_error = 0.063;
        for truth in [1.2e5, 2.1e5, 3.0e5] {
            assert!((read(&sensor, truth) / truth - 1.063).abs() < 1e-5);
        }
        sensor.scale_error = 0.0;
        sensor.converter_gain = 0.8 * 1.02;
        // 2 % of the sensor's 1.25 V above zero: a quarter of the span.
        let offset = 0.02 * 0.25 * sensor.full_scale;
        for truth in [1.2e5, 2.1e5, 3.0e5] {
            assert!((read(&sensor, truth) - (1.02 * truth + offset)).abs() < 1.0);
        }
    }
}
