//! JSON Schema of a rig file: its tables hold numbers by key, which are not fields of a type.

use serde_json::{Map, Value, json};

use super::super::rig_file::described_numbers;
use super::described::DIALECT;
use crate::effects::candidates;
use crate::plant::Chain;

/// Schema of a rig file.
#[must_use]
pub fn schema() -> Value {
    let mut tables: Map<String, Value> = Map::new();
    for described in described_numbers() {
        let table = tables.entry(described.table);
        let table = table.or_insert_with(|| table_of(Map::new()));
        table["properties"][described.key] = number(&described.text, Some(described.range));
    }
    let chains = Chain::ALL.map(Chain::name);
    tables.insert(
        "schema".to_owned(),
        json!({ "enum": [1, 2], "description": "Version of this format." }),
    );
    tables.insert(
        "rig".to_owned(),
        json!({
            "type": "object",
            "properties": { "chain": {
                "enum": chains,
                "description": "How much of the device there is. Default: whole.",
            } },
            "additionalProperties": false,
        }),
    );
    tables.insert("recordings".to_owned(), recordings());
    tables.insert("shares".to_owned(), shares());
    let effects = Chain::ALL.into_iter().flat_map(candidates);
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
        "title": "A rig file of idc: a device, its contact and its sensors as their owner believes them to be, in SI",
        "type": "object",
        "properties": tables,
        "required": ["schema"],
        "additionalProperties": false,
    })
}

/// `[recordings]`.
fn recordings() -> Value {
    json!({
        "type": "object",
        "properties": {
            "fit": {
                "type": "array",
                "items": { "type": "string" },
                "description": "Recordings beside this file to diagnose from; a star stands for all that fit.",
            },
            "predict": {
                "type": "string",
                "description": "Recording that is kept back, to be predicted.",
            },
            "force_ramp": {
                "type": "array",
                "items": {
                    "type": "object",
                    "properties": {
                        "recording": {
                            "type": "string",
                            "description": "Recording that it is of; a star stands for all that fit.",
                        },
                        "before_contact_n": {
                            "type": "number",
                            "minimum": 0,
                            "maximum": 1e4,
                            "description": "Force that a contact flange is told before contact.",
                        },
                        "time_s": {
                            "type": "number",
                            "minimum": 0,
                            "maximum": 100,
                            "description": "Time from contact until the desired force is set.",
                        },
                    },
                    "required": ["recording", "before_contact_n", "time_s"],
                    "additionalProperties": false,
                },
                "description": "Force ramps of a contact flange; without one the whole desired force is set before contact.",
            },
        },
        "additionalProperties": false,
    })
}

/// `[shares]`.
fn shares() -> Value {
    let part = |text: &str| json!({ "type": "string", "description": text });
    let mut table = table_of(Map::from_iter([
        (
            "cylinder".to_owned(),
            part("Identity of the cylinder, such as its serial number."),
        ),
        (
            "force_sensor".to_owned(),
            part("Identity of the load cell."),
        ),
        (
            "regulator".to_owned(),
            part("Identity of the pressure regulator."),
        ),
    ]));
    table["description"] =
        "Parts that other rigs may have too: those that state the same identity have the same part, and `idc diagnose --all` finds one value for it.".into();
    table
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
                        "description": "Half the width of what is believed, as a share of the value.",
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
