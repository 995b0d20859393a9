//! From a device model file, and what a scenario overrides of it, to the checked device. The model file holds every default, so a key that it lacks is refused.

use std::path::Path;

use super::DeviceScenario;
use super::assumed;
use super::file::{ModelFile, SCHEMA};
use crate::keys::check::Section;
use crate::keys::declaration::Table;
use crate::keys::document::{Document, read_text};
use crate::keys::error::ScenarioError;
use crate::plant::{ContactParameters, Number, PlantParameters, registry};
use crate::unit::Unit;

mod keys;
mod parts;

pub(super) use keys::ModelKeys;

/// Reads a device model file: the device as it comes, not locked, and its physics.
///
/// # Errors
/// The file cannot be read, or a key is unknown, absent or out of its range.
pub fn load_device(path: &Path) -> Result<(DeviceScenario, PlantParameters), ScenarioError> {
    load_with_overrides(path, None, false)
}

/// Reads a device model file; keys of the other table, if any, take precedence, and below them what makes a device ideal, if it is to be.
pub(super) fn load_with_overrides(
    path: &Path,
    overrides: Option<(Section<'_>, &ModelKeys)>,
    ideal: bool,
) -> Result<(DeviceScenario, PlantParameters), ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, SCHEMA)?;
    let file: ModelFile = document.read()?;
    let model = Layers {
        layers: overrides
            .into_iter()
            .chain([(Section::new(&document, "device"), &file.device)])
            .collect(),
        ideal,
    };
    let known = ModelKeys::keys();
    if let Some(unknown) =
        (file.assumed.iter()).find(|key| !known.iter().any(|own| own.name == **key))
    {
        let expected = "keys of [device]".to_owned();
        return Err(Section::new(&document, "").refuse("judged", format!("{unknown:?}"), expected));
    }
    let mut plant = PlantParameters {
        contact: ContactParameters::usual(ideal),
        ..PlantParameters::default()
    };
    let is_part = |number: &Number| registry::PARTS.iter().any(|part| part.name == number.name);
    for number in registry::all().filter(|number| number.device_key.is_some()) {
        let value = model.number(number)?;
        if !is_part(number) {
            number.quantity().set(&mut plant, value);
        }
    }
    model.add_parts(&mut plant.device)?;
    let device = DeviceScenario {
        model: path.to_path_buf(),
        locked: false,
        ideal,
        assumed: assumed::of_model(&file.assumed, &file.device.numbers, |key| {
            model.is_overridden(key)
        }),
    };
    model.check()?;
    Ok((device, plant))
}

/// Tables that give the same keys, the first to give one being right.
struct Layers<'a> {
    layers: Vec<(Section<'a>, &'a ModelKeys)>,
    /// Whether what makes a device ideal stands before the last of them, the model file.
    ideal: bool,
}

impl<'a> Layers<'a> {
    /// The first value given, with the table that gives it.
    fn find<T>(
        &self,
        key: &str,
        pick: impl Fn(&ModelKeys) -> Option<T>,
    ) -> Result<(&Section<'a>, T), ScenarioError> {
        self.layers
            .iter()
            .find_map(|(section, keys)| pick(keys).map(|value| (section, value)))
            .ok_or_else(|| {
                // The last layer is the model file, which should hold every key.
                let (model, _) = &self.layers[self.layers.len() - 1];
                model.missing(key, "it to be given, a device model has no defaults")
            })
    }

    /// A number as it was given: its table, its key and its value there.
    fn given(&self, number: &Number) -> Result<(&Section<'a>, &'static str, f64), ScenarioError> {
        let key = number.device_key.unwrap_or(number.name);
        let (section, value) = self.find(key, |keys| keys.numbers.get(key).copied())?;
        Ok((section, key, value))
    }

    /// A number within its range, in SI.
    fn number(&self, number: &Number) -> Result<f64, ScenarioError> {
        // Younger than models that stand: one that does not name them has no second regulator, and a housing of which nobody has said the mass.
        let younger = [
            &registry::OPPOSING_PRESSURE,
            &registry::HOUSING_MASS,
            &registry::HOUSING_CENTRE,
        ];
        let is_younger = younger.iter().any(|young| young.name == number.name);
        if is_younger && self.given(number).is_err() {
            return Ok(0.0);
        }
        let (section, key, value) = self.given(number)?;
        let value = section.known(number, key, value)?;
        Ok(self.idealised(number).unwrap_or(value))
    }

    /// Value of a number by which the device is ideal [SI], unless the scenario gives it.
    fn idealised(&self, number: &Number) -> Option<f64> {
        let key = number.device_key.unwrap_or(number.name);
        let ideal = number.ideal().filter(|_| self.ideal)?;
        self.of_scenario(|keys| keys.numbers.get(key).copied())
            .is_none()
            .then_some(ideal)
    }

    /// Whether something else counts than what the model file says of a key.
    fn is_overridden(&self, key: &str) -> bool {
        let mut above = self.layers.iter().rev().skip(1);
        let mut numbers = registry::all().filter(|number| number.device_key == Some(key));
        above.any(|(section, _)| section.given().any(|own| own == key))
            || (self.ideal && key == "gas_process")
            || numbers.any(|number| self.idealised(number).is_some())
    }

    /// What the scenario itself gives.
    fn of_scenario<T>(&self, pick: impl Fn(&ModelKeys) -> Option<T>) -> Option<T> {
        let (_, above) = self.layers.split_last()?;
        above.iter().find_map(|(_, keys)| pick(keys))
    }

    /// Refusal of a number as it was given.
    fn refusal(&self, number: &Number, expected: &str) -> ScenarioError {
        let (nearest, _) = &self.layers[0];
        match self.given(number) {
            _ if self.idealised(number).is_some() => {
                nearest.missing(number.device_key.unwrap_or(number.name), expected)
            }
            Ok((section, key, value)) => section.refuse_number(key, value, expected.to_owned()),
            Err(missing) => missing,
        }
    }

    /// Conditions between the values.
    fn check(&self) -> Result<(), ScenarioError> {
        let compare = |number, words: &str, other, reason: &str| {
            let (_, key, value) = self.given(other)?;
            let value = Unit::of_key(key).show(value);
            Ok(self.refusal(number, &format!("{words} {key}, {value}{reason}")))
        };
        let [rod, bore] = [&registry::ROD, &registry::BORE];
        if self.number(rod)? >= self.number(bore)? {
            return Err(compare(rod, "less than", bore, "")?);
        }
        let [least, most] = [&registry::SEAL_COULOMB, &registry::SEAL_STATIC];
        if self.number(most)? < self.number(least)? {
            return Err(compare(most, "at least", least, "")?);
        }
        let [radius, centre] = [&registry::TOOL_RADIUS, &registry::TOOL_CENTRE];
        if self.number(centre)? < self.number(radius)? {
            let reason = ", so that the ball is in front of the flange";
            return Err(compare(centre, "at least", radius, reason)?);
        }
        Ok(())
    }
}
