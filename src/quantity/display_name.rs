//! Names and units for people, from keys that end in their unit.

use super::significant;
use crate::unit::{Unit, stem};

/// Suffixes of metrics that no file key has.
const OTHERS: [(&str, &str); 3] = [("_percent", "%"), ("_nl", "Nl"), ("_g", "g")];

fn parts(key: &str) -> (&str, &'static str) {
    OTHERS
        .iter()
        .find_map(|(suffix, symbol)| key.strip_suffix(suffix).map(|stem| (stem, *symbol)))
        .unwrap_or_else(|| (stem(key), Unit::of_key(key).symbol))
}

/// A key in words and its unit, raised as pictures and pages have it: `supply orifice` and `mm²`.
#[must_use]
pub fn display_name(key: &str) -> (String, String) {
    let (stem, unit) = parts(key);
    (stem.replace(['_', '.'], " "), raised(unit))
}

/// Unit of a key; empty for a pure number.
#[must_use]
pub fn symbol(key: &str) -> &'static str {
    parts(key).1
}

/// `impact peak [N]` for `impact_peak_n`.
pub fn axis(key: &str) -> String {
    let (name, unit) = display_name(key);
    if unit.is_empty() {
        name
    } else {
        format!("{name} [{unit}]")
    }
}

/// Powers of a unit as raised digits, for pictures.
pub fn raised(text: &str) -> String {
    let text = text
        .replace("mm2", "mm\u{b2}")
        .replace("cm3", "cm\u{b3}")
        .replace("mm3", "mm\u{b3}");
    text.replace("um", "µm")
}

/// A value of a key with its unit, to five significant digits.
pub fn with_unit(key: &str, value: f64) -> String {
    let value = number(value);
    match symbol(key) {
        "" => value,
        unit => format!("{value} {unit}"),
    }
}

/// A number as people read it: up to five significant digits, without trailing zeros.
#[must_use]
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) {
        significant(rounded, 5)
    } else {
        rounded.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_reads_as_a_name_with_its_unit() {
        for (key, name) in [
            ("impact_peak_n", "impact peak [N]"),
            (
                "coefficient_of_variation_percent",
                "coefficient of variation [%]",
            ),
            ("supply_orifice_mm2", "supply orifice [mm\u{b2}]"),
            (
                "controller.proportional_gain",
                "controller proportional gain",
            ),
            ("hose_length_m", "hose length [m]"),
        ] {
            assert_eq!(axis(key), name);
        }
        assert_eq!(with_unit("impact_peak_n", 399.98765), "399.99 N");
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (40.0, "40"),
            (2.345_617_89, "2.3456"),
            (1.5e5, "150000"),
            (2.5e-7, "2.5·10⁻⁷"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
