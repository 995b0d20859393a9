//! `[sensing]` of a scenario of either kind, from its keys to the checked chain.
//!
//! The preset says of which kind each stage is that does not say so itself, and how often samples are taken. What a stage's other keys leave
//! out does not depend on the preset: the source paper's value for a real stage, `WHITE` for a white one.

use std::ops::RangeInclusive;

use super::check::Section;
use super::document::Document;
use super::error::ScenarioError;
use super::sensing_file::{
    AccelerationKeys, AdcKeys, CommandChainKeys, CommandChainKind, FilterKeys, FilterKind,
    ForceKeys, Preset, RegulatorPressureKeys, SensingKeys, SensorKind, StrokeKeys,
};
use crate::sensing::parameters::{
    paper_accelerometer, paper_load_cell, paper_outlet_pressure, paper_position, paper_set_value,
};
use crate::sensing::{
    AccelerometerParameters, AdcParameters, Channel, CommandChain, FilterParameters,
    LoadCellParameters, OutletPressureParameters, PositionSensorParameters, SensingParameters,
    SetValueParameters,
};

/// Standard gravity [m/s2], with which a capacity in kg is a force.
const STANDARD_GRAVITY: f64 = 9.80665;

/// Standard deviations of white noise [N], [m], [Pa], [m/s2]: 1 N of force, and about as much of pressure times area and of mass times
/// acceleration of the default device.
const WHITE: (f64, f64, f64, f64) = (1.0, 2e-5, 600.0, 0.25);

/// `[sensing]` and the tables in it, for a time step [s] of `[simulation]`.
pub(super) fn sensing(
    document: &Document<'_>,
    keys: &SensingKeys,
    step: f64,
) -> Result<SensingParameters, ScenarioError> {
    let section = |name: &str| Section::new(document, format!("sensing.{name}"));
    let sensor = |name: &str, kind: Option<SensorKind>| {
        let by_preset = match keys.preset {
            Preset::Ideal => SensorKind::Ideal,
            Preset::White => SensorKind::White,
            Preset::Paper => SensorKind::Real,
        };
        Stage {
            section: section(name),
            kind: kind.unwrap_or(by_preset),
            by_preset: kind.is_none(),
        }
    };
    let adc = adc(&section("adc"), &keys.adc)?;
    let sample_rate = sample_rate(document, keys, step)?;
    let sensing = SensingParameters {
        command: command(document, keys)?,
        regulator_pressure: regulator_pressure(
            &sensor("regulator_pressure", keys.regulator_pressure.kind),
            &keys.regulator_pressure,
            adc,
        )?,
        force: force(&sensor("force", keys.force.kind), &keys.force, adc)?,
        stroke: stroke(&sensor("stroke", keys.stroke.kind), &keys.stroke)?,
        acceleration: acceleration(
            &sensor("acceleration", keys.acceleration.kind),
            &keys.acceleration,
        )?,
        sample_rate,
        force_filter: match &keys.filter {
            None => FilterParameters::None,
            Some(keys) => filter(&section("filter"), keys, sample_rate)?,
        },
    };
    let pressure_is_real = matches!(sensing.regulator_pressure, Channel::Real(_));
    if !pressure_is_real
        && !matches!(sensing.force, Channel::Real(_))
        && let Some(key) = document.keys_in("sensing.adc").next()
    {
        let reason = "neither [sensing.regulator_pressure] nor [sensing.force] is real, and no other sensor has an ADC";
        return Err(section("adc").misplaced(key, reason.to_owned()));
    }
    Ok(sensing)
}

/// Largest set pressure that a command's way gives if its resistors are as meant, gauge [Pa]; infinite for the ideal one.
pub fn largest_set_pressure(command: &CommandChain) -> f64 {
    match command {
        CommandChain::Ideal => f64::INFINITY,
        CommandChain::Real(chain) => chain.full_scale * (highest_voltage(chain) / chain.full_voltage),
    }
}

/// Highest voltage at the regulator [V].
fn highest_voltage(chain: &SetValueParameters) -> f64 {
    (chain.amplifier.nominal_gain * chain.pwm.high_voltage).min(chain.full_voltage)
}

