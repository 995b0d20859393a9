//! Keys of files, each declared once, beside the field that it fills. Of the declaration are made what reads the file, the check of its numbers, advice on a
//! mistyped key, JSON Schemas and the tables of keys of scenarios/README.md.

use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use glam::DVec3;
use serde::Deserialize;
use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use serde_json::{Map, Value, json};

use super::schema::{DIALECT, type_schema};
use super::suggestion::join;
use crate::plant::Number;
use crate::unit::Unit;

/// A value that a key has where the file gives none, as a file would give it.
pub(crate) type Default = toml::Value;

/// A key as it is declared.
#[derive(Debug, Clone)]
pub(crate) struct Key {
    /// Its name in its table.
    pub name: &'static str,
    meaning: &'static str,
    /// Least and greatest value, in its unit.
    pub range: Option<[f64; 2]>,
    /// Other words for what is allowed.
    range_words: Option<&'static str>,
    default: Option<Default>,
    /// Words for what leaving it out does.
    default_words: Option<&'static str>,
    /// Results that rest on its value, where nobody has measured that in public.
    pub assumed: Option<&'static str>,
    /// Kinds of its table that have it; all where there are none.
    kinds: &'static [&'static str],
    is_required: bool,
    word: &'static str,
    schema: fn() -> Value,
    below: Option<Below>,
}

/// Keys of a table that a key holds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Below {
    /// Behind the key's name: `.*` where the user names the tables.
    suffix: &'static str,
    keys: fn() -> Vec<Key>,
}

/// A type that a key of a file fills, in SI.
pub(crate) trait Filled: Sized {
    /// As it stands in the file.
    type Written: DeserializeOwned;
    /// Its unit column in a table of keys, where it has no unit; none of a table.
    const WORD: &'static str = "";
    /// Keys of the table that it is.
    const BELOW: Option<Below> = None;

    /// From the file, in SI, or what was expected.
    fn filled(written: Self::Written, unit: Unit) -> Result<Self, &'static str>;

    /// Its value where the key is left out and has no default.
    fn absent() -> Option<Self> {
        None
    }

    /// JSON Schema of its type.
    fn schema() -> Value;
}

/// A type that stands in the file as it is.
pub(crate) trait Plain: DeserializeOwned + schemars::JsonSchema {
    /// See [`Filled::WORD`].
    const WORD: &'static str = "text";

    /// See [`Filled::absent`].
    fn absent() -> Option<Self> {
        None
    }
}

impl<T: Plain> Filled for T {
    type Written = Self;
    const WORD: &'static str = T::WORD;

    fn filled(written: Self, _: Unit) -> Result<Self, &'static str> {
        Ok(written)
    }

    fn absent() -> Option<Self> {
        T::absent()
    }

    fn schema() -> Value {
        type_schema::<T>()
    }
}

/// Plain types, each with its word for tables of keys.
macro_rules! plain {
    ($($type:ty = $word:literal,)+) => {
        $(impl Plain for $type {
            const WORD: &'static str = $word;
        })+
    };
}
plain! {
    bool = "true or false",
    i32 = "whole number",
    u32 = "whole number",
    u64 = "whole number",
    usize = "whole number",
    String = "text",
    PathBuf = "file",
    Vec<[String; 2]> = "table of pairs",
    Vec<usize> = "whole numbers",
    Vec<PathBuf> = "files",
    [String; 2] = "two texts",
}

impl Plain for Vec<String> {
    const WORD: &'static str = "texts";

    fn absent() -> Option<Self> {
        Some(Self::new())
    }
}

impl Plain for BTreeMap<String, PathBuf> {
    const WORD: &'static str = "table of folders";

    fn absent() -> Option<Self> {
        Some(Self::new())
    }
}

impl Filled for f64 {
    type Written = Self;
    const WORD: &'static str = "number";

    fn filled(written: Self, unit: Unit) -> Result<Self, &'static str> {
        Ok(unit.to_si(written))
    }

    fn schema() -> Value {
        json!({ "type": "number" })
    }
}

impl Filled for Vec<f64> {
    type Written = Self;
    const WORD: &'static str = "list";

    fn filled(written: Self, unit: Unit) -> Result<Self, &'static str> {
        Ok(written.into_iter().map(|one| unit.to_si(one)).collect())
    }

    fn schema() -> Value {
        json!({ "type": "array", "items": { "type": "number" } })
    }
}

