//! The scenario file of a recorded cell with what a diagnosis found.

use std::path::Path;

use toml_edit::{DocumentMut, Item, value};

use super::super::effects::{WrittenEffect, append, remove_effects};
use super::RecordedCell;
use crate::keys::error::ScenarioError;

/// The file with these effects and no others; its paths made absolute, as it goes elsewhere.
///
/// # Errors
/// The file cannot be read any more as it was.
pub fn improved_cell_text(
    cell: &RecordedCell,
    effects: &[WrittenEffect<'_>],
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
    if !effects.is_empty() {
        remove_effects(&mut document);
    }
    let mut text = document.to_string();
    for effect in effects {
        append(&mut text, effect);
    }
    Ok(text)
}
