//! A unit of SI as powers of metre, kilogram, second and kelvin.

use std::fmt;

/// A unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Powers of m, kg, s and K.
    powers: [f64; 4],
}

/// Symbols with their powers of m, kg, s and K.
const SYMBOLS: [(&str, [f64; 4]); 11] = [
    ("1", [0.0; 4]),
    ("rad", [0.0; 4]),
    ("m", [1.0, 0.0, 0.0, 0.0]),
    ("kg", [0.0, 1.0, 0.0, 0.0]),
    ("s", [0.0, 0.0, 1.0, 0.0]),
    ("K", [0.0, 0.0, 0.0, 1.0]),
    ("N", [1.0, 1.0, -2.0, 0.0]),
    ("Pa", [-1.0, 1.0, -2.0, 0.0]),
    ("J", [2.0, 1.0, -2.0, 0.0]),
    ("W", [2.0, 1.0, -3.0, 0.0]),
    ("Hz", [0.0, 0.0, -1.0, 0.0]),
];

/// One of pressure, which as powers would be one of force over area.
const PASCAL: Unit = Unit {
    powers: [-1.0, 1.0, -2.0, 0.0],
};

/// One of a mass flow, which a damping has too.
const FLOW: Unit = Unit {
    powers: [0.0, 1.0, -1.0, 0.0],
};

impl Unit {
    /// No unit.
    pub const ONE: Self = Self { powers: [0.0; 4] };

    /// Reads a unit as in `N s/m`, `kg m/s^2`, `1/Pa`: behind a stroke everything divides.
    ///
    /// # Errors
    /// The symbol that is none of SI without a prefix.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut found = Self::ONE;
        for (place, part) in text.split('/').enumerate() {
            let symbols = part.split([' ', '*', '\u{b7}', '(', ')']);
            for symbol in symbols.filter(|symbol| !symbol.is_empty()) {
                let (name, power) = symbol.split_once('^').unwrap_or((symbol, "1"));
                let known = SYMBOLS.iter().find(|(known, _)| *known == name);
                let (Some((_, powers)), Ok(power)) = (known, power.parse::<f64>()) else {
                    return Err(symbol.to_owned());
                };
                let sign = if place == 0 { 1.0 } else { -1.0 };
                found = found.times(Self { powers: *powers }.power(sign * power));
            }
        }
        Ok(found)
    }

    /// Powers of m, kg, s and K.
    #[must_use]
    pub fn powers(self) -> [f64; 4] {
        self.powers
    }

    /// Product of two.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let mut powers = self.powers;
        for (power, other) in powers.iter_mut().zip(other.powers) {
            *power += other;
        }
        Self { powers }
    }

    /// A power of it.
    #[must_use]
    pub fn power(self, exponent: f64) -> Self {
        Self {
            powers: self.powers.map(|power| power * exponent),
        }
    }

    /// No unit, if it is none.
    pub(super) fn plain(self) -> Option<Self> {
        (self == Self::ONE).then_some(self)
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == PASCAL {
            return formatter.write_str("Pa");
        }
        // A force's name says more than its powers.
        let forces = self.powers[1];
        let newton = Self {
            powers: [1.0, 1.0, -2.0, 0.0],
        };
        let (named, rest) = if forces == 1.0 && self.powers[2] <= -1.0 && *self != FLOW {
            ("N", self.times(newton.power(-1.0)))
        } else {
            ("", *self)
        };
        let symbols = ["m", "kg", "s", "K"].into_iter().zip(rest.powers);
        let shown = |wanted: fn(&f64) -> bool| {
            let own = symbols.clone().filter(move |(_, power)| wanted(power));
            let one = |(symbol, power): (&str, f64)| match power.abs() {
                1.0 => symbol.to_owned(),
                power => format!("{symbol}^{power}"),
            };
            own.map(one).collect::<Vec<_>>()
        };
        let mut above = shown(|power| *power > 0.0);
        if !named.is_empty() {
            above.insert(0, named.to_owned());
        }
        let below = shown(|power| *power < 0.0);
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join(" ")
        };
        match below.len() {
            0 => formatter.write_str(&above),
            1 => write!(formatter, "{above}/{}", below[0]),
            _ => write!(formatter, "{above}/({})", below.join(" ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_shown_as_it_is_read() {
        for text in ["N", "m/s", "kg/s", "s", "1", "1/s", "m^2", "kg", "Pa"] {
            assert_eq!(Unit::read(text).unwrap().to_string(), text);
        }
        assert_eq!(Unit::read("kg m/s^2"), Unit::read("N"));
        assert_eq!(Unit::read("N s/m"), Unit::read("kg/s"));
        assert_eq!(Unit::read("N/m^2"), Unit::read("Pa"));
        assert_eq!(Unit::read("1/(Pa s)"), Unit::read("1/Pa/s"));
        assert_eq!(Unit::read("rad/s"), Unit::read("Hz"));
    }

    #[test]
    fn what_is_not_si_without_a_prefix_is_refused() {
        for (text, symbol) in [
            ("mm", "mm"),
            ("N s/mm", "mm"),
            ("bar", "bar"),
            ("m^x", "m^x"),
            ("g", "g"),
        ] {
            assert_eq!(Unit::read(text), Err(symbol.to_owned()));
        }
    }
}
