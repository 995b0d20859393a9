//! From the numbers of a rig file to the rig's description, each checked to be plausible as SI.

use std::collections::BTreeMap;

use super::keys::{
    ForceRampKeys, LimitsKeys, Numbers, RecordingsKeys, RigKeys, SharesKeys, sections,
};
use super::number::Number;
use super::quantities::{DRIFT, NUMBERS, SENSOR_KEYS, needs, split};
use crate::keys::check::{Section, checked, plain};
use crate::keys::declaration::Table;
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::keys::suggestion::{advice, join};
use crate::plant::{DeviceParts, OperatingLimits, PlantParameters, Quantity, registry};
use crate::unit::Unit;

/// A number of the rig that is not exactly known.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Dotted key in the file.
    pub key: &'static str,
    /// The number in the rig's description.
    pub quantity: Quantity,
    /// Its value [SI].
    pub value: f64,
    /// Half the width of its tolerance, relative to the value [1].
    pub tolerance: f64,
}

/// Sets the rig's numbers and returns those that are not exactly known.
pub(super) fn base(
    document: &Document<'_>,
    keys: &RigKeys,
    plant: &mut PlantParameters,
) -> Result<Vec<Tolerance>, ScenarioError> {
    for (table, numbers) in keys.tables() {
        refuse_unknown(document, table, numbers)?;
    }
    plant.parts = parts(document, keys)?;
    if plant.parts == DeviceParts::MovedPiston {
        // The rig carries the piston: what it weighs does not show unless it is given.
        plant.device.moving_mass = LIGHT;
    }
    let is_given = |table: &str, key: &str| {
        let tables = keys.tables();
        let numbers = tables.iter().find(|(name, _)| *name == table);
        numbers.is_some_and(|(_, numbers)| numbers.contains_key(key))
    };
    let parts = plant.parts;
    let asked = |dotted: &str| {
        let (table, key) = dotted.split_once('.').unwrap_or(("", dotted));
        needs(parts, dotted) || is_given(table, key)
    };
    let mut tolerances = Vec::new();
    for known in NUMBERS.iter().filter(|known| asked(known.name)) {
        let (table, key) = split(known.name);
        let section = Section::new(document, table);
        let number = find(&section, keys, table, key)?;
        let is_count = known.name == registry::CYLINDER_COUNT.name;
        let is_exact = is_count || known.name == registry::SPINDLE_FREQUENCY.name;
        let value = match is_exact {
            true => exact(&section, key, number, known.range)?,
            false => checked(&section, key, number.value, known.range)?,
        };
        if is_count && value.fract() != 0.0 {
            return Err(section.refuse(key, plain(value), "a whole number".to_owned()));
        }
        known.quantity().set(plant, value);
        let tolerance = tolerance(&Section::new(document, known.name), number)?;
        if tolerance > 0.0 {
            tolerances.push(Tolerance {
                key: known.name,
                quantity: known.quantity(),
                value,
                tolerance,
            });
        }
    }
    Ok(tolerances)
}

/// A mass that makes no force [kg].
const LIGHT: f64 = 1e-3;

/// The share of the device that there is.
fn parts(document: &Document<'_>, keys: &RigKeys) -> Result<DeviceParts, ScenarioError> {
    let Some(name) = &keys.rig.chain else {
        return Ok(DeviceParts::Whole);
    };
    let known = DeviceParts::ALL
        .into_iter()
        .find(|parts| parts.name() == name);
    known.ok_or_else(|| {
        let names = DeviceParts::ALL.map(DeviceParts::name).join(", ");
        let section = Section::new(document, "rig");
        section.refuse("chain", format!("{name:?}"), format!("one of {names}"))
    })
}

fn refuse_unknown(
    document: &Document<'_>,
    table: &str,
    numbers: &Numbers,
) -> Result<(), ScenarioError> {
    let sections = sections();
    let known = sections.iter().find(|(name, _)| name == table);
    let known = known.map_or(&[][..], |(_, keys)| &keys[..]);
    match numbers.keys().find(|key| !known.contains(&key.as_str())) {
        None => Ok(()),
        Some(key) => {
            let key = join(table, key);
            Err(ScenarioError::UnknownKey {
                location: document.key_location(&key),
                advice: advice(&key, &sections),
                key,
            })
        }
    }
}

fn find<'a>(
    section: &Section<'_>,
    keys: &'a RigKeys,
    table: &str,
    key: &str,
) -> Result<&'a Number, ScenarioError> {
    let tables = keys.tables();
    let numbers = tables.iter().find(|(name, _)| *name == table);
    let number = numbers.and_then(|(_, numbers)| numbers.get(key));
    number.ok_or_else(|| {
        let unit = Unit::of_key(key);
        let expected = if unit.is_one() {
            "it to be given".to_owned()
        } else {
            format!("it to be given in {}", unit.symbol)
        };
        section.missing(key, &expected)
    })
}

