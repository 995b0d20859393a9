//! Each stage of `[sensing]`: its kind, the range of each of its keys, and what its values must be to each other.

use std::ops::RangeInclusive;

use super::super::check::Section;
use super::super::error::ScenarioError;
use super::keys::{
    AccelerationKeys, AdcKeys, CommandChainKeys, CommandChainKind, FilterKeys, FilterKind,
    ForceKeys, Preset, RegulatorPressureKeys, SensorKind, StrokeKeys,
};
use crate::sensing::parameters::{
    paper_accelerometer, paper_load_cell, paper_outlet_pressure, paper_position, paper_set_value,
};
use crate::sensing::{
    AccelerometerParameters, AdcParameters, AmplifierParameters, CommandChain, FilterParameters,
    InstrumentationAmplifierParameters, LoadCellParameters, Measurement, OutletPressureParameters,
    PositionSensorParameters, PwmFilterParameters, SetValueParameters,
};

/// Standard gravity [m/s2], with which a capacity in kg is a force.
const STANDARD_GRAVITY: f64 = 9.80665;

/// Standard deviations of white noise: 1 N of force, and for pressure and acceleration about what makes 1 N on the default device.
pub mod white {
    /// Of the force [N].
    pub const FORCE: f64 = 1.0;
    /// Of the stroke [m].
    pub const STROKE: f64 = 2e-5;
    /// Of the regulator's outlet pressure [Pa].
    pub const PRESSURE: f64 = 600.0;
    /// Of the acceleration [m/s2].
    pub const ACCELERATION: f64 = 0.25;
}

type Result<T> = std::result::Result<T, ScenarioError>;

/// A sensor's table.
pub struct Sensor<'a> {
    /// The table.
    pub section: Section<'a>,
    /// Kind that it gives itself.
    pub given: Option<SensorKind>,
    /// Source of the kind otherwise.
    pub preset: Preset,
}

impl Sensor<'_> {
    /// The channel of this kind; `deviation` is the key of the noise, what the file gives for it, the default of white noise [SI] and the range.
    fn channel<S>(
        &self,
        deviation: (&str, Option<f64>, f64, RangeInclusive<f64>),
        real: impl FnOnce(&Section<'_>) -> Result<S>,
    ) -> Result<Measurement<S>> {
        let (key, given, default, range) = deviation;
        let kind = self.given.unwrap_or(match self.preset {
            Preset::Ideal => SensorKind::Ideal,
            Preset::White => SensorKind::White,
            Preset::Paper => SensorKind::Real,
        });
        let by_preset = self.given.is_none();
        Ok(match kind {
            SensorKind::Ideal => {
                only(&self.section, "ideal", by_preset, &[])?;
                Measurement::Ideal
            }
            SensorKind::White => {
                only(&self.section, "white", by_preset, &[key])?;
                Measurement::White {
                    standard_deviation: self.section.number_or(key, given, default, range)?,
                }
            }
            SensorKind::Real => Measurement::Real(real(&self.section)?),
        })
    }
}

/// Refuses keys that a kind does not have.
pub fn only(section: &Section<'_>, kind: &str, by_preset: bool, allowed: &[&str]) -> Result<()> {
    let is_other = |key: &&str| *key != "kind" && !allowed.contains(key);
    let Some(key) = section.given().find(is_other) else {
        return Ok(());
    };
    let others = match allowed {
        [] => "no other key".to_owned(),
        _ => allowed.join(", "),
    };
    let origin = if by_preset { ", the preset's," } else { "" };
    Err(section.misplaced(key, format!("kind = \"{kind}\"{origin} has {others}")))
}