/// Refuses a set pressure [Pa gauge] that the command's way cannot give.
pub(super) fn check_set_pressure(
    section: &Section<'_>,
    key: &str,
    wanted: f64,
    command: &CommandChain,
) -> Result<(), ScenarioError> {
    let CommandChain::Real(chain) = command else {
        return Ok(());
    };
    let largest = largest_set_pressure(command);
    // A set pressure at the very end of the range may be a rounding above it.
    if wanted <= largest * (1.0 + 1e-9) {
        return Ok(());
    }
    let shown = |value: f64| (value * 1e3).round() / 1e3;
    let found = format!(
        "{} bar gauge, {} V at the regulator",
        wanted / 1e5,
        shown(chain.full_voltage * wanted / chain.full_scale)
    );
    let expected = format!(
        "0 to {} bar gauge, the 0 to {} V that [sensing.command] gives",
        shown(largest / 1e5),
        shown(highest_voltage(chain))
    );
    Err(section.refuse(key, found, expected))
}

/// A sensor's table.
struct Stage<'a> {
    section: Section<'a>,
    kind: SensorKind,
    /// Is it of this kind only because the preset is?
    by_preset: bool,
}

impl Stage<'_> {
    /// The channel of this kind; `deviation` is the key of the white noise with its value, default [SI] and range.
    fn channel<S>(
        &self,
        (key, given, default, range): (&str, Option<f64>, f64, RangeInclusive<f64>),
        real: impl FnOnce(&Section<'_>) -> Result<S, ScenarioError>,
    ) -> Result<Channel<S>, ScenarioError> {
        match self.kind {
            SensorKind::Ideal => {
                only(&self.section, "ideal", self.by_preset, &[])?;
                Ok(Channel::Ideal)
            }
            SensorKind::White => {
                only(&self.section, "white", self.by_preset, &[key])?;
                let mut standard_deviation = default;
                replace(&mut standard_deviation, &self.section, key, given, range)?;
                Ok(Channel::White { standard_deviation })
            }
            SensorKind::Real => real(&self.section).map(Channel::Real),
        }
    }
}

/// Refuses keys that a kind does not have.
fn only(
    section: &Section<'_>,
    kind: &str,
    by_preset: bool,
    allowed: &[&str],
) -> Result<(), ScenarioError> {
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

/// Replaces a value by the one that the file gives, if it does.
fn replace(
    value: &mut f64,
    section: &Section<'_>,
    key: &str,
    given: Option<f64>,
    range: RangeInclusive<f64>,
) -> Result<(), ScenarioError> {
    if let Some(given) = given {
        *value = section.number(key, given, range)?;
    }
    Ok(())
}

/// A key, what the file gives for it, and the value that holds [V].
type Voltage<'a> = (&'a str, Option<f64>, f64);

/// Refuses two voltages in the wrong order, at the one that the file gives.
fn check_order(
    section: &Section<'_>,
    low: Voltage<'_>,
    high: Voltage<'_>,
    may_be_equal: bool,
) -> Result<(), ScenarioError> {
    if low.2 < high.2 || (may_be_equal && low.2 == high.2) {
        return Ok(());
    }
    let (more, less) = if may_be_equal {
        ("at least", "at most")
    } else {
        ("more than", "less than")
    };
    let (at_fault, words, other) = if high.1.is_some() {
        (high, more, low)
    } else {
        (low, less, high)
    };
    let expected = format!("{words} {}, {} V", other.0, other.2);
    Err(section.refuse_number(at_fault.0, at_fault.2, expected))
}

/// At most one sample a step; infinite when there is no rate.
fn sample_rate(
    document: &Document<'_>,
    keys: &SensingKeys,
    step: f64,
) -> Result<f64, ScenarioError> {
    let section = Section::new(document, "sensing");
    let mut rate = match keys.preset {
        Preset::Paper => SensingParameters::paper().sample_rate,
        Preset::Ideal | Preset::White => f64::INFINITY,
    };
    replace(&mut rate, &section, "sample_rate_hz", keys.sample_rate_hz, 0.1..=1e5)?;
    // A step that is the sample period may be a rounding longer.
    if rate == f64::INFINITY || rate * step <= 1.0 + 1e-9 {
        return Ok(rate);
    }
    Err(if keys.sample_rate_hz.is_some() {
        let expected = format!("at most {} Hz, one sample a step", 1.0 / step);
        section.refuse_number("sample_rate_hz", rate, expected)
    } else {
        let period = 1e3 / rate;
        let expected = format!("at most {period} ms, the sample period of [sensing]");
        Section::new(document, "simulation").refuse_number("step_ms", step * 1e3, expected)
    })
}

