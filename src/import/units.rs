//! Units as logs name them.
//!
//! ```text
//! SI value = factor * (value + zero)
//! ```
//!
//! Factors of the pound and the inch are exact (NIST SP 811, 2008, app. B.8), the psi from them; normal litres are those of DIN 1343 (0 degrees Celsius,
//! 1.01325 bar), 1.2930 kg of air a cubic metre.

use crate::recording::Unit;

/// A unit of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogUnit {
    /// Its name.
    pub name: &'static str,
    /// The SI unit of the same kind.
    pub si: Unit,
    /// Factor on a value.
    pub factor: f64,
    /// Offset added to a value before.
    pub zero: f64,
}

impl LogUnit {
    /// A value in SI.
    #[must_use]
    pub fn to_si(&self, value: f64) -> f64 {
        self.factor * (value + self.zero)
    }
}

/// Pound, force [N].
const POUND_FORCE: f64 = 4.448_221_615_260_5;
/// Inch [m].
const INCH: f64 = 0.0254;
/// Kilogram, force [N]; standard gravity [m/s2].
const STANDARD_GRAVITY: f64 = 9.806_65;
/// Mass of a normal litre of air [kg].
const NORMAL_LITRE: f64 = 1.293e-3;
/// Radians of a degree.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

const fn unit(name: &'static str, si: Unit, factor: f64) -> LogUnit {
    LogUnit {
        name,
        si,
        factor,
        zero: 0.0,
    }
}

/// All of them, those of a kind together, the SI unit first.
#[rustfmt::skip] // A table: a kind a block.
pub const UNITS: &[LogUnit] = &[
    unit("s", Unit::Second, 1.0), unit("ms", Unit::Second, 1e-3), unit("us", Unit::Second, 1e-6), unit("ns", Unit::Second, 1e-9),
    unit("min", Unit::Second, 60.0), unit("h", Unit::Second, 3600.0),
    unit("m", Unit::Metre, 1.0), unit("mm", Unit::Metre, 1e-3), unit("cm", Unit::Metre, 1e-2), unit("um", Unit::Metre, 1e-6), unit("in", Unit::Metre, INCH),
    unit("m/s", Unit::MetrePerSecond, 1.0), unit("mm/s", Unit::MetrePerSecond, 1e-3), unit("m/min", Unit::MetrePerSecond, 1.0 / 60.0),
    unit("mm/min", Unit::MetrePerSecond, 1e-3 / 60.0), unit("in/s", Unit::MetrePerSecond, INCH),
    unit("m/s2", Unit::MetrePerSecondSquared, 1.0), unit("mm/s2", Unit::MetrePerSecondSquared, 1e-3), unit("g", Unit::MetrePerSecondSquared, STANDARD_GRAVITY),
    unit("N", Unit::Newton, 1.0), unit("kN", Unit::Newton, 1e3), unit("mN", Unit::Newton, 1e-3), unit("lbf", Unit::Newton, POUND_FORCE),
    unit("kgf", Unit::Newton, STANDARD_GRAVITY),
    unit("N m", Unit::NewtonMetre, 1.0), unit("N mm", Unit::NewtonMetre, 1e-3), unit("lbf in", Unit::NewtonMetre, POUND_FORCE * INCH),
    unit("Pa", Unit::Pascal, 1.0), unit("hPa", Unit::Pascal, 1e2), unit("kPa", Unit::Pascal, 1e3), unit("MPa", Unit::Pascal, 1e6), unit("mbar", Unit::Pascal, 1e2),
    unit("bar", Unit::Pascal, 1e5), unit("psi", Unit::Pascal, POUND_FORCE / (INCH * INCH)), unit("atm", Unit::Pascal, 101_325.0),
    unit("kgf/cm2", Unit::Pascal, STANDARD_GRAVITY * 1e4),
    unit("kg", Unit::Kilogram, 1.0),
    unit("kg/s", Unit::KilogramPerSecond, 1.0), unit("g/s", Unit::KilogramPerSecond, 1e-3), unit("Nl/min", Unit::KilogramPerSecond, NORMAL_LITRE / 60.0),
    unit("K", Unit::Kelvin, 1.0), LogUnit { name: "degC", si: Unit::Kelvin, factor: 1.0, zero: 273.15 }, LogUnit { name: "degF", si: Unit::Kelvin, factor: 5.0 / 9.0, zero: 459.67 },
    unit("V", Unit::Volt, 1.0), unit("mV", Unit::Volt, 1e-3),
    unit("rad", Unit::Radian, 1.0), unit("mrad", Unit::Radian, 1e-3), unit("deg", Unit::Radian, DEGREE),
    unit("rad/s", Unit::RadianPerSecond, 1.0), unit("deg/s", Unit::RadianPerSecond, DEGREE), unit("rpm", Unit::RadianPerSecond, std::f64::consts::TAU / 60.0),
    unit("1", Unit::One, 1.0), unit("%", Unit::One, 1e-2),
];

/// The unit of a name, whatever its spaces and the usual other spellings.
#[must_use]
pub fn named(name: &str) -> Option<&'static LogUnit> {
    let plain = |text: &str| -> String { text.chars().filter(|c| !" *.".contains(*c)).collect() };
    let name = plain(name)
        .replace(['µ', 'μ'], "u")
        .replace("²", "2")
        .replace("^2", "2")
        .replace("°", "deg");
    let name = match name.as_str() {
        "sec" => "s",
        "bara" | "barg" => "bar",
        "psia" | "psig" => "psi",
        "r/min" | "1/min" => "rpm",
        other => other,
    };
    UNITS.iter().find(|unit| plain(unit.name) == name)
}

/// Names of the units of a kind.
#[must_use]
pub fn of_kind(si: Unit) -> Vec<&'static str> {
    let kind = UNITS.iter().filter(|unit| unit.si == si);
    kind.map(|unit| unit.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_what_handbooks_say() {
        for (name, value, si) in [
            ("psi", 1.0, 6_894.757_293_168),
            ("psig", 14.5, 99_973.98),
            ("degC", -40.0, 233.15),
            ("degF", -40.0, 233.15),
            ("rpm", 60.0, std::f64::consts::TAU),
            ("lbf in", 1.0, 0.112_984_829),
            ("kgf/cm²", 1.0, 98_066.5),
            ("µm", 7.0, 7e-6),
            ("mm/min", 600.0, 0.01),
        ] {
            let unit = named(name).unwrap();
            assert!((unit.to_si(value) / si - 1.0).abs() < 1e-6, "{name}");
        }
        assert_eq!(named("furlong"), None);
    }

    #[test]
    fn every_unit_is_found_by_its_name_and_no_other_is() {
        for unit in UNITS {
            assert_eq!(named(unit.name), Some(unit));
        }
    }
}
