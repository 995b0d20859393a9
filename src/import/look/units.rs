//! Units of columns: as a name or a row of units says them, or as their range looks.

use super::names;
use super::seen::{Because, SaidUnit};
use crate::import::doubts::unit_of_name;
use crate::import::map::Pressure;
use crate::import::units::{self, LogUnit};
use crate::recording::Unit;

/// Atmosphere, and how far from it or from nothing a pressure at rest may be [Pa].
const ATMOSPHERE: f64 = 101_325.0;
const NEAR: f64 = 1.2e4;
/// Share of the samples that are at rest where any are.
const REST: f64 = 0.01;

/// Least and largest size, and the unit in which it is usual.
type Usual = (f64, f64, &'static str);

/// Ranges of the largest size of numbers and the unit in which they are usual; a gap is where two are.
#[rustfmt::skip] // A table: a kind a line.
const BY_SIZE: [(Unit, &[Usual]); 5] = [
    // Compressed air of a workshop: 1 to 16 bar.
    (Unit::Pascal, &[(1.3, 16.0, "bar"), (150.0, 1.6e3, "kPa"), (2e4, 2e6, "Pa")]),
    (Unit::Metre, &[(1e-3, 0.6, "m"), (2.0, 1.5e3, "mm"), (2e3, 1.5e6, "um")]),
    (Unit::Newton, &[(3.0, 2e4, "N")]),
    (Unit::MetrePerSecondSquared, &[(6.0, 1e3, "m/s2")]),
    (Unit::One, &[(0.0, 1.0, "1")]),
];

/// The unit that a name says, with against what, where it says that.
pub(super) fn of_name(name: &str) -> Option<SaidUnit> {
    let bracketed = [('[', ']'), ('(', ')'), ('{', '}')]
        .into_iter()
        .find_map(|(open, close)| {
            let (_, rest) = name.rsplit_once(open)?;
            let (inside, after) = rest.split_once(close)?;
            // `bar(g)` is a unit with a bracket of its own.
            let own = name.trim_end();
            let short = inside.len() <= 3 && pressure_of(inside).is_some() && after.is_empty();
            if short && let Some(before) = own.rsplit([' ', '_', '[']).next() {
                return of_text(before.trim_end_matches(']'));
            }
            of_text(inside)
        });
    let behind = || {
        [" in ", "/", ",", ";", ":"]
            .iter()
            .find_map(|mark| of_text(name.rsplit_once(mark)?.1))
    };
    let found = bracketed.or_else(|| {
        let unit = unit_of_name(name).or_else(|| of_small_letters(name));
        unit.map(|unit| (unit, None)).or_else(behind)
    });
    let (unit, pressure) = found?;
    let said = pressure.or_else(|| pressure_of_name(name));
    Some(SaidUnit {
        unit,
        pressure: said.filter(|_| unit.si == Unit::Pascal),
        because: Because::certain(format!("its name says {}", unit.name)),
    })
}

/// What stands in the brackets at the end of a name where a unit does, if it is one that nobody here knows.
pub(super) fn odd_unit(name: &str) -> Option<String> {
    const LONGEST: usize = 8;
    let name = name.trim();
    let (open, inside) =
        [('[', ']'), ('(', ')'), ('{', '}')]
            .into_iter()
            .find_map(|(open, close)| {
                let (_, inside) = name.strip_suffix(close)?.rsplit_once(open)?;
                Some((open, inside.trim()))
            })?;
    let is_unit = inside.chars().any(char::is_alphabetic)
        && inside.chars().count() <= LONGEST
        && !inside.contains(' ')
        && !inside.starts_with(|c: char| c.is_ascii_digit());
    // Round brackets hold remarks as often: (ist), (X), (abs).
    let is_remark = pressure_of(inside).is_some()
        || ["bool", "bit", "none", "raw"].contains(&inside.to_lowercase().as_str())
        || (open == '(' && names::said(inside).thing.is_some())
        || !names::said(inside).roles.is_empty();
    (is_unit && !is_remark && of_name(name).is_none()).then(|| inside.to_owned())
}

/// The unit that a name ends with in small letters, `force_n`, where it is one of the quantity that the name says.
fn of_small_letters(name: &str) -> Option<&'static LogUnit> {
    let (_, last) = name.rsplit_once('_')?;
    let (thing, _) = names::said(name).thing?;
    let mut fitting = units::UNITS
        .iter()
        .filter(|unit| names::units_of(thing).contains(&unit.si));
    fitting.find(|unit| unit.name.eq_ignore_ascii_case(last))
}