#[rustfmt::skip] // A table: one key a line.
fn command(document: &Document<'_>, keys: &SensingKeys) -> Result<CommandChain, ScenarioError> {
    let section = &Section::new(document, "sensing.command");
    let kind = match (keys.command.kind, keys.preset) {
        (Some(kind), _) => kind,
        (None, Preset::Paper) => CommandChainKind::Real,
        (None, Preset::Ideal | Preset::White) => CommandChainKind::Ideal,
    };
    let keys: &CommandChainKeys = &keys.command;
    if kind == CommandChainKind::Ideal {
        only(section, "ideal", keys.kind.is_none(), &[])?;
        return Ok(CommandChain::Ideal);
    }
    let mut chain = paper_set_value();
    replace(&mut chain.full_scale, section, "full_scale_bar_gauge", keys.full_scale_bar_gauge, 0.1..=16.0)?;
    replace(&mut chain.full_voltage, section, "full_input_v", keys.full_input_v, 0.1..=50.0)?;
    replace(&mut chain.pwm.high_voltage, section, "pwm_high_v", keys.pwm_high_v, 0.1..=50.0)?;
    if let Some(bits) = keys.pwm_bits {
        chain.pwm.bits = section.count("pwm_bits", bits, 1..=16)?;
    }
    replace(&mut chain.pwm.frequency, section, "pwm_frequency_hz", keys.pwm_frequency_hz, 1.0..=1e5)?;
    replace(&mut chain.pwm.resistance, section, "resistance_ohm", keys.resistance_ohm, 10.0..=1e7)?;
    replace(&mut chain.pwm.capacitance, section, "capacitance_uf", keys.capacitance_uf, 0.001..=1e4)?;
    let amplifier = &mut chain.amplifier;
    replace(&mut amplifier.nominal_gain, section, "amplifier_gain", keys.amplifier_gain, 1.01..=100.0)?;
    replace(&mut amplifier.feedback_resistor_error, section, "feedback_resistor_error", keys.feedback_resistor_error, -0.5..=0.5)?;
    replace(&mut amplifier.ground_resistor_error, section, "ground_resistor_error", keys.ground_resistor_error, -0.5..=0.5)?;
    Ok(CommandChain::Real(chain))
}

#[rustfmt::skip] // A table: one key a line.
fn regulator_pressure(
    stage: &Stage<'_>,
    keys: &RegulatorPressureKeys,
    adc: AdcParameters,
) -> Result<Channel<OutletPressureParameters>, ScenarioError> {
    let deviation = || ("standard_deviation_pa", keys.standard_deviation_pa);
    let (key, given) = deviation();
    stage.channel((key, given, WHITE.2, 0.0..=1e6), |section| {
        let mut sensor = paper_outlet_pressure();
        replace(&mut sensor.noise, section, key, given, 0.0..=1e6)?;
        replace(&mut sensor.full_scale, section, "full_scale_bar_gauge", keys.full_scale_bar_gauge, 0.1..=16.0)?;
        replace(&mut sensor.zero_voltage, section, "zero_v", keys.zero_v, 0.0..=50.0)?;
        replace(&mut sensor.full_voltage, section, "full_v", keys.full_v, 0.1..=50.0)?;
        replace(&mut sensor.scale_error, section, "scale_error", keys.scale_error, -0.5..=0.5)?;
        replace(&mut sensor.converter_gain, section, "converter_gain", keys.converter_gain, 0.01..=100.0)?;
        replace(&mut sensor.assumed_converter_gain, section, "assumed_converter_gain", keys.assumed_converter_gain, 0.01..=100.0)?;
        let zero = ("zero_v", keys.zero_v, sensor.zero_voltage);
        check_order(section, zero, ("full_v", keys.full_v, sensor.full_voltage), false)?;
        sensor.adc = adc;
        Ok(sensor)
    })
}
