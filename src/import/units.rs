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

/// Numbers of a unit from `zero` on, which is 1970 where the numbers are stamps.
const fn since(name: &'static str, factor: f64, zero: f64) -> LogUnit {
    LogUnit {
        name,
        si: Unit::Second,
        factor,
        zero,
    }
}

/// Day [s].
const DAY: f64 = 86_400.0;
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
    unit("min", Unit::Second, 60.0), unit("h", Unit::Second, 3600.0), unit("d", Unit::Second, DAY), unit("100ns", Unit::Second, 1e-7),
    since("filetime", 1e-7, -116_444_736e9), since("dotnet_ticks", 1e-7, -621_355_968e9), since("excel_days", DAY, -25_569.0),
    since("excel_microdays", DAY * 1e-6, -25_569e6), since("matlab_days", DAY, -719_529.0), since("labview_s", 1.0, -2_082_844_800.0),
    unit("m", Unit::Metre, 1.0), unit("mm", Unit::Metre, 1e-3), unit("cm", Unit::Metre, 1e-2), unit("um", Unit::Metre, 1e-6), unit("in", Unit::Metre, INCH),
    unit("ft", Unit::Metre, 12.0 * INCH),
    unit("m/s", Unit::MetrePerSecond, 1.0), unit("mm/s", Unit::MetrePerSecond, 1e-3), unit("m/min", Unit::MetrePerSecond, 1.0 / 60.0),
    unit("mm/min", Unit::MetrePerSecond, 1e-3 / 60.0), unit("in/s", Unit::MetrePerSecond, INCH),
    unit("m/s2", Unit::MetrePerSecondSquared, 1.0), unit("mm/s2", Unit::MetrePerSecondSquared, 1e-3), unit("g", Unit::MetrePerSecondSquared, STANDARD_GRAVITY),
    unit("N", Unit::Newton, 1.0), unit("kN", Unit::Newton, 1e3), unit("mN", Unit::Newton, 1e-3), unit("lbf", Unit::Newton, POUND_FORCE),
    unit("kgf", Unit::Newton, STANDARD_GRAVITY), unit("daN", Unit::Newton, 10.0), unit("cN", Unit::Newton, 1e-2), unit("gf", Unit::Newton, STANDARD_GRAVITY * 1e-3),
    unit("N m", Unit::NewtonMetre, 1.0), unit("N mm", Unit::NewtonMetre, 1e-3), unit("lbf in", Unit::NewtonMetre, POUND_FORCE * INCH),
    unit("Pa", Unit::Pascal, 1.0), unit("hPa", Unit::Pascal, 1e2), unit("kPa", Unit::Pascal, 1e3), unit("MPa", Unit::Pascal, 1e6), unit("mbar", Unit::Pascal, 1e2),
    unit("bar", Unit::Pascal, 1e5), unit("psi", Unit::Pascal, POUND_FORCE / (INCH * INCH)), unit("atm", Unit::Pascal, 101_325.0),
    unit("kgf/cm2", Unit::Pascal, STANDARD_GRAVITY * 1e4), unit("mmHg", Unit::Pascal, 133.322_387_415), unit("inHg", Unit::Pascal, 3_386.389),
    unit("torr", Unit::Pascal, 101_325.0 / 760.0),
    unit("kg", Unit::Kilogram, 1.0),
    unit("kg/s", Unit::KilogramPerSecond, 1.0), unit("g/s", Unit::KilogramPerSecond, 1e-3), unit("Nl/min", Unit::KilogramPerSecond, NORMAL_LITRE / 60.0),
    unit("K", Unit::Kelvin, 1.0), LogUnit { name: "degC", si: Unit::Kelvin, factor: 1.0, zero: 273.15 }, LogUnit { name: "degF", si: Unit::Kelvin, factor: 5.0 / 9.0, zero: 459.67 },
    unit("V", Unit::Volt, 1.0), unit("mV", Unit::Volt, 1e-3),
    unit("A", Unit::Ampere, 1.0), unit("mA", Unit::Ampere, 1e-3),
    unit("rad", Unit::Radian, 1.0), unit("mrad", Unit::Radian, 1e-3), unit("deg", Unit::Radian, DEGREE),
    unit("rad/s", Unit::RadianPerSecond, 1.0), unit("deg/s", Unit::RadianPerSecond, DEGREE), unit("rpm", Unit::RadianPerSecond, std::f64::consts::TAU / 60.0),
    unit("1", Unit::One, 1.0), unit("%", Unit::One, 1e-2),
];

