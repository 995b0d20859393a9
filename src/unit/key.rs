//! Units of the numbers in a file: a key's suffix says its unit.

use std::ops::RangeInclusive;

use super::Conversion::{Divide, Multiply};
use super::{UNITS, Unit};

impl Unit {
    /// Unit that a key carries, by the longest suffix that it ends with; the pure number if it carries none.
    pub fn of_key(key: &str) -> Self {
        let stem = |unit: &Self| key.strip_suffix(unit.suffix)?.strip_suffix('_');
        let carried = UNITS
            .iter()
            .filter(|unit| unit.of_keys && stem(unit).is_some());
        let longest = carried.max_by_key(|unit| unit.suffix.len());
        let one = || UNITS.iter().find(|unit| unit.of_keys && unit.is_one());
        *longest.or_else(one).expect("the table has the pure number")
    }

    /// A value under a key as it is under the key of another unit of the same quantity, in SI; none if they differ in more than the unit.
    pub fn convert(from: &str, value: f64, to: &str) -> Option<f64> {
        let (own, other) = (Self::of_key(from), Self::of_key(to));
        (stem(from) == stem(to) && own.si == other.si).then(|| own.to_si(value))
    }

    /// Whether it is the pure number.
    pub fn is_one(self) -> bool {
        self.suffix.is_empty()
    }

    /// A value in this unit, in SI.
    pub fn to_si(self, value: f64) -> f64 {
        match self.conversion {
            Divide(divisor) => value / divisor,
            Multiply(factor) => value * factor,
        }
    }

    /// A value in SI, in this unit, to twelve digits: the decimals that were meant.
    pub fn of_si(self, value: f64) -> f64 {
        let own = match self.conversion {
            Divide(divisor) => value * divisor,
            Multiply(factor) => value / factor,
        };
        format!("{own:.11e}").parse().unwrap_or(own)
    }

    /// A range in SI, in this unit.
    pub fn range(self, range: [f64; 2]) -> RangeInclusive<f64> {
        let [low, high] = range.map(|value| self.of_si(value));
        low..=high
    }

    /// A range in this unit, for people.
    pub fn show_range(self, range: RangeInclusive<f64>) -> String {
        if range.end().is_finite() {
            format!("{} to {}", digits(*range.start()), self.show(*range.end()))
        } else {
            format!("at least {}", self.show(*range.start()))
        }
    }

    /// The value with its symbol.
    pub fn show(self, value: f64) -> String {
        if self.is_one() {
            digits(value)
        } else {
            format!("{} {}", digits(value), self.symbol)
        }
    }
}

/// The digits of a number, but for one of hundreds of them.
fn digits(value: f64) -> String {
    match value.abs() {
        size if size >= 1e15 || (0.0 < size && size < 1e-9) => format!("{value:e}"),
        _ => value.to_string(),
    }
}

/// Units that people give in place of an SI unit, by its symbol, each with its size in it.
const LOOK_ALIKES: [(&str, &[(&str, f64)]); 8] = [
    (
        "Pa",
        &[("bar", 1e5), ("kPa", 1e3), ("MPa", 1e6), ("psi", 6894.76)],
    ),
    ("m", &[("mm", 1e-3), ("cm", 1e-2), ("um", 1e-6)]),
    ("m2", &[("mm2", 1e-6), ("cm2", 1e-4)]),
    ("m3", &[("cm3", 1e-6), ("l", 1e-3), ("mm3", 1e-9)]),
    ("kg", &[("g", 1e-3)]),
    ("s", &[("ms", 1e-3)]),
    ("N", &[("kN", 1e3), ("mN", 1e-3)]),
    ("N/m", &[("N/mm", 1e3)]),
];

/// The unit in which a value was probably given, when it is implausible [its key's SI unit] and would lie in a range [SI] in that one.
pub(crate) fn look_alike(symbol: &str, value: f64, range: [f64; 2]) -> Option<&'static str> {
    let plausible = |si: f64| range[0] <= si && si <= range[1];
    if symbol == "K" && plausible(value + 273.15) {
        return Some("degrees Celsius");
    }
    let (_, others) = LOOK_ALIKES.iter().find(|(si, _)| *si == symbol)?;
    let (other, _) = others.iter().find(|(_, size)| plausible(value * size))?;
    Some(other)
}