impl Filled for DVec3 {
    type Written = Vec<f64>;
    const WORD: &'static str = "list of 3";

    fn filled(written: Vec<f64>, unit: Unit) -> Result<Self, &'static str> {
        let numbers = <[f64; 3]>::try_from(written).map_err(|_| "a list of 3")?;
        Ok(numbers.map(|one| unit.to_si(one)).into())
    }

    fn schema() -> Value {
        Vec::<f64>::schema()
    }
}

impl<T: Filled> Filled for Option<T> {
    type Written = T::Written;
    const WORD: &'static str = T::WORD;
    const BELOW: Option<Below> = T::BELOW;

    fn filled(written: T::Written, unit: Unit) -> Result<Self, &'static str> {
        T::filled(written, unit).map(Some)
    }

    fn absent() -> Option<Self> {
        Some(None)
    }

    fn schema() -> Value {
        T::schema()
    }
}

/// A table whose keys are declared.
pub(crate) trait Table: Filled<Written = Self> + DeserializeOwned {
    /// Its keys.
    fn keys() -> Vec<Key>;
}

impl<T: Table> Filled for BTreeMap<String, T> {
    type Written = Self;
    const WORD: &'static str = "tables by name";
    const BELOW: Option<Below> = Some(Below {
        suffix: ".*",
        keys: T::keys,
    });

    fn filled(written: Self, _: Unit) -> Result<Self, &'static str> {
        Ok(written)
    }

    fn absent() -> Option<Self> {
        Some(Self::new())
    }

    fn schema() -> Value {
        json!({ "type": "object", "additionalProperties": T::schema() })
    }
}

impl Key {
    /// A key that fills a type.
    pub fn new<T: Filled>(name: &'static str, meaning: &'static str) -> Self {
        Self {
            name,
            meaning: meaning.trim_ascii(),
            range: None,
            range_words: None,
            default: None,
            default_words: None,
            assumed: None,
            kinds: &[],
            is_required: T::absent().is_none(),
            word: T::WORD,
            schema: T::schema,
            below: T::BELOW,
        }
    }

    /// That a file must give it, though its type could do without.
    pub fn must(mut self, _stand: &str) -> Self {
        self.is_required = true;
        self
    }

