//! `[effect.NAME]` of an improved rig file: physics beyond the believed model, with every number that it has in the catalogue.

use std::collections::BTreeMap;

use super::super::check::Section;
use super::super::document::{Document, join};
use super::super::error::ScenarioError;
use super::super::suggestion::nearest;
use super::keys::Numbers;
use super::values::{checked, tolerance};
use crate::effects::{Effect, candidates};
use crate::plant::PlantParameters;

/// The effects of a file on a rig without them, in the order of the catalogue, each with all its numbers.
pub(super) fn effects(
    document: &Document<'_>,
    tables: &BTreeMap<String, Numbers>,
    plant: &PlantParameters,
) -> Result<Vec<(&'static Effect, Vec<f64>)>, ScenarioError> {
    let known = candidates(plant.chain);
    if let Some(name) = tables
        .keys()
        .find(|name| known.iter().all(|effect| effect.name != **name))
    {
        let key = join("effect", name);
        let names: Vec<&str> = known.iter().map(|effect| effect.name).collect();
        return Err(ScenarioError::UnknownKey {
            place: document.key_place(&key),
            key,
            advice: nearest(name, &names),
        });
    }
    let mut found: Vec<(&'static Effect, Vec<f64>)> = Vec::new();
    for effect in known {
        let Some(numbers) = tables.get(effect.name) else {
            continue;
        };
        let other = found.iter().find(|(other, _)| other.excludes(effect));
        if let Some((other, _)) = other {
            let reason = format!("effect.{} stands in its place", other.name);
            return Err(Section::new(document, "effect").misplaced(effect.name, reason));
        }
        found.push((effect, values(document, effect, numbers, plant)?));
    }
    Ok(found)
}

/// All numbers of an effect.
fn values(
    document: &Document<'_>,
    effect: &Effect,
    numbers: &Numbers,
    plant: &PlantParameters,
) -> Result<Vec<f64>, ScenarioError> {
    let table = join("effect", effect.name);
    let section = Section::new(document, table.as_str());
    let parameters = effect.parameters(plant);
    let names: Vec<&str> = parameters.iter().map(|p| p.quantity.name).collect();
    if let Some(key) = numbers.keys().find(|key| !names.contains(&key.as_str())) {
        let dotted = join(&table, key);
        return Err(ScenarioError::UnknownKey {
            place: document.key_place(&dotted),
            key: dotted,
            advice: nearest(key, &names),
        });
    }
    let value = |parameter: &crate::effects::Parameter| {
        let key = parameter.quantity.name;
        let number = numbers
            .get(key)
            .ok_or_else(|| section.missing(key, "every number of the effect to be given"))?;
        tolerance(&Section::new(document, join(&table, key)), number)?;
        checked(&section, key, number.value, widened(parameter.bounds))
    };
    parameters.iter().map(value).collect()
}

/// Twice as far as a fit looks: a file may hold a value at a bound, rounded, or know of a device beyond it.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let low = if low > 0.0 { 0.5 * low } else { 2.0 * low };
    let high = if high > 0.0 { 2.0 * high } else { 0.5 * high };
    [low, high]
}

/// Makes an effect a part of the rig.
pub(super) fn apply(effect: &Effect, values: &[f64], plant: &mut PlantParameters) {
    for (parameter, value) in effect.parameters(plant).iter().zip(values) {
        parameter.quantity.set(plant, *value);
    }
}
