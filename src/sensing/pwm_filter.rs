//! Pulse width modulation into a first-order RC, solved exactly over its on and off phases.
//!
//! ```text
//! tau dv/dt = u(t) - v,   u = U while high, for d T of each period T, then 0,   tau = R C
//! settled:  mean v = d U,   ripple = U (1 - e^(-d T/tau)) (1 - e^(-(1-d) T/tau)) / (1 - e^(-T/tau))
//! ```
//!
//! v capacitor's voltage [V], U high level [V], d duty [1], T period [s]; the ripple is peak to peak.
//! A new duty counts from the start of the next period, as the ATmega2560's timer buffers it (data sheet, "Phase Correct PWM
//! Mode"); the pulse stands at the period's start and not in its middle, which shifts the ripple and changes neither mean nor size.
//! Leaves out: the load on the capacitor, the output's resistance.

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PwmFilterParameters {
    /// High level [V], above 0.
    pub high_voltage: f64,
    /// Bits of the duty, 1 to 16; all ones is always high.
    pub bits: u32,
    /// Pulses per second [Hz], above 0.
    pub frequency: f64,
    /// Resistor [ohm], above 0.
    pub resistance: f64,
    /// Capacitor [F], above 0.
    pub capacitance: f64,
}

/// The state that changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PwmFilterState {
    /// Voltage of the capacitor [V].
    pub voltage: f64,
    /// Duty of the running period [1].
    duty: f64,
    /// Time since the period's start [s].
    phase: f64,
}

impl PwmFilterParameters {
    /// Time constant of the RC [s].
    pub fn time_constant(&self) -> f64 {
        self.resistance * self.capacitance
    }

    /// Period of the pulses [s].
    pub fn period(&self) -> f64 {
        1.0 / self.frequency
    }

    /// Duty [1] with the mean nearest to a voltage [V], in the steps that the bits give.
    pub fn duty(&self, voltage: f64) -> f64 {
        let highest = f64::from((1u32 << self.bits) - 1);
        (voltage / self.high_voltage * highest)
            .round()
            .clamp(0.0, highest)
            / highest
    }

    /// Settled ripple at a duty [1], peak to peak [V].
    pub fn ripple(&self, duty: f64) -> f64 {
        self.high_voltage * self.charged(duty) * (self.charged(1.0 - duty) / self.charged(1.0))
    }

    /// Share of the way to its source that the capacitor goes in a share of the period, 1 - e^(-share T/tau) [1].
    fn charged(&self, share: f64) -> f64 {
        // Within what is a number: beyond, 0 times infinity and 0 over 0 would not be.
        let periods = (self.period() / self.time_constant()).clamp(f64::MIN_POSITIVE, f64::MAX);
        -(-share * periods).exp_m1()
    }

    /// Settled voltage at the start of a pulse [V], the lowest of a period.
    fn trough(&self, duty: f64) -> f64 {
        let off = 1.0 - self.charged(1.0 - duty);
        self.high_voltage * self.charged(duty) * off / self.charged(1.0)
    }
}

impl PwmFilterState {
    /// Settled at a duty [1], at the start of a period.
    pub fn settled(parameters: &PwmFilterParameters, duty: f64) -> Self {
        Self {
            voltage: parameters.trough(duty),
            duty,
            phase: 0.0,
        }
    }

    /// Advances by `dt` [s] with a duty [1] wanted and returns the mean voltage over it [V].
    pub fn advance(&mut self, parameters: &PwmFilterParameters, duty: f64, dt: f64) -> f64 {
        let period = parameters.period();
        let mut remaining = dt;
        let mut integral = 0.0;
        while remaining > 0.0 {
            if self.phase == 0.0 {
                self.duty = duty;
            }
            let fall = self.duty * period;
            let (source, end) = if self.phase < fall {
                (parameters.high_voltage, fall)
            } else {
                (0.0, period)
            };
            let span = end - self.phase;
            if remaining < span {
                integral += self.relax(parameters, source, remaining);
                self.phase += remaining;
                break;
            }
            integral += self.relax(parameters, source, span);
            remaining -= span;
            self.phase = end;
            if end == period {
                self.phase = 0.0;
            }
        }
        if dt > 0.0 {
            integral / dt
        } else {
            self.voltage
        }
    }

