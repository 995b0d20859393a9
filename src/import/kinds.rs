//! Kind of a quantity's unit, from the list of signals or from the last word of its name.

use super::map::GAUGE;
use crate::recording::{Unit, schema};

/// Words that a quantity's name ends with, and the units it may then have.
const WORDS: [(&str, &[Unit]); 17] = [
    ("force", &[Unit::Newton]),
    ("friction", &[Unit::Newton, Unit::NewtonMetre]),
    ("torque", &[Unit::NewtonMetre]),
    ("pressure", &[Unit::Pascal]),
    ("stroke", &[Unit::Metre]),
    ("position", &[Unit::Metre, Unit::Radian]),
    ("displacement", &[Unit::Metre, Unit::Radian]),
    ("angle", &[Unit::Radian]),
    ("velocity", &[Unit::MetrePerSecond, Unit::RadianPerSecond]),
    ("speed", &[Unit::MetrePerSecond, Unit::RadianPerSecond]),
    ("feed", &[Unit::MetrePerSecond]),
    ("acceleration", &[Unit::MetrePerSecondSquared]),
    ("flow", &[Unit::KilogramPerSecond]),
    ("mass", &[Unit::Kilogram]),
    ("temperature", &[Unit::Kelvin]),
    ("voltage", &[Unit::Volt]),
    ("current", &[Unit::Ampere]),
];

/// Units that a quantity may have; none where its name implies none.
#[must_use]
pub fn of_quantity(quantity: &str) -> Option<Vec<Unit>> {
    if let Some(signal) = schema::definition(quantity) {
        return Some(vec![signal.unit]);
    }
    if let Some((_, signal)) = schema::parse_joint_quantity(quantity) {
        return Some(vec![signal.unit()]);
    }
    let last = quantity.trim_end_matches(GAUGE).rsplit('_').next()?;
    let row = WORDS.iter().find(|(word, _)| *word == last);
    row.map(|(_, units)| units.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_tells_its_kind_by_its_last_word() {
        for (quantity, units) in [
            ("contact_force", vec![Unit::Newton]),
            ("chamber_pressure_gauge", vec![Unit::Pascal]),
            ("joint_2_position", vec![Unit::Radian]),
            ("reference_position", vec![Unit::Metre, Unit::Radian]),
        ] {
            assert_eq!(of_quantity(quantity), Some(units), "{quantity}");
        }
        assert_eq!(of_quantity("force_ratio"), None);
    }
}
