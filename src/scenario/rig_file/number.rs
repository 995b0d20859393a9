//! A number of a rig file, alone or with what is known of its accuracy.

use std::fmt;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};

use crate::keys::document::NUMBER_OR_TABLE;

/// A number with what is known of its accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number {
    /// Value.
    pub value: f64,
    /// Half the width of its tolerance, relative to the value.
    pub tolerance: Option<f64>,
    /// Ends of the interval in which it lies.
    pub low: Option<f64>,
    /// See `low`.
    pub high: Option<f64>,
}

/// The number's table.
#[derive(Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct NumberKeys {
    value: f64,
    tolerance: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
}

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        Self {
            value,
            tolerance: None,
            low: None,
            high: None,
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberVisitor)
    }
}

struct NumberVisitor;

impl<'de> Visitor<'de> for NumberVisitor {
    type Value = Number;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(NUMBER_OR_TABLE)
    }

    fn visit_f64<E>(self, value: f64) -> Result<Number, E> {
        Ok(value.into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<Number, E> {
        Ok((value as f64).into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Number, E> {
        Ok((value as f64).into())
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Number, A::Error> {
        let keys = NumberKeys::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Number {
            value: keys.value,
            tolerance: keys.tolerance,
            low: keys.low,
            high: keys.high,
        })
    }
}
