//! The keys of `[sensing]`, the same in a scenario of either kind.

use serde::Deserialize;

use super::stages::white;
use crate::keys::declaration::{Plain, keys};
use crate::sensing::AdcParameters;
use crate::sensing::parameters::{
    paper_accelerometer, paper_load_cell, paper_outlet_pressure, paper_position, paper_set_value,
};

impl Plain for Preset {}
impl Plain for CommandChainKind {}
impl Plain for SensorKind {}
impl Plain for FilterKind {}

keys! {
    /// `[sensing]`.
    pub(in crate::scenario) struct SensingKeys {
        /// all ideal; all real; every sensor white and the command ideal
        preset: Preset = "preset", or "ideal";
        /// samples a second of every sensor, at most one a step, held in between; when left out, 100 with `preset = "paper"`, else one at every step. Needed with a
        /// filter
        sample_rate: Option<f64> = "sample_rate_hz" in 0.1..=1e5;
        command: CommandChainKeys = "command";
        regulator_pressure: RegulatorPressureKeys = "regulator_pressure";
        force: ForceKeys = "force";
        stroke: StrokeKeys = "stroke";
        acceleration: AccelerationKeys = "acceleration";
        adc: AdcKeys = "adc";
        filter: Option<FilterKeys> = "filter";
    }

    /// `[sensing.command]`.
    pub(in crate::scenario) struct CommandChainKeys {
        /// the preset's when left out, ideal without one
        kind: Option<CommandChainKind> = "kind", shown "\"ideal\"";
        /// pressure that the regulator gives at its full input
        full_scale: f64 = "full_scale_bar_gauge" for "real" in 0.1..=16.0, from paper_set_value().full_scale;
        /// the regulator's full input
        full_input: f64 = "full_input_v" for "real" in 0.1..=50.0, from paper_set_value().full_voltage;
        /// high level of the PWM
        pwm_high: f64 = "pwm_high_v" for "real" in 0.1..=50.0, from paper_set_value().pwm.high_voltage;
        /// bits of the duty
        pwm_bits: u32 = "pwm_bits" for "real" in 1..=16, or paper_set_value().pwm.bits;
        /// pulses a second
        pwm_frequency: f64 = "pwm_frequency_hz" for "real" in 1.0..=1e5, from paper_set_value().pwm.frequency;
        /// resistor of the RC
        resistance: f64 = "resistance_ohm" for "real" in 10.0..=1e7, from paper_set_value().pwm.resistance;
        /// capacitor of the RC
        capacitance: f64 = "capacitance_uf" for "real" in 0.001..=1e4, from paper_set_value().pwm.capacitance;
        /// gain that the resistors are meant to give, and that the software assumes
        amplifier_gain: f64 = "amplifier_gain" for "real" in 1.01..=100.0, from paper_set_value().amplifier.nominal_gain;
        /// relative error of the amplifier's feedback resistor
        feedback_resistor_error: f64 = "feedback_resistor_error" for "real" in -0.5..=0.5, from paper_set_value().amplifier.feedback_resistor_error;
        /// relative error of its resistor to ground
        ground_resistor_error: f64 = "ground_resistor_error" for "real" in -0.5..=0.5, from paper_set_value().amplifier.ground_resistor_error;
    }

    /// `[sensing.regulator_pressure]`.
    pub(in crate::scenario) struct RegulatorPressureKeys {
        /// the preset's when left out, ideal without one
        kind: Option<SensorKind> = "kind", shown "\"ideal\"";
        /// of the noise; 0 when *real*, which the ADC rounds
        standard_deviation: Option<f64> = "standard_deviation_pa" for "white" | "real" in 0.0..=1e6, shown "600";
        /// pressure at the sensor's full voltage
        full_scale: f64 = "full_scale_bar_gauge" for "real" in 0.1..=16.0, from paper_outlet_pressure().full_scale;
        /// the sensor's voltage without pressure
        zero: f64 = "zero_v" for "real" in 0..=50, from paper_outlet_pressure().zero_voltage;
        /// the sensor's voltage at full scale, more than `zero_v`
        full: f64 = "full_v" for "real" in 0.1..=50.0, from paper_outlet_pressure().full_voltage;
        /// relative error of the sensor's scale
        scale_error: f64 = "scale_error" for "real" in -0.5..=0.5, from paper_outlet_pressure().scale_error;
        /// gain of the converter
        converter_gain: f64 = "converter_gain" for "real" in 0.01..=100.0, from paper_outlet_pressure().converter_gain;
        /// gain that the software assumes
        assumed_converter_gain: f64 = "assumed_converter_gain" for "real" in 0.01..=100.0, from paper_outlet_pressure().assumed_converter_gain;
    }

    /// `[sensing.force]`.
    pub(in crate::scenario) struct ForceKeys {
        /// the preset's when left out, ideal without one
        kind: Option<SensorKind> = "kind", shown "\"ideal\"";
        /// of the noise; of a real one before the amplifier
        standard_deviation: f64 = "standard_deviation_n" for "white" | "real" in 0..=1000, from white::FORCE;
        /// capacity, as the weight of a mass
        capacity: f64 = "capacity_kg" for "real" in 0.1..=1e4, from paper_load_cell().capacity / STANDARD_GRAVITY;
        /// bridge voltage at capacity over excitation
        rated_output: f64 = "rated_output_mv_per_v" for "real" in 0.1..=100.0, from paper_load_cell().rated_output;
        /// excitation
        excitation: f64 = "excitation_v" for "real" in 0.1..=50.0, from paper_load_cell().excitation;
        /// zero offset of the bridge, as a force
        zero_offset: f64 = "zero_offset_n" for "real" in -1000..=1000, from paper_load_cell().zero_offset;
        /// gain resistor that is fitted; the amplifier's gain is 4 + 60 kohm over it
        gain_resistor: f64 = "gain_resistor_ohm" for "real" in 6.0..=1e6, from paper_load_cell().amplifier.gain_resistor;
        /// gain resistor that the software assumes
        assumed_gain_resistor: f64 = "assumed_gain_resistor_ohm" for "real" in 6.0..=1e6, from paper_load_cell().assumed_gain_resistor;
        /// the amplifier's output without load, within its outputs
        reference: f64 = "reference_v" for "real" in -50..=50, from paper_load_cell().amplifier.reference_voltage;
        /// the amplifier's lowest output
        lowest_output: f64 = "lowest_output_v" for "real" in -50..=50, from paper_load_cell().amplifier.lowest_output;
        /// the amplifier's highest output, more than the lowest
        highest_output: f64 = "highest_output_v" for "real" in -50..=50, from paper_load_cell().amplifier.highest_output;
    }

    /// `[sensing.stroke]`.
    pub(in crate::scenario) struct StrokeKeys {
        /// the preset's when left out, ideal without one
        kind: Option<SensorKind> = "kind", shown "\"ideal\"";
        /// of the noise
        standard_deviation: f64 = "standard_deviation_mm" for "white" | "real" in 0..=10, from white::STROKE;
        /// reading over stroke
        gain: f64 = "gain" for "real" in 0.5..=1.5, from paper_position().gain;
        /// reading at no stroke
        offset: f64 = "offset_mm" for "real" in -50..=50, from paper_position().offset;
        /// step of the reading, 50 mm on 10 bits; 0 does not round
        resolution: f64 = "resolution_mm" for "real" in 0..=10, from paper_position().resolution;
    }

    /// `[sensing.acceleration]`.
    pub(in crate::scenario) struct AccelerationKeys {
        /// the preset's when left out, ideal without one
        kind: Option<SensorKind> = "kind", shown "\"ideal\"";
        /// of the noise; 0.02 when *real*
        standard_deviation: Option<f64> = "standard_deviation_m_per_s2" for "white" | "real" in 0..=1000, shown "0.25";
        /// bias
        bias: f64 = "bias_m_per_s2" for "real" in -100..=100, from paper_accelerometer().bias;
        /// largest reading to either side, 3 g
        range: f64 = "range_m_per_s2" for "real" in 0.1..=1e5, from paper_accelerometer().range;
        /// step of the reading, 0.1596 m/s2; 0 does not round
        resolution: f64 = "resolution_m_per_s2" for "real" in 0..=100, from paper_accelerometer().resolution, shown "10 bits of 5 V at 300 mV/g";
    }

    /// `[sensing.adc]`, which reads regulator pressure and force.
    pub(in crate::scenario) struct AdcKeys {
        /// bits
        bits: u32 = "bits" in 1..=24, or AdcParameters::ARDUINO.bits;
        /// reference voltage, one step above the highest reading
        reference: f64 = "reference_v" in 0.1..=50.0, from AdcParameters::ARDUINO.reference;
        /// standard deviation of its own noise, in steps
        noise: f64 = "noise_steps" in 0..=1000, from AdcParameters::ARDUINO.noise;
    }

    /// `[sensing.filter]`: `kind` says which of the other keys there is.
    pub(in crate::scenario) struct FilterKeys {
        /// which of the keys below there is
        kind: FilterKind = "kind";
        /// time constant of the lag
        time_constant: Option<f64> = "time_constant_ms" for "first_order" in 0.1..=10_000.0;
        /// frequency at which the second-order filter passes 1/sqrt(2), below half the sample rate
        cutoff: Option<f64> = "cutoff_hz" for "bessel" in 0.001..=50_000.0;
        /// number of samples, odd
        length: Option<usize> = "length" for "median" in 1..=99;
    }
}

/// Standard gravity [m/s2], with which a capacity in kg is a force.
pub(super) const STANDARD_GRAVITY: f64 = 9.80665;

/// Kind of the stages that do not say it themselves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum Preset {
    /// The truth everywhere.
    #[default]
    Ideal,
    /// The source paper's chain.
    Paper,
    /// White noise on every sensor, the command ideal.
    White,
}

/// Kind of the command's way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum CommandChainKind {
    /// As it is wanted.
    Ideal,
    /// PWM, RC and amplifier.
    Real,
}

/// Kind of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum SensorKind {
    /// The truth.
    Ideal,
    /// The truth and white noise.
    White,
    /// The sensor with all that follows it.
    Real,
}

/// Treatment of the force's noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum FilterKind {
    /// None.
    None,
    /// First-order lag.
    FirstOrder,
    /// Second-order Bessel filter.
    Bessel,
    /// Median of the last samples.
    Median,
}
