//! A TOML file with the place of each of its keys, so that every message can say `file:line:column`.

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::de::{DeTable, DeValue};

use super::declaration::{Key, Table, names, tables};
use super::error::{Excerpt, Location, ScenarioError};
use super::suggestion::{Sections, advice, is_table, join, split};
use crate::unit::Unit;

/// Forms of a number, in serde's messages and ours.
pub(crate) const NUMBER_OR_TABLE: &str = "a number or { value, tolerance }";

/// A file that is valid TOML.
#[derive(Debug)]
pub(crate) struct Document<'a> {
    file: &'a Path,
    text: &'a str,
    /// Version of its format that it says it is of; 1 where it says none.
    schema: i64,
    /// Every key and list element, tables before what they hold.
    entries: Vec<Entry>,
}

/// A key or list element.
#[derive(Debug)]
struct Entry {
    /// Dotted key; list elements as in `arm.limit_overrides[0]`.
    key: String,
    key_span: Range<usize>,
    value_span: Range<usize>,
    /// Its value, where that is a number or a text.
    scalar: Option<Scalar>,
}

/// A number as the file gives it, or a text.
#[derive(Debug)]
enum Scalar {
    Number(f64),
    Text(String),
}

/// Reads a file as text.
pub(crate) fn read_text(file: &Path) -> Result<String, ScenarioError> {
    crate::file::read_settings(file).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => ScenarioError::NoSuchFile {
            file: file.to_owned(),
        },
        _ => ScenarioError::Read {
            file: file.to_owned(),
            source,
        },
    })
}

/// Tables and keys as JSON has them, as a TOML file would.
pub(crate) fn toml_text(tables: &serde_json::Value) -> Result<String, String> {
    toml::to_string(tables).map_err(|error| error.to_string())
}

/// Where a key stands in a file that has been read before; none if it does not stand there.
pub(crate) fn location_of_key(file: &Path, key: &str, schema: u32) -> Option<Location> {
    let text = read_text(file).ok()?;
    let location = Document::new(file, &text, schema).ok()?.location(key);
    location.position.is_some().then_some(location)
}

impl<'a> Document<'a> {
    /// Checks that a file's text is TOML of schema version `schema`, or of one before, and notes where its keys stand.
    pub fn new(file: &'a Path, text: &'a str, schema: u32) -> Result<Self, ScenarioError> {
        let mut document = Self {
            file,
            text,
            schema: 1,
            entries: Vec::new(),
        };
        let table = DeTable::parse(text).map_err(|error| ScenarioError::Syntax {
            location: document.location_of(error.span().unwrap_or(text.len()..text.len())),
            reason: error.message().to_owned(),
        })?;
        note_table("", table.get_ref(), &mut document.entries);
        // Before anything else: a file of a later version is full of unknown keys.
        if let Some(value) = table.get_ref().get("schema")
            && let DeValue::Integer(integer) = value.get_ref()
            && let Ok(found) = i64::from_str_radix(integer.as_str(), integer.radix())
        {
            if !(1..=i64::from(schema)).contains(&found) {
                return Err(ScenarioError::Schema {
                    location: document.location_of(value.span()),
                    found,
                    expected: schema,
                });
            }
            document.schema = found;
        }
        Ok(document)
    }