/// The unit of a cell in a row of units.
pub(super) fn of_cell(cell: &str) -> Option<SaidUnit> {
    let inside = cell.trim().trim_matches(|c| "[](){}".contains(c));
    let (unit, pressure) = of_text(inside).or_else(|| of_text(cell))?;
    Some(SaidUnit {
        unit,
        pressure,
        because: Because::certain(format!("the line of units says {}", unit.name)),
    })
}

/// A unit as written, with a suffix that says against what.
fn of_text(text: &str) -> Option<(&'static LogUnit, Option<Pressure>)> {
    let text = text.trim();
    // `barg`, `kPaa`: a unit of pressure and a letter.
    let suffixed = [('g', Pressure::Gauge), ('a', Pressure::Absolute)]
        .into_iter()
        .find_map(|(letter, kind)| {
            let unit = units::named(text.strip_suffix(letter)?)?;
            (unit.si == Unit::Pascal).then_some((unit, Some(kind)))
        });
    if suffixed.is_some() {
        return suffixed;
    }
    if let Some(unit) = units::named(text) {
        return Some((unit, None));
    }
    // `V (Voltage)`.
    if let Some((head, _)) = text.split_once(" (")
        && let Some(unit) = units::named(head).filter(|unit| unit.si != Unit::Pascal)
    {
        return Some((unit, None));
    }
    // `bar(g)`, `bar_abs`, `mbar rel`, `barÜ`.
    let end = text.find(|c: char| "( _-".contains(c) || c == 'ü' || c == 'Ü')?;
    let unit = units::named(&text[..end]).filter(|unit| unit.si == Unit::Pascal)?;
    Some((unit, Some(pressure_of(&text[end..])?)))
}

/// Gauge or absolute, as a suffix says.
fn pressure_of(text: &str) -> Option<Pressure> {
    let plain: String = text.chars().filter(|c| c.is_alphabetic()).collect();
    match plain.to_lowercase().as_str() {
        "g" | "gauge" | "rel" | "relative" | "ü" | "ue" | "r" => Some(Pressure::Gauge),
        "a" | "abs" | "absolute" | "absolut" => Some(Pressure::Absolute),
        _ => None,
    }
}

fn pressure_of_name(name: &str) -> Option<Pressure> {
    let words = name.split(|c: char| !c.is_alphabetic());
    words.filter(|word| word.len() > 2).find_map(|word| {
        if let Some((_, Some(pressure))) = of_text(word) {
            return Some(pressure);
        }
        let lower = word.to_lowercase();
        if lower.contains("überdruck") || lower.contains("ueberdruck") {
            return Some(Pressure::Gauge);
        }
        pressure_of(&lower)
    })
}

/// A unit by the size of the numbers, with the one that it must be of these kinds.
pub(super) fn by_size(kind: Unit, [low, high]: [f64; 2]) -> Option<(&'static LogUnit, Because)> {
    let (_, ranges) = BY_SIZE.iter().find(|(of, _)| *of == kind)?;
    let peak = low.abs().max(high.abs());
    let (.., name) = ranges
        .iter()
        .find(|(least, most, _)| (*least..=*most).contains(&peak))?;
    let range = format!("{} to {}", shown(low), shown(high));
    Some((
        units::named(name)?,
        Because::likely(format!("nothing says it; {range} is usual in {name}")),
    ))
}

