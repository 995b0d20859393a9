//! Units as logs name them.
//!
//! ```text
//! SI value = factor * (value + zero)
//! ```

use std::sync::LazyLock;

use crate::recording::Unit;
use crate::unit;

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
        self.factor * raised(value, self.zero)
    }
}

/// A value with an offset; without one it stays what it is, the sign of a zero too.
#[must_use]
pub fn raised(value: f64, offset: f64) -> f64 {
    if offset == 0.0 { value } else { value + offset }
}

/// All of them, those of a kind together, the SI unit first.
pub static UNITS: LazyLock<Vec<LogUnit>> = LazyLock::new(|| {
    let of_logs = unit::UNITS.iter().filter(|unit| unit.of_logs);
    let own = |unit: &unit::Unit| {
        Some(LogUnit {
            name: unit.symbol,
            si: Unit::of_symbol(unit.si)?,
            factor: unit.conversion.factor(),
            zero: unit.zero,
        })
    };
    of_logs.filter_map(own).collect()
});

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
        for unit in UNITS.iter() {
            assert_eq!(named(unit.name), Some(unit));
        }
    }
}
