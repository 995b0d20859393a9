//! A value of a file of an arm or of a wrench sensor, one number or three, alone or with what is known of it.
//!
//! ```text
//! key_n_m = 15.5
//! key_n_m = { value = 15.5, tolerance = 0.3 }          lies within 30 % of it
//! key_n_m = { value = 15.5, tolerance_n_m = 2 }        lies within 2 N m of it
//! key_n_m = { value = 15.5, low = 14, high = 18 }      lies between them
//! ```

use std::fmt;

use serde::Deserialize;
use serde::de::value::{F64Deserializer, SeqAccessDeserializer};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Value, json};

use crate::keys::check::{Section, plain};
use crate::keys::declaration::{Below, Filled, keys};
use crate::keys::document::NUMBER_OR_TABLE;
use crate::keys::error::ScenarioError;
use crate::unit::Unit;

/// A number, or three where a key takes a vector.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Toleranced<T> {
    /// The value [SI].
    pub value: T,
    /// Half the width of its tolerance over it.
    relative: Option<f64>,
    /// Half the width, with the unit that its key names.
    absolute: Option<(String, f64)>,
    /// Ends.
    ends: [Option<T>; 2],
}

/// What stands in the place of a value.
pub(super) trait Content: Sized + Copy + PartialEq + for<'de> Deserialize<'de> {
    /// Its components.
    fn components(&self) -> Vec<f64>;
    /// Its JSON Schema.
    fn schema() -> Value;
    /// Its word in tables of keys.
    const WORD: &'static str;
}

impl Content for f64 {
    const WORD: &'static str = "number";

    fn components(&self) -> Vec<f64> {
        vec![*self]
    }

    fn schema() -> Value {
        json!({ "type": "number" })
    }
}

impl Content for [f64; 3] {
    const WORD: &'static str = "list of 3";

    fn components(&self) -> Vec<f64> {
        self.to_vec()
    }

    fn schema() -> Value {
        json!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 })
    }
}

impl<T> From<T> for Toleranced<T> {
    fn from(value: T) -> Self {
        Self {
            value,
            relative: None,
            absolute: None,
            ends: [None, None],
        }
    }
}

impl<'de, T: Content> Deserialize<'de> for Toleranced<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AnyForm(std::marker::PhantomData))
    }
}

struct AnyForm<T>(std::marker::PhantomData<T>);

impl<'de, T: Content> Visitor<'de> for AnyForm<T> {
    type Value = Toleranced<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match T::WORD {
            "number" => NUMBER_OR_TABLE,
            _ => "a list of 3 numbers or { value, tolerance }",
        })
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        T::deserialize(F64Deserializer::new(value)).map(Toleranced::from)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
        T::deserialize(SeqAccessDeserializer::new(list)).map(Toleranced::from)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let (mut value, mut relative, mut absolute) = (None, None, None);
        let mut ends = [None, None];
        while let Some(key) = map.next_key_seed(FieldKey)? {
            match key.as_str() {
                "value" => value = Some(map.next_value()?),
                "low" => ends[0] = Some(map.next_value()?),
                "high" => ends[1] = Some(map.next_value()?),
                "tolerance" => relative = Some(map.next_value()?),
                other => {
                    let unit = other.trim_start_matches(ABSOLUTE).to_owned();
                    absolute = Some((unit, map.next_value()?));
                }
            }
        }
        Ok(Toleranced {
            value: value.ok_or_else(|| A::Error::missing_field("value"))?,
            relative,
            absolute,
            ends,
        })
    }
}

/// Keys of such a value's table; one more is `tolerance_` with the unit of its key.
const FIELDS: [&str; 4] = ["value", "tolerance", "low", "high"];
/// Begin of the key of a tolerance in the unit of its value.
const ABSOLUTE: &str = "tolerance_";

/// Reads the name of a key, so that one that is unknown is refused in its place.
struct FieldKey;

impl<'de> DeserializeSeed<'de> for FieldKey {
    type Value = String;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<String, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for FieldKey {
    type Value = String;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<String, E> {
        if FIELDS.contains(&name) || name.starts_with(ABSOLUTE) {
            return Ok(name.to_owned());
        }
        Err(E::unknown_field(name, &FIELDS))
    }
}

keys! {
    /// A value with what is known of it.
    struct TolerancedKeys {
        /// the value
        value: f64 = "value";
        /// how far the truth may be off, a share of the value; `tolerance_` with the unit of the key says it in that unit
        tolerance: Option<f64> = "tolerance" in 0.0..=1.0;
        /// least value that it may have
        low: Option<f64> = "low";
        /// largest value that it may have
        high: Option<f64> = "high";
    }
}

impl<T: Content> Filled for Toleranced<T> {
    type Written = Self;
    const WORD: &'static str = T::WORD;
    const BELOW: Option<Below> = Some(Below::of::<TolerancedKeys>());