/// Units in which a size would be usual, for the user to choose from.
pub(super) fn choices(kind: Unit) -> String {
    units::of_kind(kind)
        .iter()
        .map(|name| format!("\"{name}\""))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Against what a pressure is, by where it rests.
pub(super) fn by_rest(values: &[f64], unit: &LogUnit) -> Option<(Pressure, Because)> {
    let mut there: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    if there.is_empty() {
        return None;
    }
    there.sort_by(f64::total_cmp);
    let written = there[(REST * there.len() as f64) as usize];
    let rest = unit.to_si(written);
    let says = |what: &str| {
        Because::likely(format!(
            "it rests at {} {}, {what}",
            shown(written),
            unit.name
        ))
    };
    if rest.abs() < NEAR {
        return Some((Pressure::Gauge, says("no pressure above the atmosphere")));
    }
    ((rest - ATMOSPHERE).abs() < NEAR).then(|| (Pressure::Absolute, says("an atmosphere")))
}

/// A number to three digits.
pub(super) fn shown(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = 2 - value.abs().log10().floor() as i32;
    if (-4..=6).contains(&digits) {
        let text = format!("{value:.*}", usize::try_from(digits.max(0)).unwrap_or(0));
        return match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        };
    }
    format!("{value:.2e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_rows_of_units_say_units_and_kinds_of_pressure() {
        use Pressure::{Absolute, Gauge};
        for (name, unit, pressure) in [
            ("Solldruck [bar]", "bar", None),
            ("p (barg)", "bar", Some(Gauge)),
            ("p [bar(g)]", "bar", Some(Gauge)),
            ("Druck [barÜ]", "bar", Some(Gauge)),
            ("p_abs [mbar]", "mbar", Some(Absolute)),
            ("Druck in bara", "bar", Some(Absolute)),
            ("pressure_kPa", "kPa", None),
            ("Weg / mm", "mm", None),
            ("set_pressure_pa", "Pa", None),
            ("force_n", "N", None),
            ("Beschleunigung [m/s²]", "m/s2", None),
            ("Zeit  1 - default sample rate [s]", "s", None),
            ("Oberfläche [µm]", "um", None),
            ("p [kPag]", "kPa", Some(Gauge)),
            ("p [kpa]", "kPa", None),
            ("p [MPaa]", "MPa", Some(Absolute)),
            ("Strom [mA]", "mA", None),
            ("F [daN]", "daN", None),
            ("t [Sekunden]", "s", None),
        ] {
            let said = of_name(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((said.unit.name, said.pressure), (unit, pressure), "{name}");
        }
        assert_eq!(of_cell("[bar]").unwrap().unit.name, "bar");
        assert_eq!(of_name("Ventil"), None);
        assert_eq!(odd_unit("F [ozf]").as_deref(), Some("ozf"));
        for name in [
            "F [N]",
            "F (ist)",
            "p [abs]",
            "Ventil [-]",
            "F",
            "x [1]",
            "flag [bool]",
        ] {
            assert_eq!(odd_unit(name), None, "{name}");
        }
        // A port of a valve, an instrument.
        for name in ["Druck_A", "flow_meter", "piston_second"] {
            assert_eq!(of_name(name), None, "{name}");
        }
        assert_eq!(of_name("F_ist"), None);
    }

    #[test]
    fn sizes_tell_units_where_one_alone_is_usual() {
        let of = |kind, low, high| by_size(kind, [low, high]).map(|(unit, _)| unit.name);
        assert_eq!(of(Unit::Pascal, 0.0, 6.3), Some("bar"));
        // 0.63 MPa, or 0.63 bar?
        assert_eq!(of(Unit::Pascal, 0.0, 0.63), None);
        assert_eq!(of(Unit::Pascal, 0.0, 3.1e5), Some("Pa"));
        assert_eq!(of(Unit::Metre, 0.0, 48.0), Some("mm"));
        assert_eq!(of(Unit::Metre, 0.0, 0.048), Some("m"));
        let (kind, why) = by_rest(&[1.01, 1.02, 3.0, 4.0], units::named("bar").unwrap()).unwrap();
        assert_eq!(kind, Pressure::Absolute);
        assert_eq!(
            why.to_string(),
            "likely: it rests at 1.01 bar, an atmosphere"
        );
        assert_eq!(by_rest(&[2.5, 3.0], units::named("bar").unwrap()), None);
    }
}
