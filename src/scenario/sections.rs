//! Which keys each table of a file has, read off its types, so that a message can point to the right table.

use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

use super::bench_file::BenchFile;
use super::file::ScenarioFile;
use crate::keys::declaration::{names, tables};

/// Tables of a scenario file with their keys; `*` stands for a name that the user gives.
pub(crate) fn scenario_sections() -> Vec<(String, Vec<&'static str>)> {
    names(&tables::<ScenarioFile>())
}

/// Tables of a bench scenario file with their keys.
pub(crate) fn bench_sections() -> Vec<(String, Vec<&'static str>)> {
    names(&tables::<BenchFile>())
}

/// Tables of a device model file with their keys.
#[cfg(feature = "cli")]
pub(crate) fn model_sections() -> Vec<(String, Vec<&'static str>)> {
    names(&tables::<super::file::ModelFile>())
}

/// Keys of one table: the derived code hands its field names to the deserializer, which keeps them and stops.
pub(crate) fn keys<T: for<'de> Deserialize<'de>>() -> &'static [&'static str] {
    let mut names: &'static [&'static str] = &[];
    // The probe always stops with an error; the names are what was wanted of it.
    let _ = T::deserialize(Probe(&mut names));
    names
}

struct Probe<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = serde::de::value::Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        _visitor: V,
    ) -> Result<V::Value, Self::Error> {
        *self.0 = fields;
        Err(Self::Error::custom("names taken"))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Self::Error> {
        Err(Self::Error::custom("not a table"))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}