/// Other spellings of units, in small letters, and words for them.
#[rustfmt::skip] // A table: a unit a line.
const SPELLINGS: [(&str, &[&str]); 22] = [
    ("s", &["sec", "secs", "second", "seconds", "sek", "sekunde", "sekunden", "secondes", "segundos", "secondi"]),
    ("ms", &["msec", "millisecond", "milliseconds", "millisekunden", "millis"]),
    ("us", &["usec", "microsecond", "microseconds", "mikrosekunden", "micros"]),
    ("ns", &["nsec", "nanosecond", "nanoseconds", "nanos"]),
    ("min", &["minute", "minutes", "minuten"]),
    ("h", &["hour", "hours", "stunden"]),
    ("d", &["day", "days", "tage"]),
    ("100ns", &["100nsec"]),
    ("bar", &["bara", "barg"]),
    ("mbar", &["millibar", "mbara", "mbarg"]),
    ("psi", &["psia", "psig", "lbf/in2"]),
    ("Pa", &["pascal"]),
    ("N", &["newton", "newtons"]),
    ("kgf", &["kp", "kilopond"]),
    ("m", &["meter", "metre", "meters", "metres"]),
    ("mm", &["millimeter", "millimetre", "millimeters", "millimetres"]),
    ("in", &["inch", "inches", "zoll"]),
    ("V", &["volt", "volts"]),
    ("A", &["amp", "amps", "ampere", "amperes"]),
    ("mA", &["milliamp", "milliamps", "milliampere"]),
    ("rpm", &["r/min", "1/min", "u/min"]),
    ("%", &["percent", "prozent"]),
];
/// Letters from which on a unit in other cases can be no other: `MN` may be a meganewton, `Mm` a megametre.
const ANY_CASE: usize = 3;

/// The unit of a name, whatever its spaces and the usual other spellings.
#[must_use]
pub fn named(name: &str) -> Option<&'static LogUnit> {
    let plain = |text: &str| -> String {
        let text = text.chars().filter(|c| !" *.·\u{a0}".contains(*c));
        text.collect()
    };
    let name = plain(name)
        .replace(['µ', 'μ'], "u")
        .replace('²', "2")
        .replace("^2", "2")
        .replace('°', "deg");
    let exact = |name: &str| UNITS.iter().find(|unit| plain(unit.name) == name);
    if let Some(unit) = exact(&name) {
        return Some(unit);
    }
    let lower = name.to_lowercase();
    let spelled = SPELLINGS
        .iter()
        .find(|(_, others)| others.contains(&lower.as_str()));
    if let Some((name, _)) = spelled {
        return exact(name);
    }
    if name.chars().count() < ANY_CASE {
        return None;
    }
    let mut alike = UNITS
        .iter()
        .filter(|unit| plain(unit.name).to_lowercase() == lower);
    let first = alike.next();
    first.filter(|_| alike.next().is_none())
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
            ("KPA", 1.0, 1e3),
            ("PSI", 14.5, 99_973.98),
            ("daN", 3.0, 30.0),
            ("mA", 20.0, 0.02),
            ("mmHg", 760.0, 101_325.0),
            // 18 January 2024, 09:10:00 UTC, as `date -u -d` says.
            ("filetime", 133_500_426_000_000_000.0, 1_705_569_000.0),
            ("dotnet_ticks", 638_411_658_000_000_000.0, 1_705_569_000.0),
            (
                "excel_days",
                45_309.0 + 33_000.0 / 86_400.0,
                1_705_569_000.0,
            ),
            (
                "matlab_days",
                739_269.0 + 33_000.0 / 86_400.0,
                1_705_569_000.0,
            ),
            ("labview_s", 3_788_413_800.0, 1_705_569_000.0),
        ] {
            let unit = named(name).unwrap();
            assert!((unit.to_si(value) / si - 1.0).abs() < 1e-6, "{name}");
        }
        // Mega or milli?
        for name in ["furlong", "MN", "Mm", "mpas"] {
            assert_eq!(named(name), None, "{name}");
        }
    }

    #[test]
    fn every_unit_is_found_by_its_name_and_no_other_is() {
        for unit in UNITS {
            assert_eq!(named(unit.name), Some(unit));
        }
    }
}
