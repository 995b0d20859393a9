//! The sensing chain as the controller meets it: what it commands, and what it reads.
//!
//! ```text
//! readings = sensor(truth at t_k) from t_k on until t_(k+1)
//! ```

use super::filter::Filter;
use super::noise::{Noise, Stream};
use super::parameters::{CommandChain, SensingParameters};
use super::sample_clock::SampleClock;
use super::set_value::SetValueState;

/// True values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Truth {
    /// Contact force along the device's axis, positive when it presses [N].
    pub force: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Acceleration of the device along its axis, without gravity [m/s2].
    pub acceleration: f64,
    /// Regulator's outlet pressure, gauge [Pa].
    pub regulator_pressure: f64,
}

/// Readings of the software.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Readings {
    /// Contact force along the device's axis, filtered [N].
    pub force: f64,
    /// The same before the filter [N].
    pub force_unfiltered: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Acceleration of the device along its axis, without gravity [m/s2].
    pub acceleration: f64,
    /// Regulator's outlet pressure, gauge [Pa].
    pub regulator_pressure: f64,
}

/// The chain and what it remembers.
#[derive(Debug, Clone)]
pub struct SensorChain {
    parameters: SensingParameters,
    set_value: Option<SetValueState>,
    clock: SampleClock,
    filter: Filter,
    force_noise: Noise,
    stroke_noise: Noise,
    acceleration_noise: Noise,
    pressure_noise: Noise,
    held: Readings,
    /// Whether the last call took a sample.
    sampled: bool,
}

impl SensorChain {
    /// At rest without pressure. The parameters must be within what their documentation admits.
    pub fn new(parameters: &SensingParameters, seed: u64) -> Self {
        let mut chain = Self {
            parameters: *parameters,
            set_value: None,
            clock: SampleClock::new(parameters.sample_rate),
            filter: Filter::new(&parameters.force_filter, parameters.sample_period()),
            force_noise: Noise::new(seed, Stream::Force),
            stroke_noise: Noise::new(seed, Stream::Stroke),
            acceleration_noise: Noise::new(seed, Stream::Acceleration),
            pressure_noise: Noise::new(seed, Stream::RegulatorPressure),
            held: Readings::default(),
            sampled: false,
        };
        chain.settle(0.0);
        chain
    }

    /// Puts the command's way at rest at a set pressure [Pa gauge].
    pub fn settle(&mut self, wanted: f64) {
        self.set_value = match &self.parameters.command {
            CommandChain::Ideal => None,
            CommandChain::Real(parameters) => Some(SetValueState::settled(parameters, wanted)),
        };
    }

    /// Set pressure that the regulator gets, mean over a step `dt` [s], for the one that is wanted; both gauge [Pa].
    pub fn command(&mut self, wanted: f64, dt: f64) -> f64 {
        match (&self.parameters.command, &mut self.set_value) {
            (CommandChain::Real(parameters), Some(state)) => state.advance(parameters, wanted, dt),
            _ => wanted,
        }
    }

    /// Takes a sample if one is due at a time [s] and returns what is held then.
    pub fn measure(&mut self, time: f64, truth: &Truth) -> Readings {
        self.sampled = self.clock.is_due(time);
        if self.sampled {
            let parameters = &self.parameters;
            let force_unfiltered = parameters.force.read(truth.force, &mut self.force_noise);
            self.held = Readings {
                force: self.filter.apply(force_unfiltered),
                force_unfiltered,
                stroke: parameters.stroke.read(truth.stroke, &mut self.stroke_noise),
                acceleration: parameters
                    .acceleration
                    .read(truth.acceleration, &mut self.acceleration_noise),
                regulator_pressure: parameters
                    .regulator_pressure
                    .read(truth.regulator_pressure, &mut self.pressure_noise),
            };
        }
        self.held
    }
}

impl SensorChain {
    /// Whether the last call of `measure` took a sample.
    pub fn sampled(&self) -> bool {
        self.sampled
    }
}

#[cfg(test)]
mod tests {
    use super::super::channel::Measurement;
    use super::super::filter::FilterParameters;
    use super::*;

    fn truth(k: u32) -> Truth {
        Truth {
            force: 60.0 + f64::from(k),
            stroke: 0.02 + 1e-5 * f64::from(k),
            acceleration: 0.1 * f64::from(k),
            regulator_pressure: 1e5 + 10.0 * f64::from(k),
        }
    }

    fn run(parameters: &SensingParameters, seed: u64) -> Vec<Readings> {
        let mut chain = SensorChain::new(parameters, seed);
        (0..200)
            .map(|k| chain.measure(f64::from(k) * 1e-3, &truth(k)))
            .collect()
    }