/// A key without its unit: `feed` for `feed_mm_per_s`.
pub(crate) fn stem(key: &str) -> &str {
    let stem = key.strip_suffix(Unit::of_key(key).suffix);
    stem.map_or(key, |stem| stem.strip_suffix('_').unwrap_or(stem))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_number_of_hundreds_of_digits_is_shown_by_its_power() {
        let unit = Unit::of_key("force_n");
        assert_eq!(unit.show(1e300), "1e300 N");
        assert_eq!(unit.show(-2.5e-300), "-2.5e-300 N");
        assert_eq!(unit.show(0.0001), "0.0001 N");
        assert_eq!(unit.show(250_000_000.0), "250000000 N");
        assert_eq!(unit.show_range(0.0..=1e-12), "0 to 1e-12 N");
    }

    #[test]
    fn the_suffix_says_the_unit_and_the_number_is_the_si_literal() {
        for (key, value, symbol, si) in [
            ("bore_mm", 32.0, "mm", 0.032),
            ("feed_mm_per_s", 20.0, "mm/s", 0.02),
            ("acceleration_mm_per_s2", 500.0, "mm/s2", 0.5),
            ("jerk_mm_per_s3", 5000.0, "mm/s3", 5.0),
            ("supply_orifice_mm2", 2.5, "mm2", 2.5e-6),
            ("dead_volume_cm3", 20.0, "cm3", 2e-5),
            ("supply_pressure_bar_gauge", 6.0, "bar gauge", 6e5),
            (
                "atmosphere_pa_absolute",
                101_325.0,
                "Pa absolute",
                101_325.0,
            ),
            ("rotation_deg", 180.0, "deg", PI),
            ("velocity_deg_per_s", 90.0, "deg/s", PI / 2.0),
            ("dead_time_ms", 20.0, "ms", 0.02),
            ("settle_time_s", 1.5, "s", 1.5),
            ("damping_n_s_per_m", 400.0, "N s/m", 400.0),
            ("stiffness_n_per_m", 1.5e5, "N/m", 1.5e5),
            ("effort_n_m", 56.0, "N m", 56.0),
            ("force_n", 150.0, "N", 150.0),
            ("natural_frequency_hz", 40.0, "Hz", 40.0),
            ("moving_mass_kg", 4.0, "kg", 4.0),
            ("gas_temperature_k", 293.15, "K", 293.15),
            ("gas_constant_j_per_kg_k", 287.05, "J/(kg K)", 287.05),
            ("gravity_m_per_s2", -9.81, "m/s2", -9.81),
            ("rated_output_mv_per_v", 2.0, "mV/V", 2e-3),
            ("resistance_ohm", 1e4, "ohm", 1e4),
            ("capacitance_uf", 10.0, "uF", 1e-5),
            ("standard_deviation_pa", 600.0, "Pa", 600.0),
            ("seal_presliding_displacement_um", 50.0, "um", 5e-5),
            ("wall_conductance_w_per_k", 0.5, "W/K", 0.5),
            ("hose_resistance_pa_s_per_kg", 2e7, "Pa s/kg", 2e7),
            ("regulator_natural_frequency_rad_per_s", 30.0, "rad/s", 30.0),
            ("joint_acceleration_rad_per_s2", 8.0, "rad/s2", 8.0),
            ("regulator_rise_limit_pa_per_s", 4e5, "Pa/s", 4e5),
            ("compressor_flow_kg_per_s", 1e-4, "kg/s", 1e-4),
            ("seal_pressure_coefficient_n_per_pa", 2e-5, "N/Pa", 2e-5),
            ("excitation_v", 5.0, "V", 5.0),
            ("orifice_area_m2", 1e-6, "m2", 1e-6),
            ("volume_m3", 1e-5, "m3", 1e-5),
            ("stribeck_velocity_m_per_s", 0.01, "m/s", 0.01),
            ("stiffness_n_per_m15", 1e8, "N/m^1.5", 1e8),
            ("drift_n_per_s", 0.1, "N/s", 0.1),
            ("noise_steps", 2.0, "", 2.0),
            ("integral_gain_per_s", 5.0, "1/s", 5.0),
            ("tracking_frequency_rad_per_s", 40.0, "rad/s", 40.0),
            ("damping_ratio", 0.7, "", 0.7),
            ("device_substeps", 2.0, "", 2.0),
        ] {
            let unit = Unit::of_key(key);
            assert_eq!(unit.symbol, symbol, "{key}");
            assert_eq!(unit.to_si(value), si, "{key}");
        }
    }

    #[test]
    fn a_value_in_a_common_unit_is_recognised_by_what_it_would_be_in_it() {
        assert_eq!(look_alike("Pa", 1.01325, [5e4, 1.1e5]), Some("bar"));
        assert_eq!(look_alike("Pa", 101.3, [5e4, 1.1e5]), Some("kPa"));
        assert_eq!(look_alike("m", 25.0, [0.002, 0.3]), Some("mm"));
        assert_eq!(look_alike("m3", 14.5, [1e-8, 5e-3]), Some("cm3"));
        assert_eq!(
            look_alike("K", 20.0, [200.0, 500.0]),
            Some("degrees Celsius")
        );
        assert_eq!(look_alike("m", -25.0, [0.002, 0.3]), None);
        assert_eq!(look_alike("", 25.0, [0.1, 1.0]), None);
    }

    #[test]
    fn a_stem_is_the_key_without_its_unit() {
        assert_eq!(stem("feed_mm_per_s"), "feed");
        assert_eq!(stem("force_n"), "force");
        assert_eq!(stem("damping_ratio"), "damping_ratio");
    }
}
