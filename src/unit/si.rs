//! Units of recorded signals and the column names made from them.
//!
//! Inside the program a channel is a quantity and a unit; in a file it is one column name,
//! `<quantity>_<unit>`: `contact_force_n`, `joint_1_velocity_rad_per_s`. [`column_name`] makes the
//! name and [`parse_column_name`] reads it back; nothing else spells unit suffixes.

use super::UNITS;
use crate::listed::listed;

listed! {
    /// Unit of a recorded signal. All are SI.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum SiUnit: 18,
    /// The unit as it is printed.
    symbol: &'static str {
        /// Time [s].
        Second = "s",
        /// Length [m].
        Metre = "m",
        /// Speed [m/s].
        MetrePerSecond = "m/s",
        /// Acceleration [m/s2].
        MetrePerSecondSquared = "m/s2",
        /// Force [N].
        Newton = "N",
        /// Torque [N m].
        NewtonMetre = "N m",
        /// Pressure [Pa], absolute unless the quantity says that it is gauge.
        Pascal = "Pa",
        /// Mass [kg].
        Kilogram = "kg",
        /// Mass flow [kg/s].
        KilogramPerSecond = "kg/s",
        /// Temperature [K].
        Kelvin = "K",
        /// Voltage, as of a regulator's set point [V].
        Volt = "V",
        /// Electric current, as of a regulator's set point [A].
        Ampere = "A",
        /// Angle [rad].
        Radian = "rad",
        /// Angular velocity [rad/s].
        RadianPerSecond = "rad/s",
        /// Volume per time [m3/s].
        CubicMetrePerSecond = "m3/s",
        /// Power [W].
        Watt = "W",
        /// Work [J].
        Joule = "J",
        /// A pure number, as of a valve's state.
        One = "1",
    }
}

impl SiUnit {
    /// The unit of a symbol.
    #[must_use]
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// Part of a column name behind the quantity and an underscore.
    #[must_use]
    pub fn suffix(self) -> &'static str {
        let own = UNITS.iter().find(|unit| unit.symbol == self.symbol());
        own.map_or("", |unit| unit.suffix)
    }
}

/// The column name of a quantity: `contact_force` in newtons is `contact_force_n`.
#[must_use]
pub fn column_name(quantity: &str, unit: SiUnit) -> String {
    format!("{quantity}_{}", unit.suffix())
}

/// The quantity and unit of a column name, `None` if it ends in no known unit.
///
/// The longest suffix that fits wins, so `joint_1_torque_n_m` is a torque and not a length.
#[must_use]
pub fn parse_column_name(column: &str) -> Option<(&str, SiUnit)> {
    SiUnit::ALL
        .into_iter()
        .filter_map(|unit| {
            let quantity = column.strip_suffix(unit.suffix())?.strip_suffix('_')?;
            (!quantity.is_empty()).then_some((quantity, unit))
        })
        .min_by_key(|(quantity, _)| quantity.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_users_rely_on() {
        for (quantity, unit, column) in [
            ("contact_force", SiUnit::Newton, "contact_force_n"),
            ("stroke", SiUnit::Metre, "stroke_m"),
            (
                "chamber_1_pressure",
                SiUnit::Pascal,
                "chamber_1_pressure_pa",
            ),
            ("joint_1_position", SiUnit::Radian, "joint_1_position_rad"),
            ("joint_1_torque", SiUnit::NewtonMetre, "joint_1_torque_n_m"),
            ("feed", SiUnit::MetrePerSecond, "feed_m_per_s"),
        ] {
            assert_eq!(column_name(quantity, unit), column);
            assert_eq!(parse_column_name(column), Some((quantity, unit)));
        }
    }

    #[test]
    fn every_unit_reads_back() {
        for unit in SiUnit::ALL {
            let column = column_name("signal", unit);
            assert_eq!(parse_column_name(&column), Some(("signal", unit)));
        }
    }

    #[test]
    fn names_without_a_unit_are_not_columns_of_a_recording() {
        for column in ["phase", "force", "force_lbf", "_m", "m", ""] {
            assert_eq!(parse_column_name(column), None, "{column}");
        }
    }
}
