//! Numbers, units and lines as people read them.

pub use crate::quantity::{capital, listed, percent};

use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::plant::{CHANNELS, Channel};
use crate::quantity::significant;

/// A unit for people: suffix of a name in SI, unit, and what a value in SI is multiplied by.
type DisplayUnit = (&'static str, &'static str, f64);

/// Units by the end of a name, longer ends first.
#[rustfmt::skip] // A table: one unit a line.
const UNITS: [DisplayUnit; 38] = [
    ("_1_per_pa_s", "1/(bar s)", 1e5),
    ("_1_per_pa", "1/bar", 1e5),
    ("_1_per_s", "1/s", 1.0),
    ("_1_per_m", "1/m", 1.0),
    ("_1", "", 1.0),
    ("_j_per_kg_k", "J/(kg K)", 1.0),
    ("_pa_s_per_kg", "bar s/kg", 1e-5),
    ("_n_s_per_m", "N s/m", 1.0),
    ("_n_per_m15", "N/mm^1.5", 3.162_277_660_168_379e-5),
    ("_m_per_s2", "m/s2", 1.0),
    ("_n_m_s_per_rad", "N m s/rad", 1.0),
    ("_n_m_per_rad", "N m/rad", 1.0),
    ("_n_m_per_a", "N m/A", 1.0),
    ("_kg_m2", "kg m2", 1.0),
    ("_n_m", "N m", 1.0),
    ("_m_per_m", "mm/m", 1e3),
    ("_rad_per_s", "rad/s", 1.0),
    ("_kg_per_s", "g/s", 1e3),
    ("_pa_per_s", "bar/s", 1e-5),
    ("_n_per_pa", "N/bar", 1e5),
    ("_n_per_m", "N/mm", 1e-3),
    ("_n_per_s", "N/s", 1.0),
    ("_w_per_k", "W/K", 1.0),
    ("_m_per_s", "mm/s", 1e3),
    ("_rad", "mrad", 1e3),
    ("_m2", "mm2", 1e6),
    ("_m3", "cm3", 1e6),
    ("_pa", "bar", 1e-5),
    ("_kg", "kg", 1.0),
    ("_hz", "Hz", 1.0),
    ("_n", "N", 1.0),
    ("_a", "A", 1.0),
    ("_m", "mm", 1e3),
    ("_s", "ms", 1e3),
    ("_k", "K", 1.0),
    ("_j", "J", 1.0),
    ("_w", "W", 1.0),
    ("", "", 1.0),
];

/// Unit of each channel and what a value in SI is multiplied by.
pub const CHANNEL_UNITS: [(&str, f64); CHANNELS.len()] =
    [("mbar", 1e-2), ("mm", 1e3), ("N", 1.0), ("m/s2", 1.0)];

/// The channels.
pub const CHANNEL_WORDS: [&str; CHANNELS.len()] =
    ["regulator's pressure", "stroke", "force", "acceleration"];

/// A name without its unit and its table, in words, with the unit and the factor that a value in SI is multiplied by.
#[must_use]
pub fn display_name(name: &str) -> (String, &'static str, f64) {
    let (suffix, unit, factor) = UNITS
        .into_iter()
        .find(|(suffix, ..)| name.ends_with(suffix))
        .unwrap_or(UNITS[UNITS.len() - 1]);
    let stem = name.strip_suffix(suffix).unwrap_or(name);
    let stem = stem.rsplit('.').next().unwrap_or(stem);
    (stem.replace('_', " "), unit, factor)
}

/// A value with its interval, to two digits of the interval's half-width, in its unit: `13.2 N (12.8 to 13.6)`.
#[must_use]
pub fn with_interval(value: f64, [low, high]: [f64; 2], unit: &str) -> String {
    interval([value, low, high], unit, significant)
}

/// The same of a number in SI, which may be far from 1: `1.216e-6 m^2 (1.201e-6 to 1.231e-6)`.
#[must_use]
pub fn with_interval_in_si(value: f64, [low, high]: [f64; 2], unit: &str) -> String {
    interval([value, low, high], unit, in_si)
}

/// A number in SI, rounded to so many significant digits: with a power of ten where it is far from 1.
#[must_use]
pub fn in_si(value: f64, digits: usize) -> String {
    match value == 0.0 || (1e-2..1e6).contains(&value.abs()) {
        true => significant(value, digits),
        false => format!("{value:.*e}", digits.saturating_sub(1)),
    }
}

