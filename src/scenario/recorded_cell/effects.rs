//! Effects in the scenario file of a recorded cell: read from it, and written into it by a diagnosis.

use std::collections::BTreeMap;
use std::path::Path;

use toml_edit::{DocumentMut, Item, Table, value};

use super::super::check::Section;
use super::super::document::Document;
use super::super::error::ScenarioError;
use super::super::rig_file::blank;
use super::RecordedCell;
use crate::effects::{Effect, every};
use crate::plant::PlantParameters;

/// `[effect.NAME]`: all its numbers by name.
pub(in super::super) type EffectKeys = BTreeMap<String, BTreeMap<String, f64>>;

/// An effect's name with its numbers: name, value, 95 % interval.
pub type FoundNumbers = (&'static str, Vec<(&'static str, f64, [f64; 2])>);

/// The effects that a file names, in the order of the catalogue, each with all its numbers.
pub(super) fn effects(
    document: &Document<'_>,
    keys: &EffectKeys,
) -> Result<Vec<(&'static Effect, Vec<f64>)>, ScenarioError> {
    let section = Section::new(document, "effect");
    if let Some(name) = keys.keys().find(|name| every().all(|e| e.name != **name)) {
        let names: Vec<&str> = every().map(|effect| effect.name).collect();
        let expected = format!("one of {}", names.join(", "));
        return Err(section.refuse(name, "an unknown effect".to_owned(), expected));
    }
    let mut effects: Vec<(&'static Effect, Vec<f64>)> = Vec::new();
    for effect in every() {
        let Some(given) = keys.get(effect.name) else {
            continue;
        };
        if let Some((other, _)) = effects.iter().find(|(other, _)| other.excludes(effect)) {
            let reason = format!("effect.{} stands in its place", other.name);
            return Err(section.misplaced(effect.name, reason));
        }
        let own = Section::new(document, format!("effect.{}", effect.name));
        let parameters = effect.parameters(&blank());
        let names: Vec<&str> = parameters.iter().map(|p| p.quantity.name).collect();
        if let Some(key) = given.keys().find(|key| !names.contains(&key.as_str())) {
            let expected = format!("one of {}", names.join(", "));
            return Err(own.refuse(key, "an unknown number".to_owned(), expected));
        }
        let mut values = Vec::new();
        for parameter in parameters {
            let name = parameter.quantity.name;
            let value = given
                .get(name)
                .ok_or_else(|| own.missing(name, "all numbers of the effect to be given"))?;
            if !value.is_finite() {
                return Err(own.refuse(name, value.to_string(), "a finite number".to_owned()));
            }
            values.push(*value);
        }
        effects.push((effect, values));
    }
    Ok(effects)
}

/// Adds effects to a cell's description.
pub fn apply(effects: &[(&'static Effect, Vec<f64>)], plant: &mut PlantParameters) {
    for (effect, values) in effects {
        for (parameter, value) in effect.parameters(plant).iter().zip(values) {
            parameter.quantity.set(plant, *value);
        }
    }
}

/// The file with effects that were found in place of those it names already; its paths made absolute, as it goes elsewhere.
///
/// # Errors
/// The file cannot be read any more as it was.
pub fn improved_cell_text(
    cell: &RecordedCell,
    found: &[FoundNumbers],
) -> Result<String, ScenarioError> {
    let mut document: DocumentMut =
        cell.text
            .parse()
            .map_err(|error: toml_edit::TomlError| ScenarioError::Read {
                file: cell.path.clone(),
                source: std::io::Error::other(error.message().to_owned()),
            })?;
    let folder = cell.path.parent().unwrap_or(Path::new(""));
    let absolute = |path: &str| {
        let full = folder.join(path);
        full.canonicalize().unwrap_or(full).display().to_string()
    };
    for (table, key) in [("arm", "urdf"), ("device", "model"), ("workpiece", "mesh")] {
        if let Some(path) = document[table][key].as_str() {
            let path = absolute(path);
            document[table][key] = value(path);
        }
    }
    if let Some(packages) = document["arm"]
        .get_mut("packages")
        .and_then(Item::as_table_like_mut)
    {
        for (_, folder) in packages.iter_mut() {
            if let Some(path) = folder.as_str() {
                *folder = value(absolute(path));
            }
        }
    }
    if !found.is_empty() {
        let effects = document
            .entry("effect")
            .or_insert(Item::Table(Table::new()));
        if let Some(effects) = effects.as_table_mut() {
            effects.set_implicit(true);
            for (name, numbers) in found {
                let mut table = Table::new();
                for (name, number, [low, high]) in numbers {
                    let mut item = toml_edit::Value::from(*number);
                    let suffix = format!(" # {low:.4e} to {high:.4e}");
                    item.decor_mut().set_suffix(suffix);
                    table.insert(name, Item::Value(item));
                }
                effects.insert(name, Item::Table(table));
            }
        }
    }
    Ok(document.to_string())
}
