//! A value of an effect's table: a text, a number, or a number with what is known of it.

use std::fmt;

use serde::Deserialize;

use crate::keys::check::{Section, plain};
use crate::keys::error::ScenarioError;

/// A value.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(
    untagged,
    expecting = "a number, a text, or { value } with `low` and `high`, or with `min`, `max` and `unit` of a constant"
)]
pub(in super::super) enum EffectValue {
    Number(f64),
    Text(String),
    Known(KnownNumber),
}

/// A number with what is known of it.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct KnownNumber {
    pub value: f64,
    /// Ends of the interval in which it lies, as a diagnosis writes it.
    pub low: Option<f64>,
    pub high: Option<f64>,
    /// Between which a diagnosis may fit a constant.
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// Unit of a constant.
    pub unit: Option<String>,
}

impl EffectValue {
    /// As a number, if it is one.
    pub fn number(&self) -> Option<KnownNumber> {
        match self {
            Self::Number(value) => Some(KnownNumber {
                value: *value,
                ..KnownNumber::default()
            }),
            Self::Known(known) => Some(known.clone()),
            Self::Text(_) => None,
        }
    }
}

impl KnownNumber {
    /// Checks that its interval holds it; `section` is its own table.
    pub fn check(&self, section: &Section<'_>) -> Result<(), ScenarioError> {
        for (key, end, right) in [
            (
                "low",
                self.low,
                self.low.is_none_or(|low| low <= self.value),
            ),
            (
                "high",
                self.high,
                self.high.is_none_or(|high| high >= self.value),
            ),
            (
                "min",
                self.min,
                self.min.is_none_or(|min| min <= self.value),
            ),
            (
                "max",
                self.max,
                self.max.is_none_or(|max| max >= self.value),
            ),
        ] {
            if let (Some(end), false) = (end, right) {
                let side = if ["low", "min"].contains(&key) {
                    "most"
                } else {
                    "least"
                };
                let expected = format!("at {side} the value, {}", plain(self.value));
                return Err(section.refuse(key, plain(end), expected));
            }
        }
        for (one, other, given) in [
            ("low", "high", [self.low, self.high]),
            ("min", "max", [self.min, self.max]),
        ] {
            match given {
                [Some(_), None] => {
                    return Err(section.missing(other, &format!("it to be given beside {one}")));
                }
                [None, Some(_)] => {
                    return Err(section.missing(one, &format!("it to be given beside {other}")));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

impl fmt::Display for EffectValue {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => write!(formatter, "{text:?}"),
            Self::Number(value) => formatter.write_str(&plain(*value)),
            Self::Known(known) => formatter.write_str(&plain(known.value)),
        }
    }
}
