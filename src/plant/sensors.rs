//! Errors of a rig's sensors, before their noise.
//!
//! ```text
//! force:   F_m = clip( g L(F + m_x a) + b + d t ),   at the time of its stamp less a delay;   L: 1/(T s + 1)
//! stroke:  x_m = g_x x
//! outlet:  p_m = p + b_p + d_p t
//! ```
//!
//! F contact force [N], a acceleration along extension [m/s2], m_x mass beyond the load cell [kg], g gains [1], b bias [N], d drift [N/s],
//! T time constant [s], b_p offset [Pa] and d_p drift [Pa/s] of the pressure sensor.

/// Errors of the sensors; the ideal ones change nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorErrors {
    /// Gain of the load cell and its amplifier [1].
    pub force_gain: f64,
    /// Its reading at no force at the start of a recording [N].
    pub force_bias: f64,
    /// Drift of that [N/s].
    pub force_drift: f64,
    /// Time constant of its low-pass filter [s].
    pub force_lag: f64,
    /// Reading at which it clips [N].
    pub force_limit: f64,
    /// Delay of its stamp [s].
    pub force_delay: f64,
    /// Mass beyond the load cell [kg].
    pub crosstalk_mass: f64,
    /// Gain of the position sensor [1].
    pub stroke_gain: f64,
    /// Reading of the pressure sensor at the atmosphere at the start of a recording [Pa].
    pub pressure_offset: f64,
    /// Drift of that [Pa/s].
    pub pressure_drift: f64,
}

impl SensorErrors {
    /// No error.
    pub const NONE: Self = Self {
        force_gain: 1.0,
        force_bias: 0.0,
        force_drift: 0.0,
        force_lag: 0.0,
        force_limit: f64::INFINITY,
        force_delay: 0.0,
        crosstalk_mass: 0.0,
        stroke_gain: 1.0,
        pressure_offset: 0.0,
        pressure_drift: 0.0,
    };

    /// Whether the load cell reads what was before its sample, or after it.
    pub fn is_late(&self) -> bool {
        self.force_lag > 0.0 || self.force_delay != 0.0
    }

    /// Readings of the pressure sensor [Pa gauge] at increasing times [s], from the outlet [Pa gauge] there.
    pub fn pressure_readings(&self, time: &[f64], outlet: &[f64]) -> Vec<f64> {
        if self.pressure_offset == 0.0 && self.pressure_drift == 0.0 {
            return outlet.to_vec();
        }
        let readings = time.iter().zip(outlet);
        readings
            .map(|(t, p)| p + self.pressure_offset + self.pressure_drift * (t - time[0]))
            .collect()
    }

    /// Readings of the load cell [N] at increasing times [s], from the contact force [N] and the acceleration along extension [m/s2] there.
    pub fn force_readings(&self, time: &[f64], force: &[f64], acceleration: &[f64]) -> Vec<f64> {
        let mut signal: Vec<f64> = force
            .iter()
            .zip(acceleration)
            .map(|(force, acceleration)| force + self.crosstalk_mass * acceleration)
            .collect();
        if self.force_lag > 0.0 {
            low_pass(time, &mut signal, self.force_lag);
        }
        if self.force_delay != 0.0 {
            signal = delayed(time, &signal, self.force_delay);
        }
        for (value, time) in signal.iter_mut().zip(time) {
            *value = self.converted(*value, *time);
        }
        signal
    }

    /// The filtered signal [N] with gain, zero and limit.
    pub(super) fn converted(&self, signal: f64, time: f64) -> f64 {
        let reading = self.force_gain * signal + self.force_bias + self.force_drift * time;
        reading.clamp(-self.force_limit, self.force_limit)
    }
}

/// First-order low-pass filter, exact for an input that is linear between samples.
fn low_pass(time: &[f64], signal: &mut [f64], time_constant: f64) {
    let mut state = signal[0];
    let mut before = signal[0];
    for i in 1..signal.len() {
        let step = (time[i] - time[i - 1]) / time_constant;
        let decay = (-step).exp();
        let held = -(-step).exp_m1() / step;
        let input = signal[i];
        state = decay * state + (held - decay) * before + (1.0 - held) * input;
        before = input;
        signal[i] = state;
    }
}

/// The signal as it was a delay [s] ago, linear between samples.
fn delayed(time: &[f64], signal: &[f64], delay: f64) -> Vec<f64> {
    let last = time.len() - 1;
    let mut at = 0;
    time.iter()
        .map(|now| {
            let then = now - delay;
            if then <= time[0] {
                return signal[0];
            }
            if then >= time[last] {
                return signal[last];
            }
            while time[at + 1] < then {
                at += 1;
            }
            while time[at] > then {
                at -= 1;
            }
            let share = (then - time[at]) / (time[at + 1] - time[at]);
            signal[at] + share * (signal[at + 1] - signal[at])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..500).map(|i| f64::from(i) * 2e-3).collect();
        let signal = time.iter().map(|t| 3.0 + 50.0 * t).collect();
        (time, signal)
    }

    #[test]
    fn ideal_sensors_change_nothing() {
        let (time, signal) = ramp();
        assert_eq!(
            SensorErrors::NONE.force_readings(&time, &signal, &signal),
            signal
        );
    }

    #[test]
    fn a_ramp_through_a_lag_trails_by_its_time_constant_and_through_a_delay_by_the_delay() {
        let (time, signal) = ramp();
        for errors in [
            SensorErrors {
                force_lag: 0.03,
                ..SensorErrors::NONE
            },
            SensorErrors {
                force_delay: 0.03,
                ..SensorErrors::NONE
            },
        ] {
            let read = errors.force_readings(&time, &signal, &signal);
            let last = signal.len() - 1;
            assert!((signal[last] - read[last] - 50.0 * 0.03).abs() < 1e-9);
        }
    }

    #[test]
    fn gain_bias_drift_crosstalk_and_clipping_add_up() {
        let errors = SensorErrors {
            force_gain: 1.1,
            force_bias: 2.0,
            force_drift: 0.5,
            force_limit: 60.0,
            crosstalk_mass: 0.3,
            ..SensorErrors::NONE
        };
        let read = errors.force_readings(&[0.0, 2.0], &[10.0, 50.0], &[5.0, 20.0]);
        assert!((read[0] - (1.1 * 11.5 + 2.0)).abs() < 1e-12);
        assert_eq!(read[1], 60.0);
    }
}
