//! A candidate design, and what an evaluation of it gives.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Serialize, SerializeMap, Serializer};

use crate::scenario::KeyValue;

/// Keys of a device or of a table of the scenario with the values that a candidate gives them, in each key's own unit.
///
/// A key without a dot is one of `[device.override]`; `process.name` is the key `name` of `[process]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    entries: Vec<(String, f64)>,
}

/// Key of a scenario file for a key of a design.
pub(super) fn scenario_key(key: &str) -> String {
    if key.contains('.') {
        key.to_owned()
    } else {
        format!("device.override.{key}")
    }
}

impl Design {
    /// A design from its keys, in this order.
    pub fn new(entries: Vec<(String, f64)>) -> Self {
        Self { entries }
    }

    /// The design with further keys, which come after its own and take their place.
    #[must_use]
    pub fn with(&self, further: impl IntoIterator<Item = (String, f64)>) -> Self {
        let own = self.entries.iter().cloned();
        Self::new(own.chain(further).collect())
    }

    /// Its keys and values, in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, f64)> {
        self.entries
            .iter()
            .map(|(key, value)| (key.as_str(), *value))
    }

    /// Value of a key, if the design gives it.
    pub fn get(&self, key: &str) -> Option<f64> {
        self.iter()
            .find(|(known, _)| *known == key)
            .map(|(_, value)| value)
    }

    /// Its values by the dotted keys that a scenario file has for them.
    pub fn scenario_values(&self) -> Vec<KeyValue> {
        self.iter()
            .map(|(key, value)| KeyValue::number(scenario_key(key), value))
            .collect()
    }

    /// The design as TOML that a scenario file takes as it stands.
    pub fn override_text(&self) -> String {
        let mut tables: BTreeMap<String, String> = BTreeMap::new();
        for (key, value) in self.iter() {
            let key = scenario_key(key);
            let (table, name) = key.rsplit_once('.').unwrap_or_default();
            let lines = tables.entry(table.to_owned()).or_default();
            // Writing to a String cannot fail.
            let _ = writeln!(lines, "{name} = {value}");
        }
        // The device before its controller.
        let mut ordered: Vec<_> = tables.into_iter().collect();
        ordered.sort_by_key(|(table, _)| table != "device.override");
        let blocks: Vec<String> = ordered
            .into_iter()
            .map(|(table, lines)| format!("[{table}]\n{lines}"))
            .collect();
        blocks.join("\n")
    }
}

impl Serialize for Design {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.entries.len()))?;
        for (key, value) in &self.entries {
            map.serialize_entry(key, value)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Design {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = Design;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("numbers by key")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Design, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Design::new(entries))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}

/// Results of a design in one scenario.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ScenarioOutcome {
    /// Name of the scenario, as it is shown.
    pub name: String,
    /// Metrics by name, unit included; one that the run does not determine is left out.
    pub metrics: BTreeMap<String, f64>,
}

/// Results of a design in all scenarios of a study.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Outcome {
    /// Least and greatest force that the device can be relied upon to give at rest [N].
    #[serde(rename = "force_range_n")]
    pub force_range: [f64; 2],
    /// One a scenario, in the order of the study.
    pub scenarios: Vec<ScenarioOutcome>,
}

/// Why a candidate could not be evaluated: a run that stopped, or values that no device can have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{detail}")]
pub struct EvaluateError {
    /// The same words for the same cause, without numbers: candidates are counted by it.
    pub reason: String,
    /// The whole sentence.
    pub detail: String,
}

/// Whatever can evaluate a candidate.
pub trait Evaluate: Sync {
    /// Simulates the study's scenarios with a design.
    ///
    /// Called from several threads at once; the same design must always give the same outcome.
    ///
    /// # Errors
    /// The candidate is infeasible; the search goes on without it.
    fn evaluate(&self, design: &Design) -> Result<Outcome, EvaluateError>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_override_text_is_toml_with_each_key_in_its_table() {
        let design = Design::new(vec![
            ("bore_mm".into(), 40.0),
            ("controller.integral_time_s".into(), 0.25),
            ("dead_volume_cm3".into(), 12.5),
        ]);
        let text = design.override_text();
        assert_eq!(
            text,
            "[device.override]\nbore_mm = 40\ndead_volume_cm3 = 12.5\n\n[controller]\nintegral_time_s = 0.25\n"
        );
        let table: toml::Table = text.parse().unwrap();
        assert_eq!(
            table["device"]["override"]["dead_volume_cm3"].as_float(),
            Some(12.5)
        );
        assert_eq!(design.get("bore_mm"), Some(40.0));
    }
}