fn interval(
    [value, low, high]: [f64; 3],
    unit: &str,
    written: impl Fn(f64, usize) -> String,
) -> String {
    let half = 0.5 * (high - low);
    let digits = |number: f64| {
        let orders = number.abs().log10().floor() - half.log10().floor();
        let digits = if orders.is_finite() {
            orders + 2.0
        } else {
            3.0
        };
        written(number, digits.clamp(2.0, 5.0) as usize)
    };
    let (value, low, high) = (digits(value), digits(low), digits(high));
    if unit.is_empty() {
        format!("{value} ({low} to {high})")
    } else {
        format!("{value} {unit} ({low} to {high})")
    }
}

/// A size of a channel in its unit, to two digits.
#[must_use]
pub fn in_unit(channel: Channel, size: f64) -> String {
    let (unit, factor) = CHANNEL_UNITS[channel as usize];
    format!("{} {unit}", significant(size * factor, 2))
}

/// Scale of departures: where no law explains all of them, that is more than noise.
#[must_use]
pub fn reference_noise(something_remains: bool) -> &'static str {
    if something_remains {
        "what no law explains"
    } else {
        "the sensor's noise"
    }
}

/// A channel's column, or another quantity, in words, with its unit and the factor that a value in SI is multiplied by.
#[must_use]
pub fn of_column(column: &str) -> (String, &'static str, f64) {
    match COLUMNS.iter().position(|own| *own == column) {
        Some(index) => {
            let (unit, factor) = CHANNEL_UNITS[index];
            (CHANNEL_WORDS[index].to_owned(), unit, factor)
        }
        None => display_name(column),
    }
}

/// Odds from their power of ten, against what they are compared with: `1 to 6.9`, `below 1 to 10^6`.
#[must_use]
pub fn odds(log10: f64) -> String {
    /// Power of ten from which the number itself says no more.
    const LARGE: f64 = 6.0;
    match -log10 {
        power if power >= LARGE => format!("below 1 to 10^{LARGE:.0}"),
        // What was fitted roughly alone may be ahead of what was fitted in full.
        power if power <= -LARGE => format!("above 10^{LARGE:.0} to 1"),
        power if power < -0.05 => format!("{} to 1", significant(10f64.powf(-power), 2)),
        power => format!("1 to {}", significant(10f64.powf(power), 2)),
    }
}

/// A text that begins with a small letter.
#[must_use]
pub fn lower(text: &str) -> String {
    changed(text, |c| c.to_lowercase().collect())
}

fn changed(text: &str, change: fn(char) -> String) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| change(first) + letters.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_in_si_keeps_its_digits_however_small() {
        let leak = with_interval_in_si(1.2157e-6, [1.201e-6, 1.231e-6], "m^2");
        assert_eq!(leak, "1.216e-6 m^2 (1.201e-6 to 1.231e-6)");
        let drag = with_interval_in_si(-266.19, [-268.8, -263.5], "N s/m");
        assert_eq!(drag, "-266.2 N s/m (-268.8 to -263.5)");
        assert_eq!(in_si(0.0, 3), "0");
    }

    #[test]
    fn names_lose_their_unit_and_values_get_one_that_people_use() {
        let said = |name: &str| {
            let (words, unit, factor) = display_name(name);
            (words, unit, factor)
        };
        assert_eq!(
            said("coulomb_force_n"),
            ("coulomb force".to_owned(), "N", 1.0)
        );
        assert_eq!(
            said("stribeck_velocity_m_per_s"),
            ("stribeck velocity".to_owned(), "mm/s", 1e3)
        );
        assert_eq!(
            said("half_width_pa"),
            ("half width".to_owned(), "bar", 1e-5)
        );
        assert_eq!(said("gain"), ("gain".to_owned(), "", 1.0));
        assert_eq!(
            said("cylinder.moving_mass_kg"),
            ("moving mass".to_owned(), "kg", 1.0)
        );
        // A joint's friction was once reported in millimetres.
        assert_eq!(said("friction_n_m"), ("friction".to_owned(), "N m", 1.0));
        // 1 N/m^1.5 over 1000^1.5 mm^1.5.
        assert!((said("stiffness_n_per_m15").2 * 1000f64.powf(1.5) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn numbers_have_as_many_digits_as_are_known() {
        assert_eq!(
            with_interval(13.2143, [12.81, 13.62], "N"),
            "13.21 N (12.81 to 13.62)"
        );
        assert_eq!(
            with_interval(90.2, [70.0, 112.0], "N s/m"),
            "90 N s/m (70 to 112)"
        );
        assert_eq!(with_interval(1.0, [1.0, 1.0], ""), "1.00 (1.00 to 1.00)");
    }
}