    /// Relaxes towards a source [V] for a time [s] and returns the integral of the voltage [V s].
    fn relax(&mut self, parameters: &PwmFilterParameters, source: f64, time: f64) -> f64 {
        let time_constant = parameters.time_constant();
        let change = (source - self.voltage) * -(-time / time_constant).exp_m1();
        self.voltage += change;
        // Integral of tau dv/dt = u - v.
        source * time - time_constant * change
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PWM: PwmFilterParameters = PwmFilterParameters {
        high_voltage: 5.0,
        bits: 8,
        frequency: 490.0,
        resistance: 10e3,
        capacitance: 1e-6,
    };

    #[test]
    fn mean_and_ripple_settle_at_the_closed_form() {
        let (period, tau) = (1.0 / 490.0, 0.01);
        for count in [1u32, 40, 128, 254] {
            let duty = f64::from(count) / 255.0;
            let mut state = PwmFilterState::settled(&PWM, 0.0);
            // Forty time constants: what is left of the start is 4e-18.
            for _ in 0..196 {
                state.advance(&PWM, duty, period);
            }
            let low = state.voltage;
            let up = state.advance(&PWM, duty, duty * period);
            let high = state.voltage;
            let down = state.advance(&PWM, duty, (1.0 - duty) * period);
            let mean = duty * up + (1.0 - duty) * down;
            assert!((mean - 5.0 * duty).abs() < 1e-12);
            let decay = |share: f64| (-share * period / tau).exp();
            let ripple = 5.0 * (1.0 - decay(duty)) * (1.0 - decay(1.0 - duty)) / (1.0 - decay(1.0));
            assert!((high - low - ripple).abs() < 1e-12);
            assert!((PWM.ripple(duty) - ripple).abs() < 1e-12);
            assert!((PwmFilterState::settled(&PWM, duty).voltage - low).abs() < 1e-12);
        }
    }

    #[test]
    fn the_ends_of_the_range_have_no_ripple() {
        for (duty, voltage) in [(0.0, 0.0), (1.0, 5.0)] {
            let mut state = PwmFilterState::settled(&PWM, duty);
            assert!((state.advance(&PWM, duty, 0.0313) - voltage).abs() < 1e-13);
            assert!((state.voltage - voltage).abs() < 1e-13);
            assert_eq!(PWM.ripple(duty), 0.0);
        }
    }

    #[test]
    fn a_ratio_far_from_1_has_its_limit() {
        // From periods of 1e-300 time constants to 1e300, and beyond what a number can be.
        for (frequency, capacitance, ripple) in [
            (1e-290, 1e-10, 5.0),
            (1e-4, 1e-10, 5.0),
            (1e-300, 1e-320, 5.0),
            // d (1 - d) T/tau.
            (1e6, 1.0, 5.0 * 0.24 * 1e-10),
            (1e290, 1e10, 5.0 * 0.24 * 1e-304),
            (1e300, 1e300, 0.0),
        ] {
            let pwm = PwmFilterParameters {
                frequency,
                capacitance,
                ..PWM
            };
            let off = (pwm.ripple(0.4) - ripple).abs();
            assert!(
                off <= 1e-9 * ripple + 1e-306,
                "{frequency} {capacitance}: {off}"
            );
            let low = PwmFilterState::settled(&pwm, 0.4).voltage;
            let expected = if ripple > 1.0 { 0.0 } else { 2.0 };
            assert!((low - expected).abs() < 1e-9, "{frequency}: {low}");
            assert_eq!((pwm.ripple(0.0), pwm.ripple(1.0)), (0.0, 0.0));
        }
    }

    #[test]
    fn the_step_does_not_matter() {
        let mut coarse = PwmFilterState::settled(&PWM, 0.2);
        let coarse_mean = coarse.advance(&PWM, 0.7, 0.0371);
        let mut fine = PwmFilterState::settled(&PWM, 0.2);
        let steps = 371;
        let fine_mean = (0..steps)
            .map(|_| fine.advance(&PWM, 0.7, 1e-4))
            .sum::<f64>()
            / f64::from(steps);
        assert!((coarse.voltage - fine.voltage).abs() < 1e-12);
        assert!((coarse_mean - fine_mean).abs() < 1e-12);
    }

    #[test]
    fn a_step_follows_the_exponential_of_the_mean_within_the_ripple() {
        let mut state = PwmFilterState::settled(&PWM, 0.0);
        for k in 1..=50 {
            state.advance(&PWM, 0.4, 1e-3);
            let averaged = 2.0 * (1.0 - (-0.1 * f64::from(k)).exp());
            assert!((state.voltage - averaged).abs() < PWM.ripple(0.4));
        }
    }

    #[test]
    fn a_new_duty_waits_for_the_next_period() {
        let period = PWM.period();
        let mut changed = PwmFilterState::settled(&PWM, 0.5);
        let mut kept = changed;
        changed.advance(&PWM, 0.5, 0.1 * period);
        changed.advance(&PWM, 1.0, 0.9 * period);
        kept.advance(&PWM, 0.5, period);
        assert!((changed.voltage - kept.voltage).abs() < 1e-13);
        changed.advance(&PWM, 1.0, 0.9 * period);
        kept.advance(&PWM, 0.5, 0.9 * period);
        assert!(changed.voltage > kept.voltage + 0.1);
    }

    #[test]
    fn duty_has_255_steps() {
        assert_eq!(PWM.duty(5.0), 1.0);
        assert_eq!(PWM.duty(9.0), 1.0);
        assert_eq!(PWM.duty(-1.0), 0.0);
        assert_eq!(PWM.duty(5.0 * 100.4 / 255.0), 100.0 / 255.0);
        assert_eq!(PWM.duty(5.0 * 100.6 / 255.0), 101.0 / 255.0);
    }
}
