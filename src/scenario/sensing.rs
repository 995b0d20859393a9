//! `[sensing]` of a scenario of either kind, from its keys to the checked chain.
//!
//! The preset says of which kind each stage is that does not say so itself, and how often samples are taken. What a stage leaves out
//! does not depend on the preset: it is the source paper's for a real stage (`crate::sensing::parameters`), `WHITE` for a white one.

use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::sensing::{
    AdcParameters, CommandChain, FilterParameters, Measurement, SensingParameters,
};
use keys::{Preset, SensingKeys, SensorKind};
use stages::Sensor;

pub(super) mod keys;
pub(super) mod stages;

pub(super) use stages::white;

/// `[sensing]` and the tables in it; `step` is the scenario's time step [s].
pub(super) fn sensing(
    document: &Document<'_>,
    keys: &SensingKeys,
    step: f64,
) -> Result<SensingParameters, ScenarioError> {
    let section = |name: &str| Section::new(document, format!("sensing.{name}"));
    let sensor = |name: &str, given: Option<SensorKind>| Sensor {
        section: section(name),
        given,
        preset: keys.preset,
    };
    let adc = AdcParameters {
        bits: keys.adc.bits,
        reference: keys.adc.reference,
        noise: keys.adc.noise,
    };
    let pressure = &keys.regulator_pressure;
    let pressure_sensor = sensor("regulator_pressure", pressure.kind);
    let sample_rate = sample_rate(document, keys, step)?;
    let sensing = SensingParameters {
        command: stages::command(&section("command"), &keys.command, keys.preset)?,
        regulator_pressure: stages::regulator_pressure(&pressure_sensor, pressure, adc)?,
        force: stages::force(&sensor("force", keys.force.kind), &keys.force, adc)?,
        stroke: stages::stroke(&sensor("stroke", keys.stroke.kind), &keys.stroke)?,
        acceleration: stages::acceleration(
            &sensor("acceleration", keys.acceleration.kind),
            &keys.acceleration,
        )?,
        sample_rate,
        force_filter: match &keys.filter {
            None => FilterParameters::None,
            Some(keys) => stages::filter(&section("filter"), keys, sample_rate)?,
        },
    };
    let has_adc = matches!(sensing.regulator_pressure, Measurement::Real(_))
        || matches!(sensing.force, Measurement::Real(_));
    if let (false, Some(key)) = (has_adc, section("adc").given().next()) {
        let reason = "it reads regulator pressure and force, and neither has kind = \"real\"";
        return Err(section("adc").misplaced(key, reason.to_owned()));
    }
    Ok(sensing)
}

/// Samples per second [Hz], at most one a step [s]; infinite for one at every step.
fn sample_rate(
    document: &Document<'_>,
    keys: &SensingKeys,
    step: f64,
) -> Result<f64, ScenarioError> {
    let by_preset = match keys.preset {
        Preset::Paper => SensingParameters::paper().sample_rate,
        Preset::Ideal | Preset::White => f64::INFINITY,
    };
    let section = Section::new(document, "sensing");
    let rate = keys.sample_rate.unwrap_or(by_preset);
    // A step that is the sample period may be a rounding longer.
    if rate == f64::INFINITY || rate * step <= 1.0 + 1e-9 {
        return Ok(rate);
    }
    Err(if keys.sample_rate.is_some() {
        let expected = format!("at most {} Hz, one sample a step", 1.0 / step);
        section.refuse_number("sample_rate_hz", rate, expected)
    } else {
        let period = 1e3 / rate;
        let expected = format!("at most {period} ms, the sample period of [sensing]");
        Section::new(document, "simulation").refuse_number("step_ms", step * 1e3, expected)
    })
}

/// Largest set pressure that a command's way gives with the resistors that were meant, gauge [Pa]; infinite for the ideal one.
pub fn largest_set_pressure(command: &CommandChain) -> f64 {
    match command {
        CommandChain::Ideal => f64::INFINITY,
        CommandChain::Real(chain) => {
            let highest = chain.amplifier.nominal_gain * chain.pwm.high_voltage;
            chain.full_scale * (highest / chain.full_voltage).min(1.0)
        }
    }
}

/// Refuses a set pressure, gauge [Pa], that the command's way cannot give.
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
    // One at the very end of the range may be a rounding above it.
    if wanted <= largest * (1.0 + 1e-9) {
        return Ok(());
    }
    let rounded = |value: f64| (value * 1e3).round() / 1e3;
    let shown = |pressure: f64| {
        let voltage = chain.full_voltage * pressure / chain.full_scale;
        (rounded(pressure / 1e5), rounded(voltage))
    };
    let (pressure, voltage) = shown(wanted);
    let found = format!("{pressure} bar gauge, {voltage} V at the regulator");
    let (pressure, voltage) = shown(largest);
    let expected =
        format!("0 to {pressure} bar gauge, the 0 to {voltage} V that [sensing.command] can give");
    Err(section.refuse(key, found, expected))
}
