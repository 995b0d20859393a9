//! Channels and constants of a map: quantity, unit, gain, and against what a pressure is.

use super::keys::{ChannelKeys, ConstantKeys, PressureKey};
use crate::import::kinds;
use crate::import::map::{ChannelMap, Constant, GAUGE, Pressure};
use crate::import::units::{self, LogUnit};
use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::recording::Unit;
use crate::scenario::ScenarioError;

/// A quantity by its name, its unit, and what is added in SI where the two pressures differ [Pa].
fn quantity(
    section: &Section<'_>,
    name: &str,
    unit_name: &str,
    pressure: Option<PressureKey>,
    atmosphere: f64,
) -> Result<(&'static LogUnit, f64), ScenarioError> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name.is_empty() || !name.chars().all(plain) {
        let expected = "a name of small letters, digits and underscores, without a unit".to_owned();
        return Err(section.refuse("quantity", format!("{name:?}"), expected));
    }
    let kinds = kinds::of_quantity(name);
    let unit = unit(section, unit_name, kinds.as_deref())?;
    let gauge = name.ends_with(GAUGE);
    let above = match (unit.si, pressure) {
        (Unit::Pascal, None) => {
            let expected = "\"gauge\" or \"absolute\": what the log holds";
            return Err(section.missing("pressure", expected));
        }
        (Unit::Pascal, Some(PressureKey::Gauge)) if !gauge => atmosphere,
        (Unit::Pascal, Some(PressureKey::Absolute)) if gauge => -atmosphere,
        (Unit::Pascal, Some(_)) | (_, None) => 0.0,
        (_, Some(_)) => {
            let reason = format!("{} is no unit of a pressure", unit.name);
            return Err(section.misplaced("pressure", reason));
        }
    };
    Ok((unit, above))
}

pub(super) fn constant(
    document: &Document<'_>,
    table: String,
    keys: &ConstantKeys,
    atmosphere: f64,
) -> Result<Constant, ScenarioError> {
    let section = Section::new(document, table);
    let (unit, above) = quantity(
        &section,
        &keys.quantity,
        &keys.unit,
        keys.pressure,
        atmosphere,
    )?;
    if keys.value.is_infinite() {
        let expected = "a number, or nan where there is none".to_owned();
        return Err(section.refuse("value", keys.value.to_string(), expected));
    }
    Ok(Constant {
        quantity: keys.quantity.clone(),
        unit: unit.si,
        value: above + unit.to_si(keys.value),
    })
}

pub(super) fn channel_map(
    document: &Document<'_>,
    table: String,
    keys: &ChannelKeys,
    atmosphere: f64,
) -> Result<ChannelMap, ScenarioError> {
    let section = Section::new(document, table);
    let (unit, above) = quantity(
        &section,
        &keys.quantity,
        &keys.unit,
        keys.pressure,
        atmosphere,
    )?;
    Ok(ChannelMap {
        quantity: keys.quantity.clone(),
        column: keys.column.0.clone(),
        joint: keys.joint.clone(),
        frame: keys.frame.clone(),
        unit,
        gain: gain(&section, keys.gain)?,
        offset: keys.offset,
        reversed: keys.reversed,
        pressure: keys.pressure.map(|pressure| match pressure {
            PressureKey::Gauge => Pressure::Gauge,
            PressureKey::Absolute => Pressure::Absolute,
        }),
        above,
    })
}

fn gain(section: &Section<'_>, gain: f64) -> Result<f64, ScenarioError> {
    if gain == 0.0 || !gain.is_finite() {
        let expected = "a number other than 0; `reversed = true` for the other sign".to_owned();
        return Err(section.refuse("gain", gain.to_string(), expected));
    }
    Ok(gain)
}

/// A unit of one of these kinds, or of any.
pub(super) fn unit(
    section: &Section<'_>,
    name: &str,
    kinds: Option<&[Unit]>,
) -> Result<&'static LogUnit, ScenarioError> {
    let known = units::named(name);
    let fits = |unit: &&LogUnit| kinds.is_none_or(|kinds| kinds.contains(&unit.si));
    known.filter(fits).ok_or_else(|| {
        let of_kinds = |kinds: &[Unit]| {
            kinds
                .iter()
                .flat_map(|kind| units::of_kind(*kind))
                .collect()
        };
        let fitting: Vec<&str> = match kinds {
            Some(kinds) => of_kinds(kinds),
            None => units::UNITS.iter().map(|unit| unit.name).collect(),
        };
        let volts = match known {
            Some(unit) if unit.si == Unit::Volt => {
                "; of a sensor in volts the unit is what its `gain` makes of them"
            }
            _ => "",
        };
        let expected = format!("one of {}{volts}", fitting.join(", "));
        section.refuse("unit", format!("{name:?}"), expected)
    })
}
