//! Effects written into a file, as a diagnosis ends: `[[effect]]` with every number and its interval.

use std::fmt::Write as _;

use toml_edit::{DocumentMut, value};

use super::keys::LISTED;
use super::own::{ACTS_ON, IS};
use crate::effects::{Effect, UNLISTED, meaning};
use crate::keys::check::plain;
use crate::plant::LawText;

/// An effect with all its numbers, reported or not, as [`Effect::parameters`] lists them.
#[derive(Debug, Clone)]
pub struct WrittenEffect<'a> {
    /// The effect.
    pub effect: &'static Effect,
    /// The law, of an effect that a user wrote.
    pub law: Option<&'a LawText>,
    /// Name, value and, where it is known, 95 % interval of each [SI].
    pub parameters: Vec<(&'static str, f64, Option<[f64; 2]>)>,
}

/// The value that a reader of the file gets: nine significant digits. Six of a frequency of 120 Hz turn its phase by 0.04 rad in ten seconds, and the model in
/// the file is then another one than that whose errors the report states.
#[must_use]
pub fn as_written(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

/// Takes out a document's effects, which are then written anew, and says that it is of the version that has them as a list.
pub(in super::super) fn remove_effects(document: &mut DocumentMut) {
    document.remove("effect");
    if let Some(schema) = document
        .get_mut("schema")
        .and_then(|item| item.as_value_mut())
        && schema.as_integer().is_some_and(|found| found < LISTED)
    {
        let decor = schema.decor().clone();
        *schema = value(LISTED).into_value().unwrap_or_else(|_| LISTED.into());
        *schema.decor_mut() = decor;
    }
}

/// Appends an effect to a file's text.
pub(in super::super) fn append(text: &mut String, written: &WrittenEffect<'_>) {
    let (name, joint) = written.effect.vocabulary();
    if !text.is_empty() && !text.ends_with('\n') {
        text.push('\n');
    }
    let said = written
        .law
        .filter(|law| law.name != UNLISTED)
        .map_or_else(|| meaning(written.effect.name), |_| "a law of your own");
    // Writing into a text cannot fail.
    let _ = writeln!(text, "\n# Found: {said}.\n[[effect]]\nname = \"{name}\"");
    if let Some(joint) = joint {
        let _ = writeln!(text, "joint = {joint}");
    }
    if let Some(law) = written.law {
        let _ = writeln!(text, "{ACTS_ON} = \"{}\"", law.port.name());
        let _ = writeln!(
            text,
            "{IS} = {}",
            toml_edit::Value::from(law.expression.text())
        );
    }
    let number = |value: f64| plain(as_written(value));
    for (key, value, interval) in &written.parameters {
        let constant = written
            .law
            .and_then(|law| law.constants.iter().find(|c| c.name == *key));
        let known = interval
            .iter()
            .map(|[low, high]| format!("low = {}, high = {}", number(*low), number(*high)));
        let range = constant
            .and_then(|c| c.range)
            .map(|[min, max]| format!("min = {}, max = {}", plain(min), plain(max)));
        let unit = constant
            .and_then(|c| c.unit)
            .map(|unit| format!("unit = \"{unit}\""));
        let beside: Vec<String> = known.chain(range).chain(unit).collect();
        let value = number(*value);
        let _ = match &beside[..] {
            [] => writeln!(text, "{key} = {value}"),
            beside => writeln!(text, "{key} = {{ value = {value}, {} }}", beside.join(", ")),
        };
    }
    for constant in written.law.iter().flat_map(|law| &law.constants) {
        if written
            .parameters
            .iter()
            .any(|(key, _, _)| *key == constant.name)
        {
            continue;
        }
        let value = plain(constant.value);
        let _ = match constant.unit {
            None => writeln!(text, "{} = {value}", constant.name),
            Some(unit) => writeln!(
                text,
                "{} = {{ value = {value}, unit = \"{unit}\" }}",
                constant.name
            ),
        };
    }
}
