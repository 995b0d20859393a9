//! From a table of `[variables]` to the checked variable.

use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::keys::suggestion::advice;
use crate::scenario::ScenarioError;
use crate::scenario::sections::{model_sections, scenario_sections};
use crate::unit::Unit;

use super::{BORE, CatalogueEntry, Domain, ROD, Variable};
use crate::design::catalogue::{STANDARD_CYLINDERS, standard_rod};
use crate::design::file::{ScaleKeys, VariableKeys};

/// Checks one table of `[variables]`.
pub(in crate::design) fn variable(
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
        location: document.location(&format!("variables.{key}")),
    })
}

/// Tables of a scenario whose numbers may be varied beside those of its device.
const TABLES: [&str; 5] = ["controller", "contact", "process", "removal", "tool"];

/// Checks that it is a key of a device, or a number of one of the scenario's tables. Those of a controller depend on its kind; all are checked when the
/// scenario is made.
fn check_key(document: &Document<'_>, key: &str) -> Result<(), ScenarioError> {
    let sections = model_sections();
    let (table, name) = key.split_once('.').unwrap_or(("device", key));
    let known = match table {
        "controller" => !name.is_empty() && !name.contains('.'),
        "device" => sections
            .iter()
            .any(|(section, keys)| section == "device" && keys.contains(&name)),
        table => {
            TABLES.contains(&table)
                && scenario_sections()
                    .iter()
                    .any(|(section, keys)| section == table && keys.contains(&name))
        }
    };
    if known {
        return Ok(());
    }
    Err(ScenarioError::UnknownKey {
        location: document.location(&format!("variables.{key}")),
        key: format!("variables.{key}"),
        advice: format!(
            "a variable is a key of [device.override] or, in quotes, \"table.key\" of controller, contact, process, removal or tool; {}",
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
        if self.keys.rods.is_some() {
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
            return Err(self.nothing_within(&values));
        }
        Ok(Domain::Catalogue(entries))
    }

    /// Refuses bounds between which there is no entry, or a catalogue that has none.
    fn nothing_within(&self, values: &[f64]) -> ScenarioError {
        let listed: Vec<String> = values.iter().map(f64::to_string).collect();
        let expected = format!("one of {} within min and max", listed.join(", "));
        match (self.keys.min, self.keys.max) {
            _ if values.is_empty() => {
                let expected = "at least one entry".to_owned();
                self.section.refuse("catalogue", "[]".to_owned(), expected)
            }
            (Some(min), _) => self.refuse("min", min, expected),
            (None, Some(max)) => self.refuse("max", max, expected),
            (None, None) => self.section.missing("catalogue", "at least one entry"),
        }
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
        let in_mm = |rods: &Vec<f64>| {
            let rods = rods.iter().map(|rod| Unit::of_key(ROD).of_si(*rod));
            rods.collect::<Vec<_>>()
        };
        let given = self.keys.rods.as_ref().map(in_mm);
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
        if let Some(rods) = &given {
            let fit = rods
                .iter()
                .zip(bores)
                .all(|(rod, bore)| *rod > 0.0 && rod < bore);
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
                let values: Vec<String> = entries
                    .iter()
                    .map(|entry| entry.value.to_string())
                    .collect();
                Err(self.refuse("start", start, format!("one of {}", values.join(", "))))
            }
            _ if (min..=max).contains(&start) => Ok(()),
            _ => Err(self.refuse("start", start, format!("{min} to {max}"))),
        }
    }
}
