//! JSON Schema of `[[effect]]`.

use serde_json::{Value, json};

use super::keys::{EffectKeys, JOINT, NAME};
use super::own::{ACTS_ON, IS};
use crate::effects::{Effect, every};
use crate::plant::{MOST_JOINTS, Port};

/// Schema of the list, of a file that may name these effects.
pub(in super::super) fn schema<'e>(known: impl Iterator<Item = &'e Effect>) -> Value {
    let mut names: Vec<&str> = known.map(|effect| effect.vocabulary().0).collect();
    names.sort_unstable();
    names.dedup();
    let number = json!({ "type": "number" });
    json!({
        "type": "array",
        "description": "Tables [[effect]]: physics beyond the nominal model, of the catalogue (`idc effects`) with all its numbers, or as an expression.",
        "items": {
            "type": "object",
            "properties": {
                NAME: {
                    "description": "An effect of the catalogue, or a name of one's own for a law.",
                    "anyOf": [{ "enum": names }, { "type": "string" }],
                },
                JOINT: {
                    "type": "integer",
                    "minimum": 1,
                    "maximum": MOST_JOINTS,
                    "description": "The joint, from 1, of an effect of one joint.",
                },
                ACTS_ON: {
                    "enum": Port::ALL.map(Port::name),
                    "description": "Where a law of one's own acts.",
                },
                IS: {
                    "type": "string",
                    "description": "The law as an expression over t, x, v, p1, p2, q, p_set, x_s, f and constants beside it, in SI.",
                },
            },
            "required": [NAME],
            "additionalProperties": {
                "description": "A number of the effect, in the unit that its name ends with, or a constant of the expression, in SI.",
                "anyOf": [
                    number,
                    {
                        "type": "object",
                        "properties": {
                            "value": number,
                            "low": number,
                            "high": number,
                            "min": number,
                            "max": number,
                            "unit": { "type": "string" },
                        },
                        "required": ["value"],
                        "additionalProperties": false,
                    },
                ],
            },
        },
    })
}

impl schemars::JsonSchema for EffectKeys {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "EffectKeys".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        // A map of its own is always an object.
        schemars::Schema::try_from(schema(every())).unwrap_or_default()
    }
}
