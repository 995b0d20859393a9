//! Units of recorded signals and the column names made from them.
//!
//! Inside the program a channel is a quantity and a unit; in a file it is one column name,
//! `<quantity>_<unit>`: `contact_force_n`, `joint_1_velocity_rad_per_s`. [`column_name`] makes the
//! name and [`parse_column_name`] reads it back; nothing else spells unit suffixes.

/// Unit of a recorded signal. All are SI.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unit {
    /// Time [s].
    Second,
    /// Length [m].
    Metre,
    /// Speed [m/s].
    MetrePerSecond,
    /// Acceleration [m/s2].
    MetrePerSecondSquared,
    /// Force [N].
    Newton,
    /// Torque [N m].
    NewtonMetre,
    /// Pressure [Pa], absolute unless the quantity says that it is gauge.
    Pascal,
    /// Mass [kg].
    Kilogram,
    /// Mass flow [kg/s].
    KilogramPerSecond,
    /// Temperature [K].
    Kelvin,
    /// Voltage, as of a regulator's set point [V].
    Volt,
    /// Electric current, as of a regulator's set point [A].
    Ampere,
    /// Angle [rad].
    Radian,
    /// Angular velocity [rad/s].
    RadianPerSecond,
    /// Volume per time [m3/s].
    CubicMetrePerSecond,
    /// Power [W].
    Watt,
    /// Work [J].
    Joule,
    /// A pure number, as of a valve's state.
    One,
}

impl Unit {
    /// Every unit.
    pub const ALL: [Self; 18] = [
        Self::Second,
        Self::Metre,
        Self::MetrePerSecond,
        Self::MetrePerSecondSquared,
        Self::Newton,
        Self::NewtonMetre,
        Self::Pascal,
        Self::Kilogram,
        Self::KilogramPerSecond,
        Self::Kelvin,
        Self::Volt,
        Self::Ampere,
        Self::Radian,
        Self::RadianPerSecond,
        Self::CubicMetrePerSecond,
        Self::Watt,
        Self::Joule,
        Self::One,
    ];

    /// Part of a column name behind the quantity and an underscore.
    #[must_use]
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Second => "s",
            Self::Metre => "m",
            Self::MetrePerSecond => "m_per_s",
            Self::MetrePerSecondSquared => "m_per_s2",
            Self::Newton => "n",
            Self::NewtonMetre => "n_m",
            Self::Pascal => "pa",
            Self::Kilogram => "kg",
            Self::KilogramPerSecond => "kg_per_s",
            Self::Kelvin => "k",
            Self::Volt => "v",
            Self::Ampere => "a",
            Self::Radian => "rad",
            Self::RadianPerSecond => "rad_per_s",
            Self::CubicMetrePerSecond => "m3_per_s",
            Self::Watt => "w",
            Self::Joule => "j",
            Self::One => "1",
        }
    }

    /// The unit as it is printed.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Second => "s",
            Self::Metre => "m",
            Self::MetrePerSecond => "m/s",
            Self::MetrePerSecondSquared => "m/s2",
            Self::Newton => "N",
            Self::NewtonMetre => "N m",
            Self::Pascal => "Pa",
            Self::Kilogram => "kg",
            Self::KilogramPerSecond => "kg/s",
            Self::Kelvin => "K",
            Self::Volt => "V",
            Self::Ampere => "A",
            Self::Radian => "rad",
            Self::RadianPerSecond => "rad/s",
            Self::CubicMetrePerSecond => "m3/s",
            Self::Watt => "W",
            Self::Joule => "J",
            Self::One => "1",
        }
    }
}

/// The column name of a quantity: `contact_force` in newtons is `contact_force_n`.
#[must_use]
pub fn column_name(quantity: &str, unit: Unit) -> String {
    format!("{quantity}_{}", unit.suffix())
}

/// The quantity and unit of a column name, `None` if it ends in no known unit.
///
/// The longest suffix that fits wins, so `joint_1_torque_n_m` is a torque and not a length.
#[must_use]
pub fn parse_column_name(column: &str) -> Option<(&str, Unit)> {
    Unit::ALL
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
            ("contact_force", Unit::Newton, "contact_force_n"),
            ("stroke", Unit::Metre, "stroke_m"),
            ("chamber_1_pressure", Unit::Pascal, "chamber_1_pressure_pa"),
            ("joint_1_position", Unit::Radian, "joint_1_position_rad"),
            ("joint_1_torque", Unit::NewtonMetre, "joint_1_torque_n_m"),
            ("feed", Unit::MetrePerSecond, "feed_m_per_s"),
        ] {
            assert_eq!(column_name(quantity, unit), column);
            assert_eq!(parse_column_name(column), Some((quantity, unit)));
        }
    }

    #[test]
    fn every_unit_reads_back() {
        for unit in Unit::ALL {
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