/// A number that is taken to be exact.
fn exact(
    section: &Section<'_>,
    key: &str,
    number: &Number,
    range: [f64; 2],
) -> Result<f64, ScenarioError> {
    if *number != Number::from(number.value) {
        let reason = "this number is taken to be exact".to_owned();
        return Err(section.misplaced(key, reason));
    }
    checked(section, key, number.value, range)
}

/// Largest half-width of an interval, as a share of its value.
const WIDEST: f64 = 1000.0;

/// Relative half-width of the tolerance of a number, whose table is `section`; 0 for an exact one.
pub(super) fn tolerance(section: &Section<'_>, number: &Number) -> Result<f64, ScenarioError> {
    let value = number.value;
    if let Some(tolerance) = number.tolerance
        && !(0.0..1.0).contains(&tolerance)
    {
        let expected = "0 to less than 1, a share of the value".to_owned();
        return Err(section.refuse("tolerance", tolerance.to_string(), expected));
    }
    let interval = match (number.low, number.high) {
        (None, None) => None,
        (Some(_), None) => return Err(section.missing("high", "it to be given beside low")),
        (None, Some(_)) => return Err(section.missing("low", "it to be given beside high")),
        (Some(low), Some(high)) => Some((low, high)),
    };
    if let Some((low, high)) = interval {
        if !(low.is_finite() && low <= value) {
            let expected = format!("at most the value, {}", plain(value));
            return Err(section.refuse("low", plain(low), expected));
        }
        if !(high.is_finite() && high >= value) {
            let expected = format!("at least the value, {}", plain(value));
            return Err(section.refuse("high", plain(high), expected));
        }
        // A search over more orders of magnitude comes to no end.
        for (key, end) in [("low", low), ("high", high)] {
            if value != 0.0 && (end - value).abs() > WIDEST * value.abs() {
                let expected = format!("no farther from the value than {WIDEST} times itself");
                return Err(section.refuse(key, plain(end), expected));
            }
        }
    }
    let of_interval = |(low, high): (f64, f64)| {
        let half_width = (high - value).max(value - low);
        if value == 0.0 {
            0.0
        } else {
            half_width / value.abs()
        }
    };
    Ok(number
        .tolerance
        .or(interval.map(of_interval))
        .unwrap_or(0.0))
}

/// Conditions between the values.
pub(super) fn check_together(
    document: &Document<'_>,
    plant: &PlantParameters,
) -> Result<(), ScenarioError> {
    let device = &plant.device;
    if plant.parts == DeviceParts::Whole && device.rod >= device.bore {
        let expected = format!("less than bore_m, {} m", plain(device.bore));
        let section = Section::new(document, "cylinder");
        return Err(section.refuse_number("rod_m", device.rod, expected));
    }
    Ok(())
}

/// Rate [Hz] and noise in the order of the channels; infinite for a channel that the rig has no sensor of: it carries no information.
pub(super) fn sensors(
    document: &Document<'_>,
    keys: &RigKeys,
    parts: DeviceParts,
) -> Result<(f64, [f64; 4]), ScenarioError> {
    let mut values = [f64::INFINITY; SENSOR_KEYS.len()];
    let output = parts.output().map(|channel| channel as usize);
    for (index, (value, (dotted, range))) in values.iter_mut().zip(SENSOR_KEYS).enumerate() {
        let (table, key) = split(dotted);
        // The rate must be known, and of a part of the device its output's noise.
        let is_asked = match output {
            None => PLACES[index].is_none(),
            Some(output) => PLACES[index] == Some(output),
        };
        if !is_asked && !keys.sensors.contains_key(key) {
            // A part of the device may have no other sensor; its noise then does not count.
            *value = if output.is_some() { 1.0 } else { *value };
            continue;
        }
        let section = Section::new(document, table);
        let number = find(&section, keys, table, key)?;
        if PLACES[index].is_some() && number.value == 0.0 {
            // Without noise a single reading would outweigh all others.
            let expected = "the standard deviation of its noise, more than 0, as every sensor has; `idc import` prints that of each channel of a log";
            return Err(section.refuse(key, "0".to_owned(), expected.to_owned()));
        }
        *value = exact(&section, key, number, range)?;
    }
    let [rate, noise @ ..] = values;
    if noise.iter().all(|noise| noise.is_infinite()) {
        let section = Section::new(document, "sensors");
        let expected = "the noise of one sensor at least: regulator_pressure_pa, stroke_m, force_n or acceleration_m_per_s2";
        return Err(section.missing("force_n", expected));
    }
    Ok((rate, noise))
}

/// Channel of each sensor's noise; the rate is none.
const PLACES: [Option<usize>; SENSOR_KEYS.len()] = [None, Some(0), Some(1), Some(2), Some(3)];