    fn filled(written: Self, _: Unit) -> Result<Self, &'static str> {
        Ok(written)
    }

    fn schema() -> Value {
        let number = json!({ "type": "number", "minimum": 0 });
        let content = T::schema();
        json!({ "anyOf": [content, {
            "type": "object",
            "properties": { "value": content, "tolerance": number, "low": content, "high": content },
            "patternProperties": { "^tolerance_": number },
            "required": ["value"],
            "additionalProperties": false,
        }] })
    }
}

/// How far the ends of an interval may lie beyond the range of their key, in its widths.
const REACH: f64 = 10.0;

impl<T: Content> Toleranced<T> {
    /// Least and largest value of each component, within the range of its key; `section` is the table in which `key` stands.
    pub fn bounds(
        &self,
        section: &Section<'_>,
        key: &str,
        range: [f64; 2],
    ) -> Result<Vec<[f64; 2]>, ScenarioError> {
        let values = self.value.components();
        let unit = Unit::of_key(key);
        for value in &values {
            if !(range[0] <= *value && *value <= range[1]) {
                let expected = unit.show_range(range[0]..=range[1]);
                return Err(section.refuse_number(key, *value, expected));
            }
        }
        let own = Section::new(section.document(), section.dotted(key));
        let half = self.half_widths(&own, key, &values)?;
        let (low, high) = match &self.ends {
            [None, None] => (None, None),
            [Some(low), Some(high)] => (Some(low.components()), Some(high.components())),
            [Some(_), None] => return Err(own.missing("high", "it to be given beside low")),
            [None, Some(_)] => return Err(own.missing("low", "it to be given beside high")),
        };
        // An interval that a diagnosis found may reach beyond what there can be, but no search ends in one of another order.
        let reach = REACH * (range[1] - range[0]);
        let widest = [range[0] - reach, range[1] + reach];
        let mut bounds = Vec::with_capacity(values.len());
        for (index, value) in values.iter().enumerate() {
            let end = |ends: &Option<Vec<f64>>, usual: f64| match ends {
                Some(ends) => ends[index],
                None => usual,
            };
            let bound = [
                end(&low, value - half[index]),
                end(&high, value + half[index]),
            ];
            for (name, end, right) in [
                ("low", bound[0], bound[0] <= *value),
                ("high", bound[1], bound[1] >= *value),
            ] {
                if !right {
                    let side = if name == "low" { "most" } else { "least" };
                    let expected = format!("at {side} the value, {}", plain(*value));
                    return Err(own.refuse(name, plain(end), expected));
                }
                if !(widest[0] <= end && end <= widest[1]) {
                    let expected = unit.show_range(widest[0]..=widest[1]);
                    return Err(own.refuse(name, plain(end), expected));
                }
            }
            bounds.push(bound);
        }
        Ok(bounds)
    }

    fn half_widths(
        &self,
        own: &Section<'_>,
        key: &str,
        values: &[f64],
    ) -> Result<Vec<f64>, ScenarioError> {
        let relative = self.relative.unwrap_or(0.0);
        if !(0.0..1.0).contains(&relative) {
            let expected = "0 to less than 1, a share of the value".to_owned();
            return Err(own.refuse("tolerance", plain(relative), expected));
        }
        let mut absolute = 0.0;
        if let Some((unit, half)) = &self.absolute {
            let written = format!("tolerance_{unit}");
            let right = Unit::of_key(key).suffix;
            if unit != right {
                let expected = format!("`tolerance_{right}`, in the unit of its value");
                return Err(own.refuse(&written, "in another unit".to_owned(), expected));
            }
            if self.relative.is_some() {
                let reason = "`tolerance` says how far the value may be off already".to_owned();
                return Err(own.misplaced(&written, reason));
            }
            if !(half.is_finite() && *half >= 0.0) {
                return Err(own.refuse(&written, plain(*half), "0 or more".to_owned()));
            }
            absolute = *half;
        }
        Ok(values
            .iter()
            .map(|value| absolute + relative * value.abs())
            .collect())
    }
}
