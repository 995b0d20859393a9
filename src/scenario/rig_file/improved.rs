//! An improved rig file: the believed one with the values that a diagnosis found, in its own order and with its own comments, and the physics found below them.

use std::fmt::Write as _;

use toml_edit::{DocumentMut, InlineTable, Item, Value};

use super::values::plain;
use super::{RigFile, latent};
use crate::effects::{Effect, meaning};
use crate::plant::Latent;

/// An effect with all its numbers, reported or not, as [`Effect::parameters`] lists them.
#[derive(Debug, Clone)]
pub struct ImprovedEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Name, value and, where it is known, 95 % interval of each [SI].
    pub parameters: Vec<(&'static str, f64, Option<[f64; 2]>)>,
}

/// The value that a reader of the file gets: nine significant digits. Six of a frequency of 120 Hz turn its phase by 0.04 rad in ten seconds, and the model in
/// the file is then another one than that whose errors the report states.
#[must_use]
pub fn as_written(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

/// Text of the improved file. `tolerated` are key (as in [`super::Tolerance`]), value, low and high of what was moved; what is not among them stands as it did.
/// `effects` and `unnamed` are all that the improved rig has.
#[must_use]
pub fn improved_text(
    rig: &RigFile,
    tolerated: &[(&str, f64, f64, f64)],
    effects: &[ImprovedEffect],
    unnamed: Option<&Latent>,
) -> String {
    let mut document: DocumentMut = rig
        .text
        .parse()
        .expect("the text was read as TOML when the rig was loaded");
    for (key, value, low, high) in tolerated {
        if let Some((table, key)) = key.split_once('.') {
            improve(&mut document[table][key], *value, [*low, *high]);
        }
    }
    document.remove("effect");
    document.remove(latent::TABLE);
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

fn append(text: &mut String, improved: &ImprovedEffect) {
    let name = improved.effect.name;
    // Writing into a text cannot fail.
    let _ = writeln!(text, "\n# Found: {}.\n[effect.{name}]", meaning(name));
    for (key, value, interval) in &improved.parameters {
        let value = plain(as_written(*value));
        let _ = match interval {
            None => writeln!(text, "{key} = {value}"),
            Some([low, high]) => writeln!(
                text,
                "{key} = {{ value = {value}, low = {}, high = {} }}",
                plain(as_written(*low)),
                plain(as_written(*high))
            ),
        };
    }
}
