//! Each stage of `[sensing]`: its kind, and what its values must be to each other.

use super::keys::{
    AccelerationKeys, CommandChainKeys, CommandChainKind, FilterKeys, FilterKind, ForceKeys,
    Preset, RegulatorPressureKeys, STANDARD_GRAVITY, SensorKind, StrokeKeys,
};
use crate::keys::check::Section;
use crate::keys::declaration::Table;
use crate::keys::error::ScenarioError;
use crate::sensing::parameters::{paper_accelerometer, paper_outlet_pressure};
use crate::sensing::{
    AccelerometerParameters, AdcParameters, AmplifierParameters, CommandChain, FilterParameters,
    InstrumentationAmplifierParameters, LoadCellParameters, Measurement, OutletPressureParameters,
    PositionSensorParameters, PwmFilterParameters, SetValueParameters,
};

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
    /// The channel of this kind; of white noise with a standard deviation [SI].
    fn channel<K: Table, S>(
        &self,
        white: f64,
        real: impl FnOnce(&Section<'_>) -> Result<S>,
    ) -> Result<Measurement<S>> {
        let (kind, word) = match self.preset {
            Preset::Ideal => (SensorKind::Ideal, "ideal"),
            Preset::White => (SensorKind::White, "white"),
            Preset::Paper => (SensorKind::Real, "real"),
        };
        self.section.of_kind::<K>(Some(word))?;
        Ok(match self.given.unwrap_or(kind) {
            SensorKind::Ideal => Measurement::Ideal,
            SensorKind::White => Measurement::White {
                standard_deviation: white,
            },
            SensorKind::Real => Measurement::Real(real(&self.section)?),
        })
    }
}

/// Way from the set pressure to the regulator.
pub fn command(
    section: &Section<'_>,
    keys: &CommandChainKeys,
    preset: Preset,
) -> Result<CommandChain> {
    let (kind, word) = match preset {
        Preset::Paper => (CommandChainKind::Real, "real"),
        Preset::Ideal | Preset::White => (CommandChainKind::Ideal, "ideal"),
    };
    section.of_kind::<CommandChainKeys>(Some(word))?;
    Ok(match keys.kind.unwrap_or(kind) {
        CommandChainKind::Ideal => CommandChain::Ideal,
        CommandChainKind::Real => CommandChain::Real(SetValueParameters {
            full_scale: keys.full_scale,
            full_voltage: keys.full_input,
            pwm: PwmFilterParameters {
                high_voltage: keys.pwm_high,
                bits: keys.pwm_bits,
                frequency: keys.pwm_frequency,
                resistance: keys.resistance,
                capacitance: keys.capacitance,
            },
            amplifier: AmplifierParameters {
                nominal_gain: keys.amplifier_gain,
                feedback_resistor_error: keys.feedback_resistor_error,
                ground_resistor_error: keys.ground_resistor_error,
            },
        }),
    })
}

/// The regulator's outlet pressure.
pub fn regulator_pressure(
    sensor: &Sensor<'_>,
    keys: &RegulatorPressureKeys,
    adc: AdcParameters,
) -> Result<Measurement<OutletPressureParameters>> {
    let given = keys.standard_deviation;
    let white = given.unwrap_or(white::PRESSURE);
    sensor.channel::<RegulatorPressureKeys, _>(white, |section| {
        let (zero, full) = (("zero_v", keys.zero), ("full_v", keys.full));
        check_order(section, zero, full, Order::Strict)?;
        Ok(OutletPressureParameters {
            full_scale: keys.full_scale,
            zero_voltage: keys.zero,
            full_voltage: keys.full,
            scale_error: keys.scale_error,
            converter_gain: keys.converter_gain,
            assumed_converter_gain: keys.assumed_converter_gain,
            noise: given.unwrap_or(paper_outlet_pressure().noise),
            adc,
        })
    })
}

