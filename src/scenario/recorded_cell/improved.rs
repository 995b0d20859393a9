//! The scenario file of a recorded cell with what a diagnosis found.

use std::path::Path;

use toml_edit::{DocumentMut, Item, value};

use super::super::effects::{WrittenEffect, append, remove_effects};
use super::RecordedCell;
use crate::keys::error::ScenarioError;

/// The file with these effects and no others; its paths made absolute, as it goes elsewhere. An arm file in place of its own stands beside it.
///
/// # Errors
/// The file cannot be read any more as it was.
pub fn improved_cell_text(
    cell: &RecordedCell,
    effects: &[WrittenEffect<'_>],
    arm_file: Option<&str>,
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
    let files = [
        ("arm", "urdf"),
        ("arm", "recorded_arm"),
        ("device", "model"),
        ("workpiece", "mesh"),
    ];
    for (table, key) in files {
        let given = document.get(table).and_then(|table| table.get(key));
        if let Some(path) = given.and_then(Item::as_str) {
            let path = absolute(path);
            document[table][key] = value(path);
        }
    }
    if let Some(name) = arm_file {
        document["arm"]["recorded_arm"] = value(name);
        // The file beside it holds them, as they were found.
        if let Some(arm) = document["arm"].as_table_like_mut() {
            arm.remove("effect");
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
