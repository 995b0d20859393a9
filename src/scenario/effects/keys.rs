//! `[[effect]]` as it is written.

use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use super::value::EffectValue;

/// First version of a file whose effects are a list.
pub(super) const LISTED: i64 = 2;
/// Key of an effect's name.
pub(super) const NAME: &str = "name";
/// Key of the joint that an effect is about.
pub(super) const JOINT: &str = "joint";

/// One effect's keys.
pub(super) type KeyTable = BTreeMap<String, EffectValue>;

/// The effects of a file.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) enum EffectKeys {
    /// `[[effect]]`.
    List(Vec<KeyTable>),
    /// `[effect.NAME]`, of schema 1.
    Named(BTreeMap<String, KeyTable>),
}

impl Default for EffectKeys {
    fn default() -> Self {
        Self::List(Vec::new())
    }
}

impl<'de> Deserialize<'de> for EffectKeys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Tables;
        impl<'de> Visitor<'de> for Tables {
            type Value = EffectKeys;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("tables [[effect]]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<EffectKeys, A::Error> {
                let mut tables = Vec::new();
                while let Some(table) = list.next_element()? {
                    tables.push(table);
                }
                Ok(EffectKeys::List(tables))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<EffectKeys, A::Error> {
                let mut tables = BTreeMap::new();
                while let Some((name, table)) = map.next_entry()? {
                    tables.insert(name, table);
                }
                Ok(EffectKeys::Named(tables))
            }
        }
        deserializer.deserialize_any(Tables)
    }
}