    /// Of some kinds of its table alone, which need it if it has no default.
    pub fn of_kinds(mut self, kinds: &'static [&'static str]) -> Self {
        self.kinds = kinds;
        self.is_required = true;
        self
    }

    /// Its range, in its unit.
    pub fn within<N: Into<f64> + Copy>(mut self, range: RangeInclusive<N>) -> Self {
        self.range = Some([(*range.start()).into(), (*range.end()).into()]);
        self
    }

    /// That it gives a number of the description.
    pub fn known(self, number: &Number) -> Self {
        let range = Unit::of_key(self.name).range(number.range);
        let is_single =
            self.is_required && self.kinds.is_empty() && self.word == <f64 as Filled>::WORD;
        let is_default = is_single && !number.default.is_nan();
        let default = default_of_si(self.name, number.default);
        let key = self.within(range);
        match is_default {
            true => key.by_default(default),
            false => key,
        }
    }

    /// Its value where the file gives none.
    pub fn by_default(mut self, default: impl Into<Default>) -> Self {
        self.default = Some(default.into());
        self.is_required = false;
        self
    }

    /// Words for what leaving it out does.
    pub fn default_shown(mut self, words: &'static str) -> Self {
        self.default_words = Some(words);
        self.is_required = false;
        self
    }

    /// Words for what is allowed.
    pub fn being(mut self, words: &'static str) -> Self {
        self.range_words = Some(words);
        self
    }

    /// What its value decides, which nobody has measured in public.
    pub fn assumed(mut self, decides: &'static str) -> Self {
        self.assumed = Some(decides);
        self
    }

    /// Its default as a number, where that switches something on.
    pub fn usual_number(&self) -> Option<f64> {
        let number = self.default.as_ref().and_then(Default::as_float);
        number.filter(|number| number.is_finite() && *number != 0.0)
    }

    /// Whether tables of a kind have it.
    pub fn is_of(&self, kind: &str) -> bool {
        self.kinds.is_empty() || self.kinds.contains(&kind)
    }

    /// Whether a file must give it, in a table of a kind that has it.
    pub fn is_required(&self) -> bool {
        self.is_required
    }

    /// Its default as a text.
    pub fn default_text(&self) -> Option<&str> {
        self.default.as_ref()?.as_str()
    }

    /// Unit, default, range and meaning in words.
    pub fn columns(&self) -> [String; 4] {
        let unit = Unit::of_key(self.name);
        let unit = match self.word {
            word if unit.is_one() => word.to_owned(),
            "number" => unit.symbol.to_owned(),
            word => format!("{}, {word}", unit.symbol),
        };
        let default = match (&self.default, self.default_words) {
            (_, Some(words)) => words.to_owned(),
            (Some(value), None) => shown(value),
            _ if self.is_required => "required".to_owned(),
            _ => "none".to_owned(),
        };
        let range = match (self.range_words, self.range) {
            (Some(words), _) => words.to_owned(),
            (None, Some([low, high])) if high.is_finite() => format!("{low} to {high}"),
            (None, Some([low, _])) => format!("at least {low}"),
            (None, None) => choices(&(self.schema)()),
        };
        let kinds: Vec<String> = self.kinds.iter().map(|kind| format!("*{kind}*")).collect();
        let mut meaning = match kinds.is_empty() {
            true => self.meaning.to_owned(),
            false => format!("{}: {}", listed(&kinds, "and"), self.meaning),
        };
        if let Some(decides) = self.assumed {
            meaning += &format!("; assumed, decides {decides}");
        }
        [unit, default, range, meaning]
    }

    /// Its row in a page's table of keys; none of a table, which has rows of its own.
    #[cfg(test)]
    pub fn row(&self, table: &str) -> Option<String> {
        let columns = self.columns().map(|cell| format!("{cell} |"));
        let columns = columns.join(" ").replace("|  |", "| |");
        let name = join(table, self.name);
        (!self.word.is_empty()).then(|| format!("| `{name}` | {columns}"))
    }

    /// Its row in a table of keys that says what it means and what comes of leaving it out.
    #[cfg(test)]
    pub fn short_row(&self) -> String {
        let [_, default, _, meaning] = self.columns();
        let default = match default.as_str() {
            "required" => "refused".to_owned(),
            "none" => "-".to_owned(),
            text if text.starts_with('"') || text == "false" => format!("`{text}`"),
            other => other.to_owned(),
        };
        format!("| `{}` | {meaning} | {default} |", self.name)
    }

    /// JSON Schema of it, as editors show it.
    fn described(&self) -> Value {
        let mut schema = (self.schema)();
        let [unit, default, range, meaning] = self.columns();
        // What is no number of a unit shows by its type.
        let has_unit = !Unit::of_key(self.name).is_one() || unit.starts_with(char::is_uppercase);
        let mut text = meaning;
        if self.word.is_empty() && text.is_empty() {
            return schema;
        }
        if has_unit || unit.starts_with("table") {
            text += &format!(" [{unit}]");
        }
        let values = schema.get("enum").and_then(Value::as_array);
        let mut values = values.into_iter().flatten().filter_map(Value::as_str);
        let are_said = schema.get("enum").is_some() && values.all(|value| text.contains(value));
        if !range.is_empty() && !are_said {
            text += &format!(", {range}");
        }
        text += &match default.as_str() {
            "required" => ". Required.".to_owned(),
            default => format!(". Default: {default}."),
        };
        schema["description"] = text.into();
        if let Ok(value) = serde_json::from_str::<Value>(&default) {
            schema["default"] = value;
        }
        let number = match schema.get("items") {
            Some(_) => &mut schema["items"],
            None => &mut schema,
        };
        if let Some([low, high]) = self.range {
            number["minimum"] = low.into();
            if high.is_finite() {
                number["maximum"] = high.into();
            }
        }
        schema
    }
}

/// A value as a file gives it.
fn shown(value: &Default) -> String {
    match value {
        Default::Float(number) => number.to_string(),
        Default::Array(values) => {
            let values: Vec<String> = values.iter().map(shown).collect();
            format!("[{}]", values.join(", "))
        }
        other => other.to_string(),
    }
}

/// The words that a text may be.
fn choices(schema: &Value) -> String {
    let among = |list: &str, of: fn(&Value) -> &Value| {
        let values = schema[list].as_array().into_iter().flatten();
        values.map(of).map(Value::to_string).collect::<Vec<_>>()
    };
    let words = [
        among("oneOf", |one| &one["const"]),
        among("enum", |one| one),
    ]
    .concat();
    listed(&words, "or")
}

/// Words one after the other.
fn listed(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., end] => format!("{} {last} {end}", most.join(", ")),
    }
}

