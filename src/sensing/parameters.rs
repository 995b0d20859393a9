//! Parameters of the whole sensing chain, and the ones that are ready made.
//!
//! ```text
//! paper() states what section 3 of the source paper states; what it does not is judged, and said so below
//! ```
//!
//! Judged: 6 bar at the regulator's 8 V and at its sensor's 6.25 V; 10 kohm and 10 uF of the RC (0.1 s: a ripple of 0.5 % of
//! full scale, for the price of a lag of two thirds of the regulator's); the amplifier; 490 Hz, the Arduino's own; an INA125P that
//! swings over the ADC's range; 1 N of noise at the load cell; all of stroke and acceleration but that they are measured
//! (50 mm on 10 bits; 3 g at 300 mV/g on the 10 bits of 5 V); 100 samples a second.

use super::accelerometer::AccelerometerParameters;
use super::adc::AdcParameters;
use super::amplifier::AmplifierParameters;
use super::channel::Measurement;
use super::filter::FilterParameters;
use super::instrumentation_amplifier::InstrumentationAmplifierParameters;
use super::load_cell::LoadCellParameters;
use super::outlet_pressure::OutletPressureParameters;
use super::position::PositionSensorParameters;
use super::pwm_filter::PwmFilterParameters;
use super::set_value::SetValueParameters;

/// Standard gravity [m/s2], with which a capacity in kg is a force.
const STANDARD_GRAVITY: f64 = 9.80665;

/// Way of the set pressure to the regulator.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum CommandChain {
    /// As it is wanted.
    #[default]
    Ideal,
    /// Through PWM, RC and amplifier.
    Real(SetValueParameters),
}

/// Constant parameters during a run. The default is ideal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensingParameters {
    /// From the controller to the regulator.
    pub command: CommandChain,
    /// The regulator's outlet pressure.
    pub regulator_pressure: Measurement<OutletPressureParameters>,
    /// The contact force along the device's axis.
    pub force: Measurement<LoadCellParameters>,
    /// The stroke.
    pub stroke: Measurement<PositionSensorParameters>,
    /// The device's acceleration along its axis, without gravity.
    pub acceleration: Measurement<AccelerometerParameters>,
    /// Samples per second of every sensor [Hz], above 0 and at most one a step; infinite: at every call, only without a filter.
    pub sample_rate: f64,
    /// Treatment of the force's noise.
    pub force_filter: FilterParameters,
}

impl Default for SensingParameters {
    fn default() -> Self {
        Self::ideal()
    }
}

impl SensingParameters {
    /// The truth at every call.
    pub fn ideal() -> Self {
        Self {
            command: CommandChain::Ideal,
            regulator_pressure: Measurement::Ideal,
            force: Measurement::Ideal,
            stroke: Measurement::Ideal,
            acceleration: Measurement::Ideal,
            sample_rate: f64::INFINITY,
            force_filter: FilterParameters::None,
        }
    }

    /// White noise of these standard deviations on the truth, [N], [m], [Pa], [m/s2], sampled at a rate [Hz].
    pub fn white(force: f64, stroke: f64, pressure: f64, acceleration: f64, rate: f64) -> Self {
        Self {
            force: Measurement::White {
                standard_deviation: force,
            },
            stroke: Measurement::White {
                standard_deviation: stroke,
            },
            regulator_pressure: Measurement::White {
                standard_deviation: pressure,
            },
            acceleration: Measurement::White {
                standard_deviation: acceleration,
            },
            sample_rate: rate,
            ..Self::ideal()
        }
    }

    /// The source paper's whole chain, the force untreated as it was there.
    pub fn paper() -> Self {
        Self {
            command: CommandChain::Real(paper_set_value()),
            regulator_pressure: Measurement::Real(paper_outlet_pressure()),
            force: Measurement::Real(paper_load_cell()),
            stroke: Measurement::Real(paper_position()),
            acceleration: Measurement::Real(paper_accelerometer()),
            sample_rate: 100.0,
            force_filter: FilterParameters::None,
        }
    }

    /// Time between samples [s]; 0 for an infinite rate.
    pub fn sample_period(&self) -> f64 {
        1.0 / self.sample_rate
    }

    /// Delay of the force by its filter [s].
    pub fn force_delay(&self) -> f64 {
        self.force_filter.delay(self.sample_period())
    }
}

/// Pressure of the regulator at full scale, gauge [Pa]; judged.
const FULL_SCALE: f64 = 6e5;

/// The source paper's way of the set value.
pub fn paper_set_value() -> SetValueParameters {
    SetValueParameters {
        full_scale: FULL_SCALE,
        full_voltage: 8.0,
        pwm: PwmFilterParameters {
            high_voltage: 5.0,
            bits: 8,
            frequency: 490.0,
            resistance: 10e3,
            capacitance: 10e-6,
        },
        amplifier: AmplifierParameters::exact(1.6),
    }
}

/// The source paper's way of the actual value.
pub fn paper_outlet_pressure() -> OutletPressureParameters {
    OutletPressureParameters {
        full_scale: FULL_SCALE,
        zero_voltage: 1.25,
        full_voltage: 6.25,
        scale_error: 0.0,
        converter_gain: 0.8,
        assumed_converter_gain: 0.8,
        noise: 0.0,
        adc: AdcParameters::ARDUINO,
    }
}

/// The source paper's load cell: 100 ohm fitted, 121 ohm assumed.
pub fn paper_load_cell() -> LoadCellParameters {
    LoadCellParameters {
        capacity: 50.0 * STANDARD_GRAVITY,
        rated_output: 2e-3,
        excitation: 5.0,
        zero_offset: 0.0,
        noise: 1.0,
        amplifier: InstrumentationAmplifierParameters {
            gain_resistor: 100.0,
            reference_voltage: 0.0,
            lowest_output: 0.0,
            highest_output: 5.0,
        },
        assumed_gain_resistor: 121.0,
        adc: AdcParameters::ARDUINO,
    }
}

/// A position sensor such as the source paper could have used.
pub fn paper_position() -> PositionSensorParameters {
    PositionSensorParameters {
        gain: 1.0,
        offset: 0.0,
        noise: 2e-5,
        resolution: 0.050 / 1024.0,
    }
}

/// An accelerometer such as the source paper could have used.
pub fn paper_accelerometer() -> AccelerometerParameters {
    AccelerometerParameters {
        bias: 0.0,
        noise: 0.02,
        range: 3.0 * STANDARD_GRAVITY,
        resolution: 5.0 / 1024.0 / 0.300 * STANDARD_GRAVITY,
    }
}