/// Way from the set pressure to the regulator.
#[rustfmt::skip] // A table: one key a line.
pub fn command(section: &Section<'_>, keys: &CommandChainKeys, preset: Preset) -> Result<CommandChain> {
    let kind = keys.kind.unwrap_or(match preset {
        Preset::Paper => CommandChainKind::Real,
        Preset::Ideal | Preset::White => CommandChainKind::Ideal,
    });
    if kind == CommandChainKind::Ideal {
        only(section, "ideal", keys.kind.is_none(), &[])?;
        return Ok(CommandChain::Ideal);
    }
    let paper = paper_set_value();
    let (pwm, amplifier) = (paper.pwm, paper.amplifier);
    Ok(CommandChain::Real(SetValueParameters {
        full_scale: section.number_or("full_scale_bar_gauge", keys.full_scale_bar_gauge, paper.full_scale, 0.1..=16.0)?,
        full_voltage: section.number_or("full_input_v", keys.full_input_v, paper.full_voltage, 0.1..=50.0)?,
        pwm: PwmFilterParameters {
            high_voltage: section.number_or("pwm_high_v", keys.pwm_high_v, pwm.high_voltage, 0.1..=50.0)?,
            bits: section.count("pwm_bits", keys.pwm_bits.unwrap_or(pwm.bits), 1..=16)?,
            frequency: section.number_or("pwm_frequency_hz", keys.pwm_frequency_hz, pwm.frequency, 1.0..=1e5)?,
            resistance: section.number_or("resistance_ohm", keys.resistance_ohm, pwm.resistance, 10.0..=1e7)?,
            capacitance: section.number_or("capacitance_uf", keys.capacitance_uf, pwm.capacitance, 0.001..=1e4)?,
        },
        amplifier: AmplifierParameters {
            nominal_gain: section.number_or("amplifier_gain", keys.amplifier_gain, amplifier.nominal_gain, 1.01..=100.0)?,
            feedback_resistor_error: section.number_or("feedback_resistor_error", keys.feedback_resistor_error, amplifier.feedback_resistor_error, -0.5..=0.5)?,
            ground_resistor_error: section.number_or("ground_resistor_error", keys.ground_resistor_error, amplifier.ground_resistor_error, -0.5..=0.5)?,
        },
    }))
}

/// The regulator's outlet pressure.
#[rustfmt::skip] // A table: one key a line.
pub fn regulator_pressure(
    sensor: &Sensor<'_>,
    keys: &RegulatorPressureKeys,
    adc: AdcParameters,
) -> Result<Measurement<OutletPressureParameters>> {
    let (key, given, range) = ("standard_deviation_pa", keys.standard_deviation_pa, 0.0..=1e6);
    sensor.channel((key, given, white::PRESSURE, range.clone()), |section| {
        let paper = paper_outlet_pressure();
        let real = OutletPressureParameters {
            full_scale: section.number_or("full_scale_bar_gauge", keys.full_scale_bar_gauge, paper.full_scale, 0.1..=16.0)?,
            zero_voltage: section.number_or("zero_v", keys.zero_v, paper.zero_voltage, 0.0..=50.0)?,
            full_voltage: section.number_or("full_v", keys.full_v, paper.full_voltage, 0.1..=50.0)?,
            scale_error: section.number_or("scale_error", keys.scale_error, paper.scale_error, -0.5..=0.5)?,
            converter_gain: section.number_or("converter_gain", keys.converter_gain, paper.converter_gain, 0.01..=100.0)?,
            assumed_converter_gain: section.number_or("assumed_converter_gain", keys.assumed_converter_gain, paper.assumed_converter_gain, 0.01..=100.0)?,
            noise: section.number_or(key, given, paper.noise, range)?,
            adc,
        };
        let zero = ("zero_v", keys.zero_v, real.zero_voltage);
        check_order(section, zero, ("full_v", keys.full_v, real.full_voltage), Order::Strict)?;
        Ok(real)
    })
}