/// JSON Schema of a table.
pub(crate) fn table_schema(about: &str, keys: &[Key]) -> Value {
    let properties = keys
        .iter()
        .map(|key| (key.name.to_owned(), key.described()));
    let required = keys
        .iter()
        .filter(|key| key.is_required && key.kinds.is_empty());
    let required: Vec<&str> = required.map(|key| key.name).collect();
    let mut schema = json!({
        "type": "object",
        "description": about.trim_ascii(),
        "properties": properties.collect::<Map<_, _>>(),
        "additionalProperties": false,
    });
    if !required.is_empty() {
        schema["required"] = required.into();
    }
    schema
}

/// The tables of a file, by dotted name, with their keys; `*` stands for a name that the user gives.
pub(crate) fn tables<T: Table>() -> Vec<(String, Vec<Key>)> {
    let mut found = vec![(String::new(), T::keys())];
    let mut at = 0;
    while let Some((table, keys)) = found.get(at) {
        let below = keys.iter().filter_map(|key| {
            let below = key.below?;
            Some((join(table, key.name) + below.suffix, (below.keys)()))
        });
        let below: Vec<_> = below.collect();
        found.extend(below);
        at += 1;
    }
    found
}

/// Names of tables and of their keys.
pub(crate) fn names(tables: &[(String, Vec<Key>)]) -> Vec<(String, Vec<&'static str>)> {
    let names = |keys: &Vec<Key>| keys.iter().map(|key| key.name).collect();
    let named = tables
        .iter()
        .map(|(table, keys)| (table.clone(), names(keys)));
    named.collect()
}

/// Reads the name of a key that a table has.
pub(crate) struct Name(pub &'static [&'static str]);

impl<'de> DeserializeSeed<'de> for Name {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<&'static str, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Name {
    type Value = &'static str;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<&'static str, E> {
        let known = self.0.iter().find(|key| **key == name);
        known.copied().ok_or_else(|| E::unknown_field(name, self.0))
    }
}

/// Reads the value of a key in SI.
struct InSi<T>(Unit, PhantomData<T>);

impl<'de, T: Filled> DeserializeSeed<'de> for InSi<T> {
    type Value = T;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<T, D::Error> {
        let written = T::Written::deserialize(deserializer)?;
        let expected = |expected| D::Error::custom(format!("expected {expected}"));
        T::filled(written, self.0).map_err(expected)
    }
}

/// The value of a key that a file gives.
pub(crate) fn given<'de, T: Filled, A: MapAccess<'de>>(
    map: &mut A,
    key: &str,
) -> Result<T, A::Error> {
    map.next_value_seed(InSi(Unit::of_key(key), PhantomData))
}

/// The value of a key that a file leaves out.
pub(crate) fn left_out<T: Filled>(
    key: &'static str,
    own: &Key,
) -> Result<T, serde::de::value::Error> {
    let Some(default) = own.default.clone() else {
        if own.is_required && own.kinds.is_empty() {
            return Err(Error::missing_field(key));
        }
        return T::absent().ok_or_else(|| Error::missing_field(key));
    };
    let written = default.try_into::<T::Written>().map_err(Error::custom)?;
    T::filled(written, Unit::of_key(key)).map_err(Error::custom)
}

/// A default in SI as a file would give it.
pub(crate) fn default_of_si(key: &str, value: f64) -> Default {
    Default::Float(Unit::of_key(key).of_si(value))
}

/// Schema of a kind of file by itself.
pub(crate) fn of_file<T: Table>(title: &str) -> Value {
    let mut schema = T::schema();
    schema["$schema"] = DIALECT.into();
    schema["title"] = title.into();
    schema
}

