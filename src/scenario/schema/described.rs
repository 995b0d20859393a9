//! What a schema says of a key besides its type.

use serde_json::Value;

/// The dialect that editors for TOML know.
pub(super) const DIALECT: &str = "http://json-schema.org/draft-07/schema#";

/// Knowledge of a key besides its type.
#[derive(Debug, Default)]
pub(crate) struct Described {
    /// A sentence or two.
    pub(super) text: String,
    /// Least and greatest value, in the key's unit.
    pub(super) range: [Option<f64>; 2],
    /// Value where the file gives none.
    pub(super) default: Option<Value>,
}

impl Described {
    /// A sentence alone.
    pub(crate) fn text(text: String) -> Self {
        Self {
            text,
            ..Self::default()
        }
    }
}
