//! `[device]` of a device model file, and `[device.override]` of a scenario: the registered numbers in the units of their keys, and what the gas does.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use serde_json::{Map, json};

use crate::plant::registry;

/// The one key that is no number.
const GAS_PROCESS: &str = "gas_process";

/// All keys.
static KEYS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    let numbers = registry::all().filter_map(|number| number.device_key);
    numbers.chain([GAS_PROCESS]).collect()
});

/// The table.
#[derive(Debug, Default)]
pub(in super::super) struct ModelKeys {
    /// By its key, in the key's unit.
    pub numbers: BTreeMap<&'static str, f64>,
    pub gas_process: Option<GasProcessKind>,
}

/// Process of the gas under compression.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in super::super) enum GasProcessKind {
    /// Constant temperature.
    Isothermal,
    /// Heats up, exchanges heat with the wall.
    WallHeat,
}

/// Whether its number is a whole one.
fn is_count(key: &str) -> bool {
    registry::CYLINDER_COUNT.device_key == Some(key)
}

impl<'de> Deserialize<'de> for ModelKeys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_struct("ModelKeys", &KEYS, Keys)
    }
}

/// Reads the table, and one of its keys.
struct Keys;

impl<'de> Visitor<'de> for Keys {
    type Value = ModelKeys;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("struct ModelKeys")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ModelKeys, A::Error> {
        let mut keys = ModelKeys::default();
        while let Some(key) = map.next_key_seed(Key)? {
            if key == GAS_PROCESS {
                keys.gas_process = Some(map.next_value()?);
            } else if is_count(key) {
                keys.numbers
                    .insert(key, f64::from(map.next_value::<u32>()?));
            } else {
                keys.numbers.insert(key, map.next_value()?);
            }
        }
        Ok(keys)
    }
}

struct Key;

impl<'de> DeserializeSeed<'de> for Key {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<&'static str, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Key {
    type Value = &'static str;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<&'static str, E> {
        let known = KEYS.iter().find(|key| **key == name);
        known.copied().ok_or_else(|| E::unknown_field(name, &KEYS))
    }
}

impl JsonSchema for ModelKeys {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "ModelKeys".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut properties = Map::new();
        for key in KEYS.iter() {
            let kind = match is_count(key) {
                true => "integer",
                false => "number",
            };
            properties.insert((*key).to_owned(), json!({ "type": kind }));
        }
        let choice = generator.subschema_for::<GasProcessKind>();
        properties.insert(GAS_PROCESS.to_owned(), choice.into());
        json_schema!({
            "description": "`[device]` of a device model file, and `[device.override]` of a scenario.",
            "type": "object",
            "properties": properties,
            "additionalProperties": false,
        })
    }
}
