//! A variable of a study: its key, what values it may take, and where it starts.

mod check;

use super::catalogue::{STANDARD_CYLINDERS, standard_rod};
use crate::keys::error::Location;

pub(super) use check::variable;

/// Significant digits of a continuous variable: no drawing has more, and the file states exactly what was simulated.
const DIGITS: usize = 5;
const BORE: &str = "bore_mm";
const ROD: &str = "rod_mm";

/// A key that the study varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// The key, unit included: of `[device.override]`, or `table.name` of the scenario.
    pub key: String,
    /// Values that it may take, in the key's unit.
    pub domain: Domain,
    /// Value of the starting design, in the key's unit.
    pub start: f64,
    /// Where it stands in the study file.
    pub location: Location,
}

/// Values of a variable, in its key's unit.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// From the first to the second, in equal differences.
    Linear(f64, f64),
    /// From the first to the second, in equal ratios; both positive.
    Logarithmic(f64, f64),
    /// One of these, which increase.
    Catalogue(Vec<CatalogueEntry>),
}

/// An entry of a catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CatalogueEntry {
    /// Its value.
    pub value: f64,
    /// Rod diameter that goes with it, if it is a bore whose rod follows [mm].
    pub rod: Option<f64>,
}

impl Domain {
    /// Value at a place from 0 to 1.
    pub(super) fn value(&self, coordinate: f64) -> f64 {
        let coordinate = coordinate.clamp(0.0, 1.0);
        match self {
            Self::Linear(min, max) => rounded(min + (max - min) * coordinate).clamp(*min, *max),
            Self::Logarithmic(min, max) => {
                rounded(min * (max / min).powf(coordinate)).clamp(*min, *max)
            }
            Self::Catalogue(entries) => entries[self.index(coordinate)].value,
        }
    }

    /// Place of a value: the middle of its share for a catalogue.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        match self {
            Self::Linear(min, max) => (value - min) / (max - min),
            Self::Logarithmic(min, max) => (value / min).ln() / (max / min).ln(),
            Self::Catalogue(entries) => {
                let below = entries.iter().filter(|entry| entry.value < value).count();
                Self::place_of_entry(below, entries.len())
            }
        }
    }

    /// Entry of a catalogue at a place; 0 for a continuous variable.
    pub(super) fn index(&self, coordinate: f64) -> usize {
        match self {
            // Casting saturates at zero.
            Self::Catalogue(entries) => {
                ((coordinate * entries.len() as f64) as usize).min(entries.len() - 1)
            }
            _ => 0,
        }
    }

    /// Middle of the share of an entry.
    pub(super) fn place_of_entry(index: usize, count: usize) -> f64 {
        (index as f64 + 0.5) / count as f64
    }

    /// Number of entries, if it is a catalogue.
    pub(super) fn count(&self) -> Option<usize> {
        match self {
            Self::Catalogue(entries) => Some(entries.len()),
            _ => None,
        }
    }

    /// Least and greatest value.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        match self {
            Self::Linear(min, max) | Self::Logarithmic(min, max) => [*min, *max],
            Self::Catalogue(entries) => [entries[0].value, entries[entries.len() - 1].value],
        }
    }
}

impl Variable {
    /// Keys and values that it gives a design: its own, and the rod's if that follows.
    pub(super) fn entries(&self, value: f64) -> Vec<(String, f64)> {
        let mut entries = vec![(self.key.clone(), value)];
        if let Domain::Catalogue(catalogue) = &self.domain {
            let rod = catalogue
                .iter()
                .find(|entry| entry.value == value)
                .map_or_else(|| standard_rod(value), |entry| entry.rod);
            let follows = catalogue.iter().any(|entry| entry.rod.is_some());
            if let (true, Some(rod)) = (follows, rod) {
                entries.push((ROD.to_owned(), rod));
            }
        }
        entries
    }

    /// The next standard bore beyond the catalogue's ends; none for other variables.
    pub(super) fn beyond(&self, value: f64, larger: bool) -> Option<f64> {
        let bores = || STANDARD_CYLINDERS.iter().map(|(bore, _)| *bore);
        if self.key != BORE {
            None
        } else if larger {
            bores().find(|bore| *bore > value)
        } else {
            bores().rfind(|bore| *bore < value)
        }
    }
}

/// To the digits that a variable has.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_and_values_are_inverse_and_end_on_the_bounds() {
        for domain in [Domain::Linear(0.5, 7.0), Domain::Logarithmic(0.01, 30.0)] {
            let [min, max] = domain.ends();
            assert_eq!((domain.value(0.0), domain.value(1.0)), (min, max));
            for coordinate in [0.1, 0.25, 0.7] {
                assert!((domain.coordinate(domain.value(coordinate)) - coordinate).abs() < 1e-4);
            }
        }
        let log = Domain::Logarithmic(0.01, 100.0);
        assert!((log.value(0.5) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn entries_of_a_catalogue_have_equal_shares() {
        let entry = |value| CatalogueEntry { value, rod: None };
        let domain = Domain::Catalogue([4.0, 6.0, 9.0].map(entry).to_vec());
        let values = [0.0, 0.3, 0.34, 0.66, 0.67, 1.0].map(|coordinate| domain.value(coordinate));
        assert_eq!(values, [4.0, 4.0, 6.0, 6.0, 9.0, 9.0]);
        assert_eq!(domain.value(domain.coordinate(6.0)), 6.0);
    }

    #[test]
    fn a_value_has_the_digits_that_the_file_states() {
        assert_eq!(rounded(2.345_617_894), 2.3456);
        assert_eq!(rounded(2.0e-7 / 3.0), 6.6667e-8);
        assert_eq!(rounded(0.0), 0.0);
    }
}
