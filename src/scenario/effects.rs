//! `[[effect]]` of a file, the same in a cell, a bench, a recorded cell and a rig: physics beyond the nominal model, of the catalogue or as an expression.
//!
//! ```text
//! [[effect]]
//! name = "joint_friction"             of the catalogue, with all its numbers
//! joint = 3                           of an effect of one joint
//! friction_n_m = 20
//!
//! [[effect]]
//! name = "one_way_damping"            a name of one's own
//! acts_on = "piston_force"
//! is = "-c * max(v, 0)"
//! c = { value = 200, min = 0, max = 1000, unit = "N s/m" }
//! ```
//!
//! A file of schema 1 has `[effect.NAME]` with its numbers instead, and names the joint at the end of NAME.

mod keys;
mod own;
mod schema;
mod tried;
mod value;
mod written;

use crate::effects::{Effect, Parameter, PresentEffect};
use crate::keys::check::{Section, checked};
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::keys::suggestion::{join, nearest};
use crate::plant::PlantParameters;
use crate::unit::Unit;
use keys::{JOINT, KeyTable, LISTED, NAME};

pub(super) use keys::EffectKeys;
pub(super) use value::EffectValue;

pub(super) use schema::schema;
pub use tried::{LineError, law_of_line};
pub use written::{WrittenEffect, as_written};
pub(super) use written::{append, remove_effects};

/// The effects of a file on a model without them, in the order of the catalogue and then as they are written. `known` are those that it may have.
pub(super) fn effects(
    document: &Document<'_>,
    keys: &EffectKeys,
    known: &[&'static Effect],
    plant: &PlantParameters,
) -> Result<Vec<PresentEffect>, ScenarioError> {
    let mut found: Vec<PresentEffect> = Vec::new();
    let mut laws = plant.own.len();
    for (key, named, table) in tables(document, keys)? {
        let section = Section::new(document, key.as_str());
        if table.contains_key(own::IS) || table.contains_key(own::ACTS_ON) {
            let law = own::law(&section, table, known)?;
            found.push(PresentEffect {
                effect: crate::effects::own_effect(&law, laws),
                values: own::free_values(&law),
                law: Some(law.into()),
                key,
            });
            laws += 1;
            continue;
        }
        let effect = match named {
            Some(name) => named_effect(document, &key, name, known)?,
            None => listed_effect(&section, table, known)?,
        };
        if let Some(other) = found.iter().find(|other| other.effect.excludes(effect)) {
            let reason = format!("{} stands in its place already", other.effect.name);
            return Err(section_of_name(document, &key, named).misplaced_itself(reason));
        }
        found.push(PresentEffect {
            effect,
            values: values(&section, effect, table, plant)?,
            law: None,
            key,
        });
    }
    let order = |effect: &Effect| known.iter().position(|known| known.name == effect.name);
    found.sort_by_key(|present| order(present.effect).unwrap_or(known.len()));
    Ok(found)
}

/// The table itself, as what a refusal is about.
fn section_of_name<'a>(document: &'a Document<'a>, key: &str, named: Option<&str>) -> Section<'a> {
    match named {
        Some(_) => Section::new(document, key),
        None => Section::new(document, join(key, NAME)),
    }
}

/// Key, name if the key says it, and content of each effect.
type Entries<'k> = Vec<(String, Option<&'k str>, &'k KeyTable)>;

fn tables<'k>(document: &Document<'_>, keys: &'k EffectKeys) -> Result<Entries<'k>, ScenarioError> {
    let named = match keys {
        EffectKeys::List(list) => {
            let tables = list.iter().enumerate();
            return Ok(tables
                .map(|(index, table)| (format!("effect[{index}]"), None, table))
                .collect());
        }
        EffectKeys::Named(named) => named,
    };
    if document.schema() >= LISTED
        && let Some((name, table)) = named.iter().next()
    {
        let key = join("effect", name);
        let (name, joint) = crate::effects::vocabulary(name);
        let mut form = format!("[[effect]] with name = \"{name}\"");
        if let Some(joint) = joint {
            form += &format!(", joint = {joint}");
        }
        for (key, value) in table {
            form += &format!(", {key} = {value}");
        }
        return Err(ScenarioError::Value {
            location: document.key_location(&key),
            key,
            found: "the form of schema 1".to_owned(),
            expected: format!("{form}, each on a line of its own"),
        });
    }
    let entries = named.iter();
    Ok(entries
        .map(|(name, table)| (join("effect", name), Some(name.as_str()), table))
        .collect())
}

/// The effect that a table is named after.
fn named_effect(
    document: &Document<'_>,
    key: &str,
    name: &str,
    known: &[&'static Effect],
) -> Result<&'static Effect, ScenarioError> {
    let found = known.iter().find(|effect| effect.name == name);
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|effect| effect.name).collect();
        ScenarioError::UnknownKey {
            location: document.key_location(key),
            key: key.to_owned(),
            advice: nearest(name, &names),
        }
    })
}