/// The contact force.
pub fn force(
    sensor: &Sensor<'_>,
    keys: &ForceKeys,
    adc: AdcParameters,
) -> Result<Measurement<LoadCellParameters>> {
    sensor.channel::<ForceKeys, _>(keys.standard_deviation, |section| {
        let lowest = ("lowest_output_v", keys.lowest_output);
        let reference = ("reference_v", keys.reference);
        let highest = ("highest_output_v", keys.highest_output);
        check_order(section, lowest, highest, Order::Strict)?;
        check_order(section, lowest, reference, Order::OrEqual)?;
        check_order(section, reference, highest, Order::OrEqual)?;
        Ok(LoadCellParameters {
            capacity: keys.capacity * STANDARD_GRAVITY,
            rated_output: keys.rated_output,
            excitation: keys.excitation,
            zero_offset: keys.zero_offset,
            noise: keys.standard_deviation,
            amplifier: InstrumentationAmplifierParameters {
                gain_resistor: keys.gain_resistor,
                reference_voltage: keys.reference,
                lowest_output: keys.lowest_output,
                highest_output: keys.highest_output,
            },
            assumed_gain_resistor: keys.assumed_gain_resistor,
            adc,
        })
    })
}

/// The stroke.
pub fn stroke(
    sensor: &Sensor<'_>,
    keys: &StrokeKeys,
) -> Result<Measurement<PositionSensorParameters>> {
    sensor.channel::<StrokeKeys, _>(keys.standard_deviation, |_| {
        Ok(PositionSensorParameters {
            gain: keys.gain,
            offset: keys.offset,
            noise: keys.standard_deviation,
            resolution: keys.resolution,
        })
    })
}

/// The acceleration.
pub fn acceleration(
    sensor: &Sensor<'_>,
    keys: &AccelerationKeys,
) -> Result<Measurement<AccelerometerParameters>> {
    let given = keys.standard_deviation;
    let white = given.unwrap_or(white::ACCELERATION);
    sensor.channel::<AccelerationKeys, _>(white, |_| {
        Ok(AccelerometerParameters {
            bias: keys.bias,
            noise: given.unwrap_or(paper_accelerometer().noise),
            range: keys.range,
            resolution: keys.resolution,
        })
    })
}

/// Treatment of the force's noise at a sample rate [Hz], infinite for none.
pub fn filter(section: &Section<'_>, keys: &FilterKeys, rate: f64) -> Result<FilterParameters> {
    section.of_kind::<FilterKeys>(None)?;
    if keys.kind != FilterKind::None && rate == f64::INFINITY {
        let expected = "it to be given in Hz, for [sensing.filter] works from sample to sample";
        return Err(Section::new(section.document(), "sensing").missing("sample_rate_hz", expected));
    }
    // What a kind needs is there by now.
    let needed = |value: Option<f64>| value.unwrap_or_default();
    Ok(match keys.kind {
        FilterKind::None => FilterParameters::None,
        FilterKind::FirstOrder => FilterParameters::FirstOrder {
            time_constant: needed(keys.time_constant),
        },
        FilterKind::Bessel => {
            let cutoff = needed(keys.cutoff);
            if cutoff >= 0.5 * rate {
                let expected = format!("less than {} Hz, half the sample rate", 0.5 * rate);
                return Err(section.refuse_si("cutoff_hz", cutoff, expected));
            }
            FilterParameters::Bessel2 { cutoff }
        }
        FilterKind::Median => {
            let length = keys.length.unwrap_or_default();
            if length.is_multiple_of(2) {
                let expected = "an odd number".to_owned();
                return Err(section.refuse("length", length.to_string(), expected));
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

/// Refuses two voltages [V] in the wrong order, at the one that the file gives.
fn check_order(
    section: &Section<'_>,
    low: (&str, f64),
    high: (&str, f64),
    order: Order,
) -> Result<()> {
    if low.1 < high.1 || (order == Order::OrEqual && low.1 == high.1) {
        return Ok(());
    }
    let (more, less) = match order {
        Order::Strict => ("more than", "less than"),
        Order::OrEqual => ("at least", "at most"),
    };
    let (at_fault, words, other) = if section.given().any(|key| key == high.0) {
        (high, more, low)
    } else {
        (low, less, high)
    };
    let expected = format!("{words} {}, {} V", other.0, other.1);
    Err(section.refuse_si(at_fault.0, at_fault.1, expected))
}
