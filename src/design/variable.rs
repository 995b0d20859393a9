//! A variable of a study: its key, what values it may take, and where it starts.

use crate::scenario::ScenarioError;
use crate::scenario::check::Section;
use crate::scenario::document::Document;
use crate::scenario::sections::model_sections;
use crate::scenario::suggestion::advice;

use super::catalogue::{STANDARD_CYLINDERS, standard_rod};
use super::file::{ScaleKeys, VariableKeys};

/// Significant digits of a continuous variable: no drawing has more, and the file states exactly what was simulated.
const DIGITS: usize = 5;
const BORE: &str = "bore_mm";
const ROD: &str = "rod_mm";

/// A key that the study varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// The key, unit included: of `[device.override]`, or `controller.name`.
    pub key: String,
    /// Values that it may take, in the key's unit.
    pub domain: Domain,
    /// Value of the starting design, in the key's unit.
    pub start: f64,
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
    pub(super) fn value(&self, place: f64) -> f64 {
        let place = place.clamp(0.0, 1.0);
        match self {
            Self::Linear(min, max) => rounded(min + (max - min) * place).clamp(*min, *max),
            Self::Logarithmic(min, max) => {
                rounded(min * (max / min).powf(place)).clamp(*min, *max)
            }
            Self::Catalogue(entries) => entries[self.index(place)].value,
        }
    }

    /// Place of a value: the middle of its share for a catalogue.
    pub(super) fn place(&self, value: f64) -> f64 {
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
    pub(super) fn index(&self, place: f64) -> usize {
        match self {
            // Casting saturates at zero.
            Self::Catalogue(entries) => {
                ((place * entries.len() as f64) as usize).min(entries.len() - 1)
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
    pub(super) fn ends(&self) -> [f64; 2] {
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
    format!("{value:.*e}", DIGITS - 1)
        .parse()
        .unwrap_or(value)
}

/// Checks one table of `[variables]`.
pub(super) fn variable(
    document: &Document<'_>,
    key: &str,
    keys: &VariableKeys,
    rod_varies: bool,
) -> Result<Variable, ScenarioError> {
    check_key(document, key)?;
    let section = Section::new(document, format!("variables.{key}"));
    let reader = Reader { section, key, keys };
    let domain = if keys.catalogue.is_some() || key == BORE {
        reader.catalogue(rod_varies)?
    } else {
        reader.interval()?
    };
    reader.check_start(&domain)?;
    Ok(Variable {
        key: key.to_owned(),
        domain,
        start: keys.start,
    })
}

/// Is it a key of a device, or one of the controller? The latter depend on its kind and are checked when the scenario is made.
fn check_key(document: &Document<'_>, key: &str) -> Result<(), ScenarioError> {
    if key
        .strip_prefix("controller.")
        .is_some_and(|name| !name.is_empty() && !name.contains('.'))
    {
        return Ok(());
    }
    let sections = model_sections();
    let known = sections
        .iter()
        .any(|(section, keys)| *section == "device" && keys.contains(&key));
    if known {
        return Ok(());
    }
    Err(ScenarioError::UnknownKey {
        place: document.place(&format!("variables.{key}")),
        key: format!("variables.{key}"),
        advice: format!(
            "a variable is a key of [device.override] or, in quotes, \"controller.key\"; {}",
            advice(&format!("device.{key}"), &sections)
        ),
    })
}

struct Reader<'a> {
    section: Section<'a>,
    key: &'a str,
    keys: &'a VariableKeys,
}

impl Reader<'_> {
    fn refuse(&self, key: &str, value: f64, expected: String) -> ScenarioError {
        self.section.refuse(key, value.to_string(), expected)
    }

    fn finite(&self, key: &str, value: Option<f64>) -> Result<Option<f64>, ScenarioError> {
        match value {
            Some(value) if !value.is_finite() => {
                Err(self.refuse(key, value, "a finite number".to_owned()))
            }
            value => Ok(value),
        }
    }

    /// `min` and `max`, the first below the second.
    fn bounds(&self) -> Result<(Option<f64>, Option<f64>), ScenarioError> {
        let min = self.finite("min", self.keys.min)?;
        let max = self.finite("max", self.keys.max)?;
        if let (Some(low), Some(high)) = (min, max)
            && low >= high
        {
            return Err(self.refuse("min", low, format!("less than max, {high}")));
        }
        Ok((min, max))
    }

    fn interval(&self) -> Result<Domain, ScenarioError> {
        if self.keys.rod_mm.is_some() {
            let reason = "only bore_mm has rods that follow it".to_owned();
            return Err(self.section.misplaced("rod_mm", reason));
        }
        let (min, max) = self.bounds()?;
        let bound = |key, value: Option<f64>| {
            value.ok_or_else(|| self.section.missing(key, "it to be given, or a catalogue"))
        };
        let (min, max) = (bound("min", min)?, bound("max", max)?);
        match self.keys.scale {
            Some(ScaleKeys::Log) if min <= 0.0 => {
                let expected = "more than 0, as the scale is \"log\"".to_owned();
                Err(self.refuse("min", min, expected))
            }
            Some(ScaleKeys::Log) => Ok(Domain::Logarithmic(min, max)),
            Some(ScaleKeys::Linear) | None => Ok(Domain::Linear(min, max)),
        }
    }

    fn catalogue(&self, rod_varies: bool) -> Result<Domain, ScenarioError> {
        if self.keys.scale.is_some() {
            let reason = "a catalogue has no scale between its entries".to_owned();
            return Err(self.section.misplaced("scale", reason));
        }
        let (min, max) = self.bounds()?;
        let values = match &self.keys.catalogue {
            Some(values) => self.increasing("catalogue", values)?,
            None => STANDARD_CYLINDERS.iter().map(|(bore, _)| *bore).collect(),
        };
        let rods = self.rods(&values, rod_varies)?;
        let within =
            |value: f64| min.is_none_or(|min| min <= value) && max.is_none_or(|max| value <= max);
        let entries: Vec<CatalogueEntry> = values
            .iter()
            .zip(rods)
            .filter(|(value, _)| within(**value))
            .map(|(&value, rod)| CatalogueEntry { value, rod })
            .collect();
        if entries.is_empty() {
            let found = format!("{values:?}");
            let range = match (min, max) {
                (Some(min), Some(max)) => format!("at least one entry within {min} to {max}"),
                (Some(min), None) => format!("at least one entry from {min}"),
                (None, Some(max)) => format!("at least one entry up to {max}"),
                (None, None) => "at least one entry".to_owned(),
            };
            return Err(self.section.refuse("catalogue", found, range));
        }
        Ok(Domain::Catalogue(entries))
    }

    fn increasing(&self, key: &str, values: &[f64]) -> Result<Vec<f64>, ScenarioError> {
        if !values.is_sorted_by(|a, b| a < b) || values.iter().any(|value| !value.is_finite()) {
            let expected = "finite numbers, each greater than the one before".to_owned();
            return Err(self.section.refuse(key, format!("{values:?}"), expected));
        }
        Ok(values.to_vec())
    }

    /// Rods that go with the bores, one an entry.
    fn rods(&self, bores: &[f64], rod_varies: bool) -> Result<Vec<Option<f64>>, ScenarioError> {
        let given = self.keys.rod_mm.as_deref();
        if given.is_some() && self.key != BORE {
            let reason = "only bore_mm has rods that follow it".to_owned();
            return Err(self.section.misplaced("rod_mm", reason));
        }
        if given.is_some() && rod_varies {
            let reason = "rod_mm is a variable itself".to_owned();
            return Err(self.section.misplaced("rod_mm", reason));
        }
        if self.key != BORE || rod_varies {
            return Ok(vec![None; bores.len()]);
        }
        if let Some(rods) = given {
            let fit = rods.iter().zip(bores).all(|(rod, bore)| *rod > 0.0 && rod < bore);
            if rods.len() != bores.len() || !fit {
                let expected = format!(
                    "{} numbers, the rod of each bore in the catalogue and less than it",
                    bores.len()
                );
                return Err(self.section.refuse("rod_mm", format!("{rods:?}"), expected));
            }
            return Ok(rods.iter().copied().map(Some).collect());
        }
        let rod = |bore: &f64| {
            standard_rod(*bore).map(Some).ok_or_else(|| {
                let expected =
                    format!("the rod of each bore, as {bore} mm is no bore of ISO 6432 or 15552");
                self.section.missing("rod_mm", &expected)
            })
        };
        bores.iter().map(rod).collect()
    }

    fn check_start(&self, domain: &Domain) -> Result<(), ScenarioError> {
        let start = self.keys.start;
        let [min, max] = domain.ends();
        match domain {
            Domain::Catalogue(entries) if entries.iter().all(|entry| entry.value != start) => {
                let values: Vec<String> =
                    entries.iter().map(|entry| entry.value.to_string()).collect();
                Err(self.refuse("start", start, format!("one of {}", values.join(", "))))
            }
            _ if (min..=max).contains(&start) => Ok(()),
            _ => Err(self.refuse("start", start, format!("{min} to {max}"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_values_are_inverse_and_end_on_the_bounds() {
        for domain in [Domain::Linear(0.5, 7.0), Domain::Logarithmic(0.01, 30.0)] {
            let [min, max] = domain.ends();
            assert_eq!((domain.value(0.0), domain.value(1.0)), (min, max));
            for place in [0.1, 0.25, 0.7] {
                assert!((domain.place(domain.value(place)) - place).abs() < 1e-4);
            }
        }
        let log = Domain::Logarithmic(0.01, 100.0);
        assert!((log.value(0.5) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn entries_of_a_catalogue_have_equal_shares() {
        let entry = |value| CatalogueEntry { value, rod: None };
        let domain = Domain::Catalogue([4.0, 6.0, 9.0].map(entry).to_vec());
        let values = [0.0, 0.3, 0.34, 0.66, 0.67, 1.0].map(|place| domain.value(place));
        assert_eq!(values, [4.0, 4.0, 6.0, 6.0, 9.0, 9.0]);
        assert_eq!(domain.value(domain.place(6.0)), 6.0);
    }

    #[test]
    fn a_value_has_the_digits_that_the_file_states() {
        assert_eq!(rounded(3.141592653), 3.1416);
        assert_eq!(rounded(2.0e-7 / 3.0), 6.6667e-8);
        assert_eq!(rounded(0.0), 0.0);
    }
}
