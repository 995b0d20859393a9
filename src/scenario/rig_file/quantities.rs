//! The numbers of a rig file: where each stands in the rig's description, and the range in which it is plausible as SI.

use crate::keys::check::plain;
use crate::plant::{DeviceParts, Number, registry};
use crate::unit::Unit;

/// The numbers of the rig, in the order of the format; each stands under its dotted name.
pub(super) static NUMBERS: [&Number; 21] = [
    &registry::CYLINDER_COUNT,
    &registry::BORE,
    &registry::ROD,
    &registry::STROKE,
    &registry::DEAD_VOLUME,
    &registry::MOVING_MASS,
    &registry::GRAVITY,
    &registry::END_STOP_STIFFNESS,
    &registry::END_STOP_DAMPING,
    &registry::REGULATOR_GAIN,
    &registry::REGULATOR_TIME_CONSTANT,
    &registry::SUPPLY_ORIFICE,
    &registry::EXHAUST_ORIFICE,
    &registry::DISCHARGE_COEFFICIENT,
    &registry::GAS_CONSTANT,
    &registry::HEAT_CAPACITY_RATIO,
    &registry::TEMPERATURE,
    &registry::ATMOSPHERE,
    &registry::CONTACT_STIFFNESS,
    &registry::CONTACT_DAMPING,
    &registry::SPINDLE_FREQUENCY,
];

/// Keys of `[sensors]` with their plausible ranges: the rate, then the channels' noise in the order of `plant::CHANNELS`.
pub(super) const SENSOR_KEYS: [(&str, [f64; 2]); 5] = [
    ("sensors.rate_hz", [10.0, 20e3]),
    ("sensors.regulator_pressure_pa", [1.0, 1e5]),
    ("sensors.stroke_m", [1e-8, 5e-3]),
    ("sensors.force_n", [1e-4, 1e3]),
    ("sensors.acceleration_m_per_s2", [1e-4, 100.0]),
];

/// Drift of the pressure sensor, one standard deviation, which is reported of parts of the device alone: its key with its plausible range.
pub(super) const DRIFT: (&str, [f64; 2]) =
    ("sensors.regulator_pressure_drift_pa_per_s", [0.0, 1e4]);

/// Numbers that a rig with a part of the device must have; for the whole of it all but the turns of the tool.
pub(super) fn needs(parts: DeviceParts, key: &str) -> bool {
    match parts {
        DeviceParts::Whole => key != registry::SPINDLE_FREQUENCY.name,
        DeviceParts::MovedPiston => ["cylinder.count", "cylinder.bore_m"].contains(&key),
        DeviceParts::DrivenSlide => key == "cylinder.moving_mass_kg",
        DeviceParts::ClosedChamber => false,
        DeviceParts::ContactFlange => {
            ["cylinder.moving_mass_kg", "regulator.time_constant_s"].contains(&key)
        }
        DeviceParts::Regulator => ["regulator.gain", "regulator.time_constant_s"].contains(&key),
    }
}

/// A number of a rig file, as its schema and its template have it.
pub(in super::super) struct Described {
    pub table: &'static str,
    pub key: &'static str,
    /// Its meaning, with its unit and its range.
    pub text: String,
    /// Least and largest plausible value.
    pub range: [f64; 2],
}

/// Every number of a rig file.
pub(in super::super) fn described_numbers() -> impl Iterator<Item = Described> {
    let numbers = NUMBERS.map(|number| (number.name, number.meaning, number.range));
    let others = SENSOR_KEYS.into_iter().chain([DRIFT]);
    let others = others.map(|(dotted, range)| (dotted, "", range));
    numbers
        .into_iter()
        .chain(others)
        .map(|(dotted, meaning, range)| {
            let (table, key) = split(dotted);
            let symbol = match Unit::of_key(key) {
                unit if unit.is_one() => "1",
                unit => unit.symbol,
            };
            let [low, high] = range.map(plain);
            let text = format!("{meaning} [{symbol}] ({low} to {high})");
            Described {
                table,
                key,
                text: text.trim_start().to_owned(),
                range,
            }
        })
}

/// Table and key of a dotted key.
pub(super) fn split(dotted: &'static str) -> (&'static str, &'static str) {
    dotted
        .split_once('.')
        .expect("every number of the rig stands in a table")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file that `idc new rig` begins with.
    const TEMPLATE: &str = include_str!("../../../assets/new/rig.toml");

    #[test]
    fn the_file_to_start_from_has_every_number_with_what_it_is_its_unit_and_range() {
        for Described {
            table, key, text, ..
        } in described_numbers()
        {
            let (_, below) = TEMPLATE.split_once(&format!("\n[{table}]\n")).unwrap();
            let mut lines = below.lines().take_while(|line| !line.starts_with('['));
            match lines.find(|line| line.starts_with(&format!("{key} "))) {
                Some(line) => assert!(line.ends_with(&format!(" # {text}")), "{line}\n{text}"),
                None => assert_eq!((table, key), split(DRIFT.0)),
            }
        }
    }
}