    /// Fills a type from the file; `sections` are the tables that the file may have.
    pub fn parse<T: Deserialize<'a>>(&self, sections: &Sections) -> Result<T, ScenarioError> {
        toml::from_str(self.text).map_err(|error| self.explain(&error, sections))
    }

    /// Fills a table of declared keys from the file, and holds its numbers to their ranges.
    pub fn read<T: Table>(&self) -> Result<T, ScenarioError> {
        let tables = tables::<T>();
        let file = self.parse(&names(&tables))?;
        self.hold_ranges(&tables)?;
        Ok(file)
    }

    /// Holds the numbers of tables to their ranges.
    pub fn hold_ranges(&self, tables: &[(String, Vec<Key>)]) -> Result<(), ScenarioError> {
        for entry in &self.entries {
            let Some(Scalar::Number(value)) = entry.scalar else {
                continue;
            };
            let (table, name) = split(&entry.key);
            let name = name.split('[').next().unwrap_or(name);
            let keys = tables.iter().find(|(known, _)| is_table(known, &table));
            let key = keys.and_then(|(_, keys)| keys.iter().find(|key| key.name == name));
            let Some([low, high]) = key.and_then(|key| key.range) else {
                continue;
            };
            let unit = Unit::of_key(name);
            if !(low..=high).contains(&value) {
                return Err(ScenarioError::Value {
                    location: self.location(&entry.key),
                    key: entry.key.clone(),
                    found: unit.show(value),
                    expected: unit.show_range(low..=high),
                });
            }
        }
        Ok(())
    }

    /// The text that stands at a key.
    pub fn text_at(&self, key: &str) -> Option<&str> {
        let entry = self.entries.iter().find(|entry| entry.key == key)?;
        match &entry.scalar {
            Some(Scalar::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// Version of its format that the file says it is of.
    pub fn schema(&self) -> i64 {
        self.schema
    }

    /// Place of a part of a text that is a key's value, by its bytes in the text; of the whole where it is written with escapes.
    pub fn location_in_text(&self, key: &str, part: &Range<usize>) -> Location {
        let Some(entry) = self.entries.iter().find(|entry| entry.key == key) else {
            return self.location(key);
        };
        let value = entry.value_span.clone();
        let written = self.text.get(value.clone()).unwrap_or_default();
        if written.len() < 2
            || written.contains('\\')
            || ["\"\"\"", "'''"]
                .iter()
                .any(|quote| written.starts_with(quote))
        {
            return self.location(key);
        }
        let start = value.start + 1;
        self.location_of(start + part.start..(start + part.end).min(value.end))
    }

    /// Folder that relative paths in the file start from.
    pub fn folder(&self) -> &'a Path {
        self.file.parent().unwrap_or(Path::new(""))
    }

    /// Place of a key, or of the file alone for a key that it leaves out.
    pub fn location(&self, key: &str) -> Location {
        match self.entries.iter().find(|entry| entry.key == key) {
            Some(entry) => {
                let [key, value] = [&entry.key_span, &entry.value_span];
                let both = key.start..value.end.max(key.end);
                // The value of a table begins with its heading, which holds the key.
                let beside = value.start >= key.end && !self.text[both.clone()].contains('\n');
                self.location_of(if beside { both } else { key.clone() })
            }
            None => Location {
                file: self.file.to_owned(),
                position: None,
                excerpt: None,
            },
        }
    }

    /// Place of a key that means nothing, whatever its value is.
    pub fn key_location(&self, key: &str) -> Location {
        match self.entries.iter().find(|entry| entry.key == key) {
            Some(entry) => self.location_of(entry.key_span.clone()),
            None => self.location(key),
        }
    }

    /// Names of the keys that a table has in the file.
    pub fn keys_in<'b>(&'b self, table: &str) -> impl Iterator<Item = &'b str> {
        self.entries.iter().filter_map(move |entry| {
            let name = match table {
                "" => entry.key.as_str(),
                table => entry.key.strip_prefix(table)?.strip_prefix('.')?,
            };
            (!name.contains(['.', '['])).then_some(name)
        })
    }

    /// Lines and columns count from 1, columns in characters.
    fn location_of(&self, span: Range<usize>) -> Location {
        let start = self.text.floor_char_boundary(span.start);
        let before = &self.text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = self.text[line_start..].lines().next().unwrap_or_default();
        let end = self.text.floor_char_boundary(span.end.max(start)) - line_start;
        Location {
            file: self.file.to_owned(),
            position: Some((
                before.matches('\n').count() as u32 + 1,
                before[line_start..].chars().count() as u32 + 1,
            )),
            excerpt: Some(Box::new(Excerpt {
                line: line.to_owned(),
                meant: (start - line_start).min(line.len())..end.min(line.len()),
            })),
        }
    }

    /// Turns a message of serde into one of ours. Its wording is serde's own and is pinned by the tests of this module's messages.
    fn explain(&self, error: &toml::de::Error, sections: &Sections) -> ScenarioError {
        let message = error.message();
        let span = error.span().unwrap_or(0..0);
        let location = self.location_of(span.clone());
        if message.starts_with("unknown field `") {
            let key = self
                .entries
                .iter()
                .find(|entry| entry.key_span == span)
                .map_or(self.text[span].to_owned(), |entry| entry.key.clone());
            let advice = advice(&key, sections);
            return ScenarioError::UnknownKey {
                location,
                key,
                advice,
            };
        }
        let owner = self.owner(&span);
        if let Some(field) = message.strip_prefix("missing field `") {
            let field = field.trim_end_matches('`');
            let key = join(&owner, field);
            let expected = expected_of_missing(&key, field, sections);
            return ScenarioError::MissingKey {
                location,
                key,
                expected,
            };
        }
        let (_, expected) = message.rsplit_once("expected ").unwrap_or(("", message));
        ScenarioError::Value {
            location,
            expected: expected_value(expected, &owner, sections),
            key: owner,
            found: excerpt(&self.text[span]),
        }
    }

    /// Key whose value stands at a span: that very value, else the smallest around it.
    fn owner(&self, span: &Range<usize>) -> String {
        let exact = self.entries.iter().rfind(|entry| entry.value_span == *span);
        let around = || {
            self.entries
                .iter()
                .filter(|e| e.value_span.start <= span.start && span.end <= e.value_span.end)
                .min_by_key(|entry| entry.value_span.len())
        };
        // The whole document has an empty span at its start.
        let found = exact.or_else(|| if span.is_empty() { None } else { around() });
        found.map_or_else(String::new, |entry| entry.key.clone())
    }
}

