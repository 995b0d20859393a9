//! JSON Schema of a rig file: its tables hold numbers by key, which are not fields of a type.

use serde_json::{Map, Value, json};

use super::super::rig_file::{LimitsKeys, PartKeys, RecordingsKeys, SharesKeys, described_numbers};
use crate::effects::candidates;
use crate::keys::declaration::Filled;
use crate::keys::schema::DIALECT;
use crate::plant::DeviceParts;

/// Schema of a rig file.
#[must_use]
pub fn schema() -> Value {
    let mut tables: Map<String, Value> = Map::new();
    for described in described_numbers() {
        let table = tables.entry(described.table);
        let table = table.or_insert_with(|| table_of(Map::new()));
        table["properties"][described.key] = number(&described.text, Some(described.range));
    }
    let chains = DeviceParts::ALL.map(DeviceParts::name);
    tables.insert(
        "schema".to_owned(),
        json!({ "enum": [1, 2], "description": "Version of this format." }),
    );
    let mut part = PartKeys::schema();
    part["properties"]["chain"]["enum"] = json!(chains);
    tables.insert("rig".to_owned(), part);
    tables.insert("recordings".to_owned(), RecordingsKeys::schema());
    tables.insert("shares".to_owned(), SharesKeys::schema());
    tables.insert("limits".to_owned(), LimitsKeys::schema());
    let effects = DeviceParts::ALL.into_iter().flat_map(candidates);
    tables.insert("effect".to_owned(), super::super::effects::schema(effects));
    tables.insert(
        "latent".to_owned(),
        json!({ "type": "object", "description": "Physics that no known effect explains, as a diagnosis writes it." }),
    );
    tables.insert(
        "known".to_owned(),
        json!({ "type": "object", "description": "How sure a diagnosis is of the numbers and predictions, and what its recordings covered, as it writes it." }),
    );
    tables.insert(
        "flange".to_owned(),
        json!({ "type": "object", "description": "A contact flange as a diagnosis has fitted it to runs, as it writes it." }),
    );
    json!({
        "$schema": DIALECT,
        "title": "A rig file of idc: a device, its contact and its sensors by their nominal values, in SI",
        "type": "object",
        "properties": tables,
        "required": ["schema"],
        "additionalProperties": false,
    })
}

fn table_of(properties: Map<String, Value>) -> Value {
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// A number, alone or with what is known of its accuracy.
fn number(text: &str, range: Option<[f64; 2]>) -> Value {
    let mut plain = json!({ "type": "number" });
    if let Some([low, high]) = range {
        plain["minimum"] = low.into();
        plain["maximum"] = high.into();
    }
    json!({
        "description": text,
        "anyOf": [
            plain,
            {
                "type": "object",
                "properties": {
                    "value": plain,
                    "tolerance": {
                        "type": "number",
                        "minimum": 0.0,
                        "exclusiveMaximum": 1.0,
                        "description": "Half the width of its tolerance, as a share of the value.",
                    },
                    "low": { "type": "number" },
                    "high": { "type": "number" },
                },
                "required": ["value"],
                "additionalProperties": false,
            },
        ],
    })
}
