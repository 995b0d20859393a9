//! JSON Schemas of the files, for editors: structure and choices of values from the types that serde fills, meaning, units, ranges and defaults from the
//! pages that describe the keys (which the tests hold against the program).

mod described;
pub(super) mod page;
mod rig;

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

pub(crate) use described::Described;
#[cfg(feature = "import")]
pub(crate) use page::key_rows;
pub use rig::schema as rig;

use super::bench_file::BenchFile;
use super::file::{ModelFile, ScenarioFile};
use super::recorded_cell::RecordedCellFile;
use described::DIALECT;

/// Schema of a scenario file of any kind.
#[must_use]
pub fn scenario() -> Value {
    let of = |schema: Value, chapters: &'static [&'static str]| {
        let rows = page::scenario_rows(chapters);
        describe(schema, |table, key| {
            let dotted = super::suggestion::join(table, key);
            rows.get(&dotted).map(page::Row::described)
        })
    };
    let is =
        |kind: &str| json!({ "properties": { "kind": { "const": kind } }, "required": ["kind"] });
    let mut cell = of(plain_schema::<ScenarioFile>(), &page::CELL);
    let mut bench = of(plain_schema::<BenchFile>(), &page::BENCH);
    let mut recorded = of(plain_schema::<RecordedCellFile>(), &page::RECORDED_CELL);
    for schema in [&mut cell, &mut bench, &mut recorded] {
        strip_heading(schema);
    }
    json!({
        "$schema": DIALECT,
        "title": "A scenario of idc: a robot cell, a bench (kind = \"bench\") or a recorded cell (kind = \"recorded_cell\")",
        "type": "object",
        "if": is("bench"),
        "then": bench,
        "else": { "if": is("recorded_cell"), "then": recorded, "else": cell },
    })
}

/// Schema of a device model file.
#[must_use]
pub fn device() -> Value {
    let rows = page::scenario_rows(&page::CELL);
    describe(plain_schema::<ModelFile>(), |table, key| {
        // The page describes them where a scenario overrides them.
        let row = rows.get(&format!("{table}.override.{key}"))?;
        Some(row.described())
    })
}

/// A type's own schema, each table in its place and without what TOML does not have.
pub(crate) fn plain_schema<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
    let schema = settings.into_generator().into_root_schema_for::<T>();
    let mut schema = schema.to_value();
    tidy(&mut schema);
    schema
}

/// Takes out nulls, widths of numbers and defaults of whole tables.
fn tidy(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            object.remove("format");
            let told = |default: &Value| default.is_number() || default.is_string();
            if !object.get("default").is_some_and(told) {
                object.remove("default");
            }
            if let Some(Value::Array(types)) = object.get_mut("type") {
                types.retain(|name| name != "null");
                if let [only] = &types[..] {
                    let only = only.clone();
                    object.insert("type".to_owned(), only);
                }
            }
            let alone = object
                .get("anyOf")
                .and_then(Value::as_array)
                .and_then(|any| {
                    let is_null = |one: &&Value| one["type"] == "null";
                    let mut others = any.iter().filter(|one| !is_null(one));
                    let first = others.next()?;
                    (others.next().is_none() && any.len() == 2).then(|| first.clone())
                });
            if let Some(Value::Object(alone)) = alone {
                object.remove("anyOf");
                for (key, value) in alone {
                    object.entry(key).or_insert(value);
                }
            }
            if let Some(Value::Array(values)) = object.get_mut("enum") {
                values.retain(|value| !value.is_null());
            }
            object.values_mut().for_each(tidy);
        }
        Value::Array(elements) => elements.iter_mut().for_each(tidy),
        _ => {}
    }
}

fn strip_heading(schema: &mut Value) {
    if let Some(object) = schema.as_object_mut() {
        object.remove("$schema");
        object.remove("title");
    }
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
