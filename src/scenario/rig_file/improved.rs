//! An improved rig file: the nominal one with the values that a diagnosis found, in its own order and with its own comments, and the physics found below them.

use toml_edit::{Array, DocumentMut, InlineTable, Item, Value};

use super::super::effects::{WrittenEffect, append, as_written, remove_effects};
use super::{Known, RigFile, flange, known, latent};
use crate::flange::FittedFlange;
use crate::keys::check::plain;
use crate::plant::Latent;

/// What an improved file has beyond the nominal one.
#[derive(Debug, Clone, Copy, Default)]
pub struct Improved<'a> {
    /// Key (as in [`super::Tolerance`]), value, low and high of what was moved; what is not among them stands as it did.
    pub tolerated: &'a [(&'a str, f64, f64, f64)],
    /// All effects of the improved rig.
    pub effects: &'a [WrittenEffect<'a>],
    /// Its model discrepancy.
    pub unnamed: Option<&'a Latent>,
    /// How sure all of that is.
    pub known: Option<&'a Known>,
    /// A contact flange as it was fitted.
    pub flange: Option<&'a FittedFlange>,
}

/// Text of a rig file with other recordings to diagnose from, and none to predict.
#[must_use]
pub fn text_with_recordings(rig: &RigFile, names: &[String]) -> String {
    let mut document: DocumentMut = rig
        .text
        .parse()
        .expect("the text was read as TOML when the rig was loaded");
    let names: Array = names.iter().map(String::as_str).collect();
    document["recordings"]["fit"] = Item::Value(Value::Array(names));
    if let Some(table) = document["recordings"].as_table_like_mut() {
        table.remove("predict");
    }
    document.to_string()
}

/// Text of the improved file.
#[must_use]
pub fn improved_text(rig: &RigFile, improved: &Improved<'_>) -> String {
    let Improved {
        tolerated,
        effects,
        unnamed,
        known,
        flange,
    } = *improved;
    let mut document: DocumentMut = rig
        .text
        .parse()
        .expect("the text was read as TOML when the rig was loaded");
    for (key, value, low, high) in tolerated {
        if let Some((table, key)) = key.split_once('.') {
            improve(&mut document[table][key], *value, [*low, *high]);
        }
    }
    if !(effects.is_empty() && rig.effects.is_empty()) {
        remove_effects(&mut document);
    }
    document.remove(latent::TABLE);
    document.remove(known::TABLE);
    document.remove(flange::TABLE);
    let mut text = document.to_string();
    if !text.ends_with('\n') {
        text.push('\n');
    }
    for improved in effects {
        append(&mut text, improved);
    }
    if let Some(unnamed) = unnamed {
        text.push_str(&latent::text(unnamed));
    }
    if let Some(known) = known {
        text.push_str(&known::text(known));
    }
    if let Some(flange) = flange {
        text.push_str(&flange::text(flange));
    }
    text
}

/// Puts a value with its interval in place of a number, whose comment stays.
fn improve(item: &mut Item, value: f64, [low, high]: [f64; 2]) {
    let mut table = InlineTable::new();
    for (key, number) in [("value", value), ("low", low), ("high", high)] {
        table.insert(key, number_of(number));
    }
    let mut new = Value::InlineTable(table);
    if let Some(old) = item.as_value() {
        *new.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(new);
}

/// A number as the file shows it.
fn number_of(value: f64) -> Value {
    plain(as_written(value))
        .parse()
        .unwrap_or_else(|_| value.into())
}