/// The effect that a table of the list names.
fn listed_effect(
    section: &Section<'_>,
    table: &KeyTable,
    known: &[&'static Effect],
) -> Result<&'static Effect, ScenarioError> {
    let name = own::text(section, table, NAME, "the effect's name, of `idc effects`")?;
    let alike: Vec<&'static Effect> = (known.iter().copied())
        .filter(|effect| effect.vocabulary().0 == name)
        .collect();
    let [first, ..] = &alike[..] else {
        let mut names: Vec<&str> = known.iter().map(|effect| effect.vocabulary().0).collect();
        names.dedup();
        let expected = format!(
            "an effect that can be here, or `{}` and `{}` for a law of your own; {}",
            own::ACTS_ON,
            own::IS,
            nearest(name, &names)
        );
        return Err(section.refuse(NAME, format!("{name:?}"), expected));
    };
    let Some(number) = table.get(JOINT) else {
        return match first.vocabulary() {
            (_, None) => Ok(first),
            (_, Some(_)) => Err(section.missing(JOINT, "the number of the joint, from 1")),
        };
    };
    let expected = match first.vocabulary() {
        (_, None) => {
            let reason = format!("{name} is not of a joint");
            return Err(section.misplaced(JOINT, reason));
        }
        (_, Some(_)) => format!("a whole number, 1 to {}", alike.len()),
    };
    let joint = number.number().map(|number| number.value);
    let of_joint = alike.iter().find(|effect| {
        let own = effect.vocabulary().1.map(|own| own as f64);
        own.is_some() && own == joint
    });
    of_joint
        .copied()
        .ok_or_else(|| section.refuse(JOINT, number.to_string(), expected))
}

/// All numbers of an effect of the catalogue, in any unit of theirs.
fn values(
    section: &Section<'_>,
    effect: &Effect,
    table: &KeyTable,
    plant: &PlantParameters,
) -> Result<Vec<f64>, ScenarioError> {
    let parameters = effect.parameters(plant);
    let names: Vec<&str> = parameters.iter().map(|p| p.quantity.name).collect();
    let means = |key: &str, name: &str| Unit::convert(key, 1.0, name).is_some();
    for key in table.keys().filter(|key| ![NAME, JOINT].contains(&&***key)) {
        if !names.iter().any(|name| means(key, name)) {
            let dotted = section.dotted(key);
            return Err(ScenarioError::UnknownKey {
                location: section.document().key_location(&dotted),
                key: dotted,
                advice: nearest(key, &names),
            });
        }
    }
    let value = |parameter: &Parameter| {
        let name = parameter.quantity.name;
        let mut given = table.iter().filter(|(key, _)| means(key, name));
        let (key, value) = (given.next())
            .ok_or_else(|| section.missing(name, "every number of the effect to be given"))?;
        if let Some((again, _)) = given.next() {
            return Err(section.misplaced(again, format!("{key} says it already")));
        }
        let number = value.number().ok_or_else(|| {
            let expected = "a number, or { value, low, high }".to_owned();
            section.refuse(key, value.to_string(), expected)
        })?;
        number.check(&Section::new(section.document(), section.dotted(key)))?;
        let bounds = widened(parameter.bounds);
        // A range in the key's own unit.
        let unit = Unit::convert(key, 1.0, name).unwrap_or(1.0);
        checked(section, key, number.value, bounds.map(|bound| bound / unit))?;
        Ok(number.value * unit)
    };
    parameters.iter().map(value).collect()
}

/// Twice as far as a fit looks: a file may hold a value at a bound, rounded, or know of a device beyond it.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let low = if low > 0.0 { 0.5 * low } else { 2.0 * low };
    let high = if high > 0.0 { 2.0 * high } else { 0.5 * high };
    [low, high]
}