fn note_table(path: &str, table: &DeTable<'_>, entries: &mut Vec<Entry>) {
    // The parser's map is ordered by key, so the order is the same each time.
    for (key, value) in table {
        note_value(join(path, key.get_ref()), key.span(), value, entries);
    }
}

fn note_value(
    key: String,
    key_span: Range<usize>,
    value: &toml::Spanned<DeValue<'_>>,
    entries: &mut Vec<Entry>,
) {
    entries.push(Entry {
        key: key.clone(),
        key_span,
        value_span: value.span(),
        scalar: match value.get_ref() {
            DeValue::Float(number) => as_number(number.as_str()),
            DeValue::Integer(number) if number.radix() == 10 => as_number(number.as_str()),
            DeValue::String(text) => Some(Scalar::Text(text.to_string())),
            _ => None,
        },
    });
    match value.get_ref() {
        DeValue::Table(table) => note_table(&key, table, entries),
        DeValue::Array(elements) => {
            for (index, element) in elements.iter().enumerate() {
                note_value(format!("{key}[{index}]"), element.span(), element, entries);
            }
        }
        _ => {}
    }
}

fn as_number(digits: &str) -> Option<Scalar> {
    digits.replace('_', "").parse().ok().map(Scalar::Number)
}

fn expected_of_missing(key: &str, field: &str, sections: &Sections) -> String {
    let unit = Unit::of_key(field);
    if sections.iter().any(|(section, _)| section == key) {
        format!("a table [{key}]")
    } else if unit.is_one() {
        "it to be given, it has no default".to_owned()
    } else {
        format!("it to be given in {}, it has no default", unit.symbol)
    }
}

/// Type that serde expected, in words for people.
fn expected_value(expected: &str, key: &str, sections: &Sections) -> String {
    let number = |kind: &str| {
        let name = key.rsplit('.').next().unwrap_or(key);
        let unit = Unit::of_key(name.split('[').next().unwrap_or(name));
        if unit.is_one() {
            kind.to_owned()
        } else {
            format!("{kind}, in {}", unit.symbol)
        }
    };
    match expected {
        "f64" => number("a number"),
        NUMBER_OR_TABLE => number(expected),
        "u32" | "u64" | "usize" => number("a whole number, 0 or more"),
        "a boolean" => "true or false".to_owned(),
        "a string" | "path string" => "a text in quotes".to_owned(),
        "a sequence" if sections.iter().any(|(table, _)| table == key) => {
            format!("tables [[{key}]]")
        }
        "a sequence" => number("a list of numbers"),
        "a map" => "a table".to_owned(),
        other if other.starts_with("struct ") => "a table".to_owned(),
        other if other.starts_with('`') => format!("one of {}", other.replace(" or ", ", ")),
        other => other.to_owned(),
    }
}

/// First line of a value as written, not too long.
fn excerpt(text: &str) -> String {
    const LONGEST: usize = 60;
    let line = text.lines().next().unwrap_or_default();
    if line.chars().count() > LONGEST || line.len() < text.trim_end().len() {
        format!("{}...", line.chars().take(LONGEST).collect::<String>())
    } else {
        line.to_owned()
    }
}
