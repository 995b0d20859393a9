//! The set value on its way to the regulator: pressure, PWM, RC, amplifier, and pressure again.
//!
//! ```text
//! p_told = p_fs V / V_fs,   V = G v kept within 0 .. V_fs,   duty from v_wanted = V_fs p_wanted / (p_fs G_n)
//! ```
//!
//! p_fs pressure [Pa, gauge] at the regulator's full input V_fs [V], G gain of the amplifier and G_n the one that the software
//! assumes, v mean voltage of the RC over a step [V]. Source paper, section 3: 0-8 V from a 0-5 V PWM; it states no pressure
//! for 8 V. Leaves out: the clipping of single ripple peaks above full scale, for which the amplifier's gain must be too high.

use super::amplifier::AmplifierParameters;
use super::pwm_filter::{PwmFilterParameters, PwmFilterState};

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetValueParameters {
    /// Pressure that the regulator gives at its full input, gauge [Pa], above 0.
    pub full_scale: f64,
    /// The regulator's full input [V], above 0.
    pub full_voltage: f64,
    /// PWM and RC.
    pub pwm: PwmFilterParameters,
    /// The amplifier behind them.
    pub amplifier: AmplifierParameters,
}

/// The state that changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetValueState {
    filter: PwmFilterState,
}

impl SetValueParameters {
    /// Duty [1] that the software sets for a pressure wanted [Pa gauge].
    pub fn duty(&self, wanted: f64) -> f64 {
        let voltage = self.full_voltage * wanted / self.full_scale;
        self.pwm.duty(voltage / self.amplifier.nominal_gain)
    }

    /// Set pressure that the regulator makes of the RC's voltage [V], gauge [Pa].
    pub fn pressure(&self, filtered: f64) -> f64 {
        let voltage = (self.amplifier.gain() * filtered).clamp(0.0, self.full_voltage);
        self.full_scale * voltage / self.full_voltage
    }

    /// Mean set pressure that the regulator gets at rest for a pressure wanted, both gauge [Pa].
    pub fn at_rest(&self, wanted: f64) -> f64 {
        self.pressure(self.pwm.high_voltage * self.duty(wanted))
    }

    /// Step of the set pressure [Pa].
    pub fn step(&self) -> f64 {
        self.at_rest(self.full_scale) / f64::from((1u32 << self.pwm.bits) - 1)
    }

    /// Ripple of the set pressure at rest, peak to peak [Pa].
    pub fn ripple(&self, wanted: f64) -> f64 {
        self.full_scale / self.full_voltage
            * self.amplifier.gain()
            * self.pwm.ripple(self.duty(wanted))
    }
}

impl SetValueState {
    /// Settled at a pressure wanted [Pa gauge].
    pub fn settled(parameters: &SetValueParameters, wanted: f64) -> Self {
        Self {
            filter: PwmFilterState::settled(&parameters.pwm, parameters.duty(wanted)),
        }
    }

    /// Advances by `dt` [s] with a pressure wanted and returns the mean set pressure that the regulator gets, both gauge [Pa].
    pub fn advance(&mut self, parameters: &SetValueParameters, wanted: f64, dt: f64) -> f64 {
        let duty = parameters.duty(wanted);
        parameters.pressure(self.filter.advance(&parameters.pwm, duty, dt))
    }
}

#[cfg(test)]
mod tests {
    use super::super::parameters::paper_set_value;
    use super::*;

    #[test]
    fn the_papers_pressures_come_through_within_half_a_step() {
        let chain = paper_set_value();
        let step = chain.full_scale / 255.0;
        assert!((chain.step() - step).abs() < 1e-9);
        for wanted in [1.2e5, 1.8e5, 2.1e5, 3.0e5] {
            let held = chain.at_rest(wanted);
            // 1.8 bar lies half way between two duties: 0.65 % off either way.
            assert!((held - wanted).abs() <= 0.5 * step * (1.0 + 1e-9));
            // On the grid of the duty.
            assert!(((held / step).round() - held / step).abs() < 1e-9);
            let mut state = SetValueState::settled(&chain, 0.0);
            state.advance(&chain, wanted, 1000.0 / 490.0);
            let mean = state.advance(&chain, wanted, 10.0 / 490.0);
            assert!((mean / held - 1.0).abs() < 1e-8);
        }
    }

    #[test]
    fn the_amplifiers_gain_error_reaches_the_regulator() {
        let mut chain = paper_set_value();
        let exact = chain.at_rest(1.8e5);
        chain.amplifier.feedback_resistor_error = 0.1;
        let gain = chain.amplifier.gain_error();
        assert!((chain.at_rest(1.8e5) / exact - 1.0 - gain).abs() < 1e-12);
        assert!((gain - 0.0375).abs() < 1e-12);
        // The regulator's input ends at 8 V.
        assert_eq!(chain.at_rest(chain.full_scale), chain.full_scale);
    }

    #[test]
    fn what_lies_outside_the_range_is_kept_within() {
        let chain = paper_set_value();
        assert_eq!(chain.at_rest(-1e5), 0.0);
        assert!((chain.at_rest(9e5) - chain.full_scale).abs() < 1e-9);
    }

    #[test]
    fn ripple_in_pressure_is_that_of_the_voltage_amplified() {
        let chain = paper_set_value();
        let wanted = 0.5 * chain.full_scale;
        let mut state = SetValueState::settled(&chain, wanted);
        let duty = chain.duty(wanted);
        let low = chain.pressure(state.filter.voltage);
        state.advance(&chain, wanted, duty / 490.0);
        let high = chain.pressure(state.filter.voltage);
        assert!((high - low - chain.ripple(wanted)).abs() < 1e-6);
        // Half duty, tau = 49 periods: U T / (4 tau) of 5 V, all of it 1.6 / 8 V of the full scale.
        assert!((chain.ripple(wanted) / (chain.full_scale / 196.0) - 1.0).abs() < 1e-3);
    }
}