/// A table of a file: its keys, each with what it means, the field that it fills in SI, its name, and
/// whether it `must stand` though its type could do without, `for` which kinds of the table it is, `in` which range [its unit], `of` which number of the description (whose range and default it has),
/// `or` which default [its unit], `from` which default in SI, `else` which value of fields before it, `shown` how that reads, `being` how what is allowed
/// reads, and what of a value that was never measured in public is `judged`.
macro_rules! keys {
    ($(
        $(#[doc = $about:literal])+
        $vis:vis struct $table:ident $(: $($derive:ident),+)? { $(
            $(#[doc = $meaning:literal])*
            $field:ident: $type:ty = $key:literal $(must $stand:ident)? $(for $($kind:literal)|+)? $(in $range:expr)? $(, of $number:expr)?
                $(, or $default:expr)? $(, from $si:expr)? $(, else $derived:expr)? $(, shown $words:literal)? $(, being $being:literal)?
                $(, assumed $decides:literal)?;
        )+ }
    )+) => {$(
        $(#[doc = $about])+
        #[allow(dead_code, reason = "schema and kind of a file are read before it is")]
        #[derive(Debug, Clone, PartialEq $($(, $derive)+)?)]
        $vis struct $table {
            $($(#[doc = $meaning])* pub $field: $type,)+
        }

        impl $crate::keys::declaration::Table for $table {
            fn keys() -> Vec<$crate::keys::declaration::Key> {
                vec![$(
                    $crate::keys::declaration::Key::new::<$type>($key, concat!($($meaning),*))
                        $(.must(stringify!($stand)))? $(.of_kinds(&[$($kind),+]))? $(.within($range))? $(.known(&$number))? $(.by_default($default))?
                        $(.by_default($crate::keys::declaration::default_of_si($key, $si)))? $(.default_shown($words))? $(.being($being))? $(.assumed($decides))?,
                )+]
            }
        }

        impl $crate::keys::declaration::Filled for $table {
            type Written = Self;
            const BELOW: Option<$crate::keys::declaration::Below> = Some($crate::keys::declaration::Below::of::<Self>());

            fn filled(written: Self, _: $crate::unit::Unit) -> Result<Self, &'static str> {
                Ok(written)
            }

            fn absent() -> Option<Self> {
                $crate::keys::declaration::of_nothing()
            }

            fn schema() -> serde_json::Value {
                $crate::keys::declaration::table_schema(concat!($($about),+), &<Self as $crate::keys::declaration::Table>::keys())
            }
        }

        impl $crate::keys::declaration::Filled for Vec<$table> {
            type Written = Self;
            const BELOW: Option<$crate::keys::declaration::Below> = <$table as $crate::keys::declaration::Filled>::BELOW;

            fn filled(written: Self, _: $crate::unit::Unit) -> Result<Self, &'static str> {
                Ok(written)
            }

            fn absent() -> Option<Self> {
                Some(Vec::new())
            }

            fn schema() -> serde_json::Value {
                let table = <$table as $crate::keys::declaration::Filled>::schema();
                serde_json::json!({ "type": "array", "description": table["description"], "items": table })
            }
        }

        impl<'de> serde::Deserialize<'de> for $table {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                const NAMES: &[&str] = &[$($key),+];
                struct Read;
                impl<'de> serde::de::Visitor<'de> for Read {
                    type Value = $table;

                    fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        formatter.write_str("a table")
                    }

                    fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<$table, A::Error> {
                        let mut given = Given::default();
                        while let Some(name) = map.next_key_seed($crate::keys::declaration::Name(NAMES))? {
                            match name {
                                $($key => given.$field = Some($crate::keys::declaration::given(&mut map, $key)?),)+
                                _ => {}
                            }
                        }
                        given.completed().map_err(serde::de::Error::custom)
                    }
                }
                /// What a file gives. Completed apart from where it is read, which is compiled for each kind of file.
                #[derive(Default)]
                struct Given {
                    $($field: Option<$type>,)+
                }
                impl Given {
                    fn completed(self) -> Result<$table, serde::de::value::Error> {
                        let Given { $($field),+ } = self;
                        let mut keys = <$table as $crate::keys::declaration::Table>::keys().into_iter();
                        $(
                            let key = keys.next();
                            let $field = match ($field$(.or_else(|| Some($derived)))?$(.or_else(|| Some($si)))?, key) {
                                (Some(value), _) => value,
                                (None, Some(key)) => $crate::keys::declaration::left_out($key, &key)?,
                                (None, None) => return Err(serde::de::Error::missing_field($key)),
                            };
                        )+
                        Ok($table { $($field),+ })
                    }
                }
                deserializer.deserialize_struct(stringify!($table), NAMES, Read)
            }
        }
    )+};
}
pub(crate) use keys;

impl Below {
    /// The keys of a table in its place.
    pub const fn of<T: Table>() -> Self {
        Self {
            suffix: "",
            keys: T::keys,
        }
    }
}

/// A table of which a file gives nothing; none where it must give something.
pub(crate) fn of_nothing<T: Table>() -> Option<T> {
    Default::Table(toml::Table::new()).try_into().ok()
}
