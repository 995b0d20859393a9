//! JSON Schema of a type as `schemars` derives it.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

/// The dialect that editors for TOML know.
pub(crate) const DIALECT: &str = "http://json-schema.org/draft-07/schema#";

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
            let stated = |default: &Value| default.is_number() || default.is_string();
            if !object.get("default").is_some_and(stated) {
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

/// A type's own schema without what only a whole file's has.
pub(crate) fn type_schema<T: schemars::JsonSchema>() -> Value {
    let mut schema = plain_schema::<T>();
    if let Some(object) = schema.as_object_mut() {
        object.remove("$schema");
        object.remove("title");
    }
    schema
}
