//! The errors of sensors while a simulation goes on: the same as over a recording (`sensors`), sample by sample.

use std::collections::VecDeque;

use super::sensors::SensorErrors;

/// Readings of the sensors at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorReadings {
    /// Load cell [N].
    pub force: f64,
    /// Position sensor [m].
    pub stroke: f64,
    /// Pressure sensor [Pa gauge].
    pub regulator_pressure: f64,
}

impl SensorReadings {
    /// Adds to pressure, stroke and force.
    pub fn add(&mut self, [pressure, stroke, force]: [f64; 3]) {
        self.regulator_pressure += pressure;
        self.stroke += stroke;
        self.force += force;
    }
}

/// Sensors that have errors, in a simulation that goes on.
#[derive(Debug, Clone)]
pub struct RunningSensors {
    errors: SensorErrors,
    /// Time [s], output and input [N] of the load cell's filter at the last sample.
    filter: Option<[f64; 3]>,
    /// Times [s] and signals [N] that a late load cell has not shown yet.
    waiting: VecDeque<(f64, f64)>,
}

impl RunningSensors {
    /// Sensors with errors. A load cell that is stamped early reads as if it were in time: nothing foresees.
    pub fn new(errors: SensorErrors) -> Self {
        Self {
            errors,
            filter: None,
            waiting: VecDeque::new(),
        }
    }

    /// Gives the sensors other errors from now on.
    pub fn set_errors(&mut self, errors: SensorErrors) {
        self.errors = errors;
    }

    /// Readings at a time [s], later than the last, from what is then; acceleration along extension [m/s2].
    pub fn read(&mut self, time: f64, truth: &SensorReadings, acceleration: f64) -> SensorReadings {
        let errors = self.errors;
        let mut signal = truth.force + errors.crosstalk_mass * acceleration;
        if errors.force_lag > 0.0 {
            signal = self.filtered(time, signal);
        }
        if errors.force_delay > 0.0 {
            signal = self.late(time, signal);
        }
        SensorReadings {
            force: errors.converted(signal, time),
            stroke: errors.stroke_gain * truth.stroke,
            regulator_pressure: truth.regulator_pressure
                + errors.pressure_offset
                + errors.pressure_drift * time,
        }
    }

    /// First-order low-pass filter, exact for an input that is linear between samples.
    fn filtered(&mut self, time: f64, signal: f64) -> f64 {
        let output = match self.filter {
            None => signal,
            Some([before, output, input]) => {
                let step = (time - before) / self.errors.force_lag;
                let decay = (-step).exp();
                let held = -(-step).exp_m1() / step;
                decay * output + (held - decay) * input + (1.0 - held) * signal
            }
        };
        self.filter = Some([time, output, signal]);
        output
    }

    /// The signal as it was a delay ago, linear between samples.
    fn late(&mut self, time: f64, signal: f64) -> f64 {
        self.waiting.push_back((time, signal));
        let then = time - self.errors.force_delay;
        while self.waiting.len() > 2 && self.waiting[1].0 <= then {
            self.waiting.pop_front();
        }
        match (self.waiting.front(), self.waiting.get(1)) {
            (Some(&(from, first)), Some(&(to, second))) if then > from => {
                first + (then - from) / (to - from) * (second - first)
            }
            (Some(&(_, first)), _) => first,
            (None, _) => signal,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_running_sensor_reads_as_one_over_a_recording() {
        let errors = SensorErrors {
            force_gain: 1.03,
            force_bias: 2.0,
            force_drift: -0.5,
            force_lag: 0.02,
            force_limit: 90.0,
            force_delay: 0.0135,
            crosstalk_mass: 0.4,
            stroke_gain: 0.99,
            pressure_offset: 300.0,
            pressure_drift: 20.0,
        };
        let time: Vec<f64> = (0..400).map(|i| 1e-3 * f64::from(i)).collect();
        let force: Vec<f64> = time.iter().map(|t| 80.0 * (9.0 * t).sin()).collect();
        let acceleration: Vec<f64> = time.iter().map(|t| 3.0 * (40.0 * t).cos()).collect();
        let expected = errors.force_readings(&time, &force, &acceleration);
        let pressures = errors.pressure_readings(&time, &vec![1e5; time.len()]);
        let mut running = RunningSensors::new(errors);
        for i in 0..time.len() {
            let truth = SensorReadings {
                force: force[i],
                stroke: 0.02,
                regulator_pressure: 1e5,
            };
            let read = running.read(time[i], &truth, acceleration[i]);
            assert!((read.force - expected[i]).abs() < 1e-9, "{i}");
            assert!((read.regulator_pressure - pressures[i]).abs() < 1e-9);
            assert_eq!(read.stroke, 0.99 * 0.02);
        }
    }
}