/// The contact force.
#[rustfmt::skip] // A table: one key a line.
pub fn force(sensor: &Sensor<'_>, keys: &ForceKeys, adc: AdcParameters) -> Result<Measurement<LoadCellParameters>> {
    let (key, given, range) = ("standard_deviation_n", keys.standard_deviation_n, 0.0..=1000.0);
    sensor.channel((key, given, white::FORCE, range.clone()), |section| {
        let paper = paper_load_cell();
        let amplifier = paper.amplifier;
        let real = LoadCellParameters {
            capacity: match keys.capacity_kg {
                Some(mass) => section.number("capacity_kg", mass, 0.1..=1e4)? * STANDARD_GRAVITY,
                None => paper.capacity,
            },
            rated_output: section.number_or("rated_output_mv_per_v", keys.rated_output_mv_per_v, paper.rated_output, 0.1..=100.0)?,
            excitation: section.number_or("excitation_v", keys.excitation_v, paper.excitation, 0.1..=50.0)?,
            zero_offset: section.number_or("zero_offset_n", keys.zero_offset_n, paper.zero_offset, -1000.0..=1000.0)?,
            noise: section.number_or(key, given, paper.noise, range)?,
            amplifier: InstrumentationAmplifierParameters {
                gain_resistor: section.number_or("gain_resistor_ohm", keys.gain_resistor_ohm, amplifier.gain_resistor, 6.0..=1e6)?,
                reference_voltage: section.number_or("reference_v", keys.reference_v, amplifier.reference_voltage, -50.0..=50.0)?,
                lowest_output: section.number_or("lowest_output_v", keys.lowest_output_v, amplifier.lowest_output, -50.0..=50.0)?,
                highest_output: section.number_or("highest_output_v", keys.highest_output_v, amplifier.highest_output, -50.0..=50.0)?,
            },
            assumed_gain_resistor: section.number_or("assumed_gain_resistor_ohm", keys.assumed_gain_resistor_ohm, paper.assumed_gain_resistor, 6.0..=1e6)?,
            adc,
        };
        let lowest = ("lowest_output_v", keys.lowest_output_v, real.amplifier.lowest_output);
        let reference = ("reference_v", keys.reference_v, real.amplifier.reference_voltage);
        let highest = ("highest_output_v", keys.highest_output_v, real.amplifier.highest_output);
        check_order(section, lowest, highest, Order::Strict)?;
        check_order(section, lowest, reference, Order::OrEqual)?;
        check_order(section, reference, highest, Order::OrEqual)?;
        Ok(real)
    })
}

/// The stroke.
#[rustfmt::skip] // A table: one key a line.
pub fn stroke(sensor: &Sensor<'_>, keys: &StrokeKeys) -> Result<Measurement<PositionSensorParameters>> {
    let (key, given, range) = ("standard_deviation_mm", keys.standard_deviation_mm, 0.0..=10.0);
    sensor.channel((key, given, white::STROKE, range.clone()), |section| {
        let paper = paper_position();
        Ok(PositionSensorParameters {
            gain: section.number_or("gain", keys.gain, paper.gain, 0.5..=1.5)?,
            offset: section.number_or("offset_mm", keys.offset_mm, paper.offset, -50.0..=50.0)?,
            noise: section.number_or(key, given, paper.noise, range)?,
            resolution: section.number_or("resolution_mm", keys.resolution_mm, paper.resolution, 0.0..=10.0)?,
        })
    })
}

/// The acceleration.
#[rustfmt::skip] // A table: one key a line.
pub fn acceleration(
    sensor: &Sensor<'_>,
    keys: &AccelerationKeys,
) -> Result<Measurement<AccelerometerParameters>> {
    let (key, given, range) = ("standard_deviation_m_per_s2", keys.standard_deviation_m_per_s2, 0.0..=1000.0);
    sensor.channel((key, given, white::ACCELERATION, range.clone()), |section| {
        let paper = paper_accelerometer();
        Ok(AccelerometerParameters {
            bias: section.number_or("bias_m_per_s2", keys.bias_m_per_s2, paper.bias, -100.0..=100.0)?,
            noise: section.number_or(key, given, paper.noise, range)?,
            range: section.number_or("range_m_per_s2", keys.range_m_per_s2, paper.range, 0.1..=1e5)?,
            resolution: section.number_or("resolution_m_per_s2", keys.resolution_m_per_s2, paper.resolution, 0.0..=100.0)?,
        })
    })
}