/// Drift of the pressure sensor, one standard deviation [Pa/s].
pub(super) fn pressure_drift(
    document: &Document<'_>,
    keys: &RigKeys,
) -> Result<f64, ScenarioError> {
    let (dotted, range) = DRIFT;
    let (table, key) = split(dotted);
    let section = Section::new(document, table);
    match keys.sensors.get(key) {
        None => Ok(0.0),
        Some(number) => exact(&section, key, number, range),
    }
}

/// Parts that a rig may share with others, by their keys in `[shares]`: rigs that state the same identity have the same part. Only parts that a family of laws
/// tells apart (`diagnosis::family::scaling`); what is not stated is not assumed.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Shares(BTreeMap<&'static str, String>);

impl Shares {
    /// Identity of a part; none where the file does not state it.
    #[must_use]
    pub fn of(&self, part: &str) -> Option<&str> {
        self.0.get(part).map(String::as_str)
    }
}

/// Identities of the parts that a file states.
pub(super) fn shares(document: &Document<'_>, keys: SharesKeys) -> Result<Shares, ScenarioError> {
    let section = Section::new(document, "shares");
    let mut shares = BTreeMap::new();
    for (key, identity) in [
        ("cylinder", keys.cylinder),
        ("force_sensor", keys.force_sensor),
        ("regulator", keys.regulator),
    ] {
        if let Some(identity) = identity {
            shares.insert(key, section.text(key, &identity)?.trim().to_owned());
        }
    }
    Ok(Shares(shares))
}

/// How far the rig may be moved.
pub(super) fn limits(
    document: &Document<'_>,
    keys: &LimitsKeys,
) -> Result<OperatingLimits, ScenarioError> {
    let section = Section::new(document, "limits");
    if let (Some(least), Some(most)) = (keys.surface_least, keys.surface_most)
        && least > most
    {
        let expected = format!("at least surface_least_m, {least}");
        return Err(section.refuse("surface_most_m", most.to_string(), expected));
    }
    if let (Some(least), Some(most)) = (keys.surface_least, keys.stroke)
        && least > most
    {
        let expected = format!("at least surface_least_m, {least}");
        return Err(section.refuse("stroke_m", most.to_string(), expected));
    }
    Ok(OperatingLimits {
        set_pressure: keys.set_pressure,
        set_pressure_rate: keys.set_pressure_rate,
        surface: [keys.surface_least, keys.surface_most],
        surface_speed: keys.surface_speed,
        surface_acceleration: keys.surface_acceleration,
        solenoid: keys.solenoid,
        without_workpiece: keys.without_workpiece,
        stroke: keys.stroke,
        force: keys.force,
        duration: keys.duration,
        joint_motion: [None; 2],
        joint_torque: None,
    })
}

/// The force commanded of a contact flange before contact, and how it grows to the desired one after it.
#[derive(Debug, Clone)]
pub struct RecordingForceRamp {
    /// Name of the recording, or a pattern with a star.
    pub recording: String,
    /// Force before contact [N].
    pub before: f64,
    /// Time from contact until the desired force is set [s].
    pub time: f64,
}

/// Recordings of a rig.
pub(super) struct Recordings {
    /// Names of those to diagnose from.
    pub fit: Vec<String>,
    /// Name of that to predict.
    pub predict: Option<String>,
    /// Force ramps, by the recordings that have one.
    pub force_ramps: Vec<RecordingForceRamp>,
}

/// Names of the recordings and what is said of them.
pub(super) fn recordings(
    document: &Document<'_>,
    keys: RecordingsKeys,
    parts: DeviceParts,
) -> Result<Recordings, ScenarioError> {
    let section = Section::new(document, "recordings");
    for (index, name) in keys.fit.iter().enumerate() {
        let key = format!("fit[{index}]");
        section.text(&key, name)?;
        if keys.fit[..index].contains(name) {
            let expected = "each recording once".to_owned();
            return Err(section.refuse(&key, format!("{name:?} again"), expected));
        }
    }
    if let Some(name) = &keys.predict {
        section.text("predict", name)?;
    }
    if !keys.force_ramp.is_empty() && parts != DeviceParts::ContactFlange {
        let found = parts.name().to_owned();
        let expected = format!(
            "{:?} of [rig] chain where a recording has a force ramp",
            DeviceParts::ContactFlange.name()
        );
        return Err(section.refuse("force_ramp", found, expected));
    }
    document.hold_ranges(&[("recordings.force_ramp".to_owned(), ForceRampKeys::keys())])?;
    let ramps = keys.force_ramp.iter().enumerate().map(|(index, ramp)| {
        let section = Section::new(document, format!("recordings.force_ramp[{index}]"));
        Ok(RecordingForceRamp {
            recording: section.text("recording", &ramp.recording)?,
            before: ramp.before_contact,
            time: ramp.time,
        })
    });
    Ok(Recordings {
        force_ramps: ramps.collect::<Result<_, _>>()?,
        fit: keys.fit,
        predict: keys.predict,
    })
}