    #[test]
    fn the_ideal_chain_is_the_truth() {
        for (k, readings) in (0..).zip(run(&SensingParameters::default(), 1)) {
            let truth = truth(k);
            assert_eq!(readings.force, truth.force);
            assert_eq!(readings.force_unfiltered, truth.force);
            assert_eq!(readings.stroke, truth.stroke);
            assert_eq!(readings.acceleration, truth.acceleration);
            assert_eq!(readings.regulator_pressure, truth.regulator_pressure);
        }
        let mut chain = SensorChain::new(&SensingParameters::default(), 1);
        assert_eq!(chain.command(1.234e5, 1e-3), 1.234e5);
    }

    #[test]
    fn readings_are_held_between_samples() {
        let parameters = SensingParameters {
            sample_rate: 100.0,
            ..SensingParameters::ideal()
        };
        for (k, readings) in (0..).zip(run(&parameters, 1)) {
            assert_eq!(readings.force, truth(k - k % 10).force);
            assert_eq!(readings.stroke, truth(k - k % 10).stroke);
        }
    }

    #[test]
    fn the_seed_decides_all_and_one_sensor_leaves_the_others_alone() {
        let paper = SensingParameters::paper();
        assert_eq!(run(&paper, 7), run(&paper, 7));
        assert_ne!(run(&paper, 7), run(&paper, 8));
        let mut without = paper;
        without.force = Measurement::Ideal;
        without.regulator_pressure = Measurement::White {
            standard_deviation: 50.0,
        };
        for (all, fewer) in run(&paper, 7).iter().zip(run(&without, 7)) {
            assert_eq!(all.stroke, fewer.stroke);
            assert_eq!(all.acceleration, fewer.acceleration);
        }
    }

    #[test]
    fn white_noise_has_the_sizes_asked_for_in_their_places() {
        let parameters = SensingParameters::white(1.0, 2e-5, 300.0, 0.05, 1000.0);
        let mut chain = SensorChain::new(&parameters, 21);
        let count = 50_000;
        let truth = truth(0);
        let mut squares = [0.0; 4];
        for k in 0..count {
            let readings = chain.measure(f64::from(k) * 1e-3, &truth);
            let errors = [
                readings.force - truth.force,
                readings.stroke - truth.stroke,
                readings.regulator_pressure - truth.regulator_pressure,
                readings.acceleration - truth.acceleration,
            ];
            for (sum, error) in squares.iter_mut().zip(errors) {
                *sum += error * error;
            }
        }
        for (sum, expected) in squares.iter().zip([1.0, 2e-5, 300.0, 0.05]) {
            assert!(((sum / f64::from(count)).sqrt() / expected - 1.0).abs() < 0.016);
        }
    }

    #[test]
    fn no_two_sensors_share_their_noise() {
        let parameters = SensingParameters::white(1.0, 1.0, 1.0, 1.0, 1000.0);
        let readings = SensorChain::new(&parameters, 2).measure(0.0, &Truth::default());
        let mut errors = [
            readings.force,
            readings.stroke,
            readings.acceleration,
            readings.regulator_pressure,
        ];
        errors.sort_by(f64::total_cmp);
        assert!(errors.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn the_filtered_force_lags_by_the_stated_delay() {
        let parameters = SensingParameters {
            sample_rate: 500.0,
            force_filter: FilterParameters::Bessel2 { cutoff: 20.0 },
            ..SensingParameters::ideal()
        };
        let mut chain = SensorChain::new(&parameters, 1);
        let mut lag = f64::NAN;
        for k in 0..1000 {
            let time = f64::from(k) * 1e-3;
            let force = 40.0 * time;
            let ramp = Truth {
                force,
                ..Truth::default()
            };
            let readings = chain.measure(time, &ramp);
            lag = (readings.force_unfiltered - readings.force) / 40.0;
        }
        assert!((lag - parameters.force_delay()).abs() < 1e-12);
        assert!((lag - 0.2167 / 20.0).abs() < 1e-4);
    }

    #[test]
    fn the_papers_chain_reads_too_much_force_and_delays_the_command() {
        let paper = SensingParameters::paper();
        let mut chain = SensorChain::new(&paper, 3);
        let mean = (0..20_000)
            .map(|k| chain.measure(f64::from(k) * 0.01, &truth(40)).force)
            .sum::<f64>()
            / 20_000.0;
        assert!((mean / 100.0 - 1.208).abs() < 1e-3);
        // RC of 0.1 s: 1 - 1/e of the step after 0.1 s.
        let held = (0..100).fold(0.0, |_, _| chain.command(1.8e5, 1e-3));
        assert!((held / 1.8e5 - 0.632).abs() < 0.02);
        chain.settle(1.8e5);
        assert!((chain.command(1.8e5, 1e-3) / 1.8e5 - 1.0).abs() < 0.02);
    }
}