/// The ADC of regulator pressure and force.
#[rustfmt::skip] // A table: one key a line.
pub fn adc(section: &Section<'_>, keys: &AdcKeys) -> Result<AdcParameters> {
    let paper = AdcParameters::ARDUINO;
    Ok(AdcParameters {
        bits: section.count("bits", keys.bits.unwrap_or(paper.bits), 1..=24)?,
        reference: section.number_or("reference_v", keys.reference_v, paper.reference, 0.1..=50.0)?,
        noise: section.number_or("noise_steps", keys.noise_steps, paper.noise, 0.0..=1000.0)?,
    })
}

/// Treatment of the force's noise at a sample rate [Hz], infinite for none.
pub fn filter(section: &Section<'_>, keys: &FilterKeys, rate: f64) -> Result<FilterParameters> {
    let (kind, allowed): (&str, &[&str]) = match keys.kind {
        FilterKind::None => ("none", &[]),
        FilterKind::FirstOrder => ("first_order", &["time_constant_ms"]),
        FilterKind::Bessel => ("bessel", &["cutoff_hz"]),
        FilterKind::Median => ("median", &["length"]),
    };
    only(section, kind, false, allowed)?;
    if keys.kind != FilterKind::None && rate == f64::INFINITY {
        let expected = "it to be given in Hz, for [sensing.filter] works from sample to sample";
        return Err(Section::new(section.document(), "sensing").missing("sample_rate_hz", expected));
    }
    let missing = |key| section.missing(key, &format!("it to be given with kind = \"{kind}\""));
    Ok(match keys.kind {
        FilterKind::None => FilterParameters::None,
        FilterKind::FirstOrder => {
            let key = "time_constant_ms";
            let value = keys.time_constant_ms.ok_or_else(|| missing(key))?;
            FilterParameters::FirstOrder {
                time_constant: section.number(key, value, 0.1..=10_000.0)?,
            }
        }
        FilterKind::Bessel => {
            let key = "cutoff_hz";
            let value = keys.cutoff_hz.ok_or_else(|| missing(key))?;
            let cutoff = section.number(key, value, 0.001..=50_000.0)?;
            if cutoff >= 0.5 * rate {
                let expected = format!("less than {} Hz, half the sample rate", 0.5 * rate);
                return Err(section.refuse_number(key, value, expected));
            }
            FilterParameters::Bessel2 { cutoff }
        }
        FilterKind::Median => {
            let key = "length";
            let value = keys.length.ok_or_else(|| missing(key))?;
            let length = section.count(key, value, 1..=99)?;
            if length % 2 == 0 {
                return Err(section.refuse(key, length.to_string(), "an odd number".to_owned()));
            }
            FilterParameters::Median { length }
        }
    })
}

/// Required order of two voltages.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Order {
    Strict,
    OrEqual,
}

/// A key, what the file gives for it, and the value that holds [V].
type Voltage<'a> = (&'a str, Option<f64>, f64);

/// Refuses two voltages in the wrong order, at the one that the file gives.
fn check_order(
    section: &Section<'_>,
    low: Voltage<'_>,
    high: Voltage<'_>,
    order: Order,
) -> Result<()> {
    if low.2 < high.2 || (order == Order::OrEqual && low.2 == high.2) {
        return Ok(());
    }
    let (more, less) = match order {
        Order::Strict => ("more than", "less than"),
        Order::OrEqual => ("at least", "at most"),
    };
    let (at_fault, words, other) = if high.1.is_some() {
        (high, more, low)
    } else {
        (low, less, high)
    };
    let expected = format!("{words} {}, {} V", other.0, other.2);
    Err(section.refuse_number(at_fault.0, at_fault.2, expected))
}
