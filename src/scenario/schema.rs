//! JSON Schemas of the files, for editors, made of the keys as they are declared.

mod described;
pub(super) mod page;
pub(super) mod plain;
mod rig;

use serde_json::{Map, Value, json};

pub(crate) use described::Described;
#[cfg(feature = "import")]
pub(crate) use page::key_rows;
pub(crate) use plain::plain_schema;
pub use rig::schema as rig;

use super::bench_file::BenchFile;
use super::file::{ModelFile, ScenarioFile};
use super::keys::{Filled, Table};
use super::recorded_cell::RecordedCellFile;
use described::DIALECT;

/// Schema of a scenario file of any kind.
#[must_use]
pub fn scenario() -> Value {
    let is =
        |kind: &str| json!({ "properties": { "kind": { "const": kind } }, "required": ["kind"] });
    json!({
        "$schema": DIALECT,
        "title": "A scenario of idc: a robot cell, a bench (kind = \"bench\") or a recorded cell (kind = \"recorded_cell\")",
        "type": "object",
        "if": is("bench"),
        "then": BenchFile::schema(),
        "else": { "if": is("recorded_cell"), "then": RecordedCellFile::schema(), "else": ScenarioFile::schema() },
    })
}

/// Schema of a device model file.
#[must_use]
pub fn device() -> Value {
    of_file::<ModelFile>("A device model file of idc")
}

/// Schema of a kind of file by itself.
pub(crate) fn of_file<T: Table>(title: &str) -> Value {
    let mut schema = T::schema();
    schema["$schema"] = DIALECT.into();
    schema["title"] = title.into();
    schema
}

/// Gives each key of a schema what `of` knows of it, by its table's dotted name and its own.
pub(crate) fn describe(mut schema: Value, of: impl Fn(&str, &str) -> Option<Described>) -> Value {
    describe_table(&mut schema, "", &of);
    schema
}

fn describe_table(schema: &mut Value, table: &str, of: &impl Fn(&str, &str) -> Option<Described>) {
    let Some(Value::Object(properties)) = schema.get_mut("properties") else {
        return;
    };
    for (key, property) in properties {
        if let (Some(described), Value::Object(property)) = (of(table, key), &mut *property) {
            apply(property, &described);
        }
        let below = super::suggestion::join(table, key);
        if let Value::Object(property) = &mut *property {
            let heading = match property.contains_key("items") {
                true => format!("Tables [[{below}]]."),
                false => format!("Table [{below}]."),
            };
            let bare = !property.contains_key("description");
            if bare
                && (property.contains_key("items") || property.contains_key("additionalProperties"))
            {
                property.insert("description".to_owned(), heading.into());
            }
        }
        match property.get_mut("items") {
            Some(items) => describe_table(items, &below, of),
            None => describe_table(property, &below, of),
        }
    }
}

fn apply(property: &mut Map<String, Value>, described: &Described) {
    property.insert("description".to_owned(), described.text.clone().into());
    if let Some(default) = &described.default {
        property.insert("default".to_owned(), default.clone());
    }
    let number = match property.get_mut("items") {
        Some(Value::Object(items)) => items,
        _ => property,
    };
    let is_number = number
        .get("type")
        .is_some_and(|kind| kind == "number" || kind == "integer");
    if is_number {
        for (name, bound) in ["minimum", "maximum"].into_iter().zip(described.range) {
            if let Some(bound) = bound {
                number.insert(name.to_owned(), bound.into());
            }
        }
    }
}
