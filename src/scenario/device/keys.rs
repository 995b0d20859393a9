//! `[device]` of a device model file, and `[device.override]` of a scenario: the registered numbers in the units of their keys, and what the gas does.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

use crate::keys::declaration::{Below, Filled, Key, Name, Plain, Table, table_schema};
use crate::plant::registry;
use crate::unit::Unit;

/// The one key that is no number.
const GAS_PROCESS: &str = "gas_process";

/// All keys.
static KEYS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    let numbers = registry::all().filter_map(|number| number.device_key);
    numbers.chain([GAS_PROCESS]).collect()
});

/// The table.
#[derive(Debug, Clone, Default, PartialEq)]
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

impl Plain for GasProcessKind {}

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
        while let Some(key) = map.next_key_seed(Name(&KEYS))? {
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

/// The defaults of the device.
static DEFAULTS: LazyLock<toml::Table> = LazyLock::new(|| {
    const MODEL: &str = include_str!("../../../models/device.toml");
    let model: toml::Table = MODEL.parse().unwrap_or_default();
    let device = model.get("device").and_then(toml::Value::as_table);
    device.cloned().unwrap_or_default()
});

impl Table for ModelKeys {
    fn keys() -> Vec<Key> {
        let numbers = registry::all().filter_map(|number| {
            let name = number.device_key?;
            let key = match is_count(name) {
                true => Key::new::<u32>(name, number.meaning),
                false => Key::new::<f64>(name, number.meaning),
            };
            Some(key.known(number))
        });
        let gas = "what the air in the chambers does as it is compressed: keeps its temperature, or warms up and trades heat with the walls";
        let keys = numbers.chain([Key::new::<GasProcessKind>(GAS_PROCESS, gas)]);
        let with_default = |key: Key| match DEFAULTS.get(key.name) {
            Some(default) => key.by_default(default.clone()),
            None => key,
        };
        keys.map(with_default).collect()
    }
}

impl Filled for ModelKeys {
    type Written = Self;
    const BELOW: Option<Below> = Some(Below::of::<Self>());

    fn filled(written: Self, _: Unit) -> Result<Self, &'static str> {
        Ok(written)
    }

    fn schema() -> serde_json::Value {
        let about = "`[device]` of a device model file, and `[device.override]` of a scenario.";
        table_schema(about, &Self::keys())
    }
}
