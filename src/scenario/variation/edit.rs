//! `key = value` put into a TOML document, wherever the key's table or list stands in it.

use toml_edit::{ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use crate::effects::vocabulary;

/// A dotted key and the value that it is to have. List elements are counted from 0, as in `command[0].force_n`; a name with a dot stands in quotes.
#[derive(Debug, Clone)]
pub struct KeyValue {
    key: String,
    value: Value,
}

impl PartialEq for KeyValue {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key && self.shown() == other.shown()
    }
}

impl KeyValue {
    /// A number, in its key's unit. A whole one is written as such: 2.0 cylinders would be refused.
    #[must_use]
    pub fn number(key: impl Into<String>, value: f64) -> Self {
        let whole = value.fract() == 0.0 && value.abs() < 1e15;
        Self {
            key: key.into(),
            value: if whole {
                Value::from(value as i64)
            } else {
                Value::from(value)
            },
        }
    }

    /// A value as a file would have it, or as people type it: `30`, `.5`, `true`, `[0, 0, 1]`, `"a text"`, or a text without quotes.
    #[must_use]
    pub fn typed(key: impl Into<String>, text: &str) -> Self {
        let text = text.trim();
        let number = || text.parse::<f64>().ok().map(Value::from);
        let value = text.parse::<Value>().ok().or_else(number);
        let mut value = value.unwrap_or_else(|| Value::from(text));
        value.decor_mut().clear();
        Self {
            key: key.into(),
            value,
        }
    }

    /// A text.
    #[must_use]
    pub fn text(key: impl Into<String>, text: &str) -> Self {
        Self {
            key: key.into(),
            value: Value::from(text),
        }
    }

    /// The key.
    #[must_use]
    pub fn key(&self) -> &str {
        &self.key
    }

    /// The value for people: a text without its quotes.
    #[must_use]
    pub fn shown(&self) -> String {
        match self.value.as_str() {
            Some(text) => text.to_owned(),
            None => self.value.to_string().trim().to_owned(),
        }
    }

    /// The number, if it is one.
    #[must_use]
    pub fn as_number(&self) -> Option<f64> {
        let whole = self.value.as_integer().map(|whole| whole as f64);
        whole.or_else(|| self.value.as_float())
    }

    /// Puts it into a document; what stood there is replaced, tables on the way are made.
    pub(super) fn apply(&self, document: &mut DocumentMut) -> Result<(), String> {
        let steps = steps(&self.key)?;
        put(document.as_item_mut(), "", &steps, &self.value)
    }
}

/// The values of a comma list: commas within quotes or brackets divide nothing.
#[must_use]
pub fn listed(text: &str) -> Vec<String> {
    let parts = divided(text, ',');
    parts.iter().map(|part| part.trim().to_owned()).collect()
}

/// A step from a table or list to what it holds.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    Name(String),
    Index(usize),
}

/// Steps of a dotted key.
fn steps(key: &str) -> Result<Vec<Step>, String> {
    let mut found = Vec::new();
    for part in divided(key, '.') {
        let (name, indices) = match part.find('[') {
            Some(place) if !part.starts_with(['"', '\'']) => part.split_at(place),
            _ => (part.as_str(), ""),
        };
        let bare = name.trim_matches(|c| c == '"' || c == '\'');
        if bare.is_empty() {
            return Err("a part of it is empty".to_owned());
        }
        found.push(Step::Name(bare.to_owned()));
        for index in indices.split('[').skip(1) {
            let number = index.strip_suffix(']').and_then(|text| text.parse().ok());
            let number = number.ok_or_else(|| format!("`[{index}` is no place in a list"))?;
            found.push(Step::Index(number));
        }
    }
    Ok(found)
}

/// A text divided where a letter stands outside of quotes and brackets.
fn divided(text: &str, at: char) -> Vec<String> {
    let mut found = vec![String::new()];
    let mut depth = 0;
    let mut quote = None;
    for letter in text.chars() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, _) if letter == at && depth <= 0 => {
                found.push(String::new());
                continue;
            }
            _ => (),
        }
        if let Some(last) = found.last_mut() {
            last.push(letter);
        }
    }
    found
}

fn put(item: &mut Item, path: &str, steps: &[Step], value: &Value) -> Result<(), String> {
    let Some((step, rest)) = steps.split_first() else {
        match item.as_value_mut() {
            Some(old) => replace(old, value.clone()),
            None => *item = Item::Value(value.clone()),
        }
        return Ok(());
    };
    match step {
        Step::Name(name) if item.is_array_of_tables() => {
            let index = named(item, name);
            let own = format!("{path}.{name}");
            let mut element = taken(item, path, index)?;
            let done = put(&mut element, &own, rest, value);
            give_back(item, index, element);
            done
        }
        Step::Name(name) => {
            let inline = item.is_inline_table();
            let table = item.as_table_like_mut();
            let table = table.ok_or_else(|| format!("`{path}` is no table"))?;
            let path = match path {
                "" => name.clone(),
                path => format!("{path}.{name}"),
            };
            if !table.contains_key(name) {
                // Filled below.
                let list = EFFECTS.contains(&path.as_str()) && rest.len() == 2;
                let new = if list {
                    Item::ArrayOfTables(ArrayOfTables::new())
                } else {
                    empty(rest, inline)
                };
                table.insert(name, new);
            }
            match table.get_mut(name) {
                Some(inner) => put(inner, &path, rest, value),
                None => Err(format!("`{path}` cannot be made")),
            }
        }
        Step::Index(index) => {
            let own = format!("{path}[{index}]");
            let mut element = taken(item, path, *index)?;
            let done = put(&mut element, &own, rest, value);
            give_back(item, *index, element);
            done
        }
    }
}

/// Tables that a list has by their names.
const EFFECTS: [&str; 2] = ["effect", "arm.effect"];

/// Name of an effect and what says where it is: of the catalogue its joint, of an arm file as in `gear_ripple joint=2`.
fn name_and_places(name: &str) -> (&str, Vec<(&str, Value)>) {
    let mut words = name.split_whitespace();
    let (kind, joint) = vocabulary(words.next().unwrap_or_default());
    let mut places: Vec<(&str, Value)> = words
        .filter_map(|word| word.split_once('='))
        .map(|(key, text)| match text.parse::<i64>() {
            Ok(number) => (key, Value::from(number)),
            Err(_) => (key, Value::from(text)),
        })
        .collect();
    places.extend(joint.map(|joint| ("joint", Value::from(joint as i64))));
    (kind, places)
}

/// Place of the effect of a name in a list of them, put at its end where there is none.
fn named(item: &mut Item, name: &str) -> usize {
    let Some(tables) = item.as_array_of_tables_mut() else {
        return 0;
    };
    let (kind, places) = name_and_places(name);
    let shown = |value: &Value| value.to_string().trim().to_owned();
    let is_it = |table: &Table| {
        let own = table.get("name").and_then(Item::as_str);
        let same = |(key, value): &(&str, Value)| {
            let own = table.get(key).and_then(Item::as_value);
            own.is_some_and(|own| shown(own) == shown(value))
        };
        let has_joint = places.iter().any(|(key, _)| *key == "joint");
        own == Some(kind) && places.iter().all(same) && has_joint == table.contains_key("joint")
    };
    if let Some(place) = tables.iter().position(is_it) {
        return place;
    }
    let mut table = Table::new();
    table.insert("name", toml_edit::value(kind));
    for (key, place) in places {
        table.insert(key, toml_edit::value(place));
    }
    tables.push(table);
    tables.len() - 1
}

/// Item put where nothing stands: the value comes, or a table for it.
fn empty(rest: &[Step], inline: bool) -> Item {
    if rest.is_empty() {
        Item::Value(Value::from(0))
    } else if inline {
        Item::Value(InlineTable::new().into())
    } else {
        let mut table = Table::new();
        table.set_implicit(rest.len() > 1);
        Item::Table(table)
    }
}

/// An element of a list, taken out of it.
fn taken(item: &mut Item, path: &str, index: usize) -> Result<Item, String> {
    let beyond = |count: usize| format!("`{path}` has {count}, counted from 0");
    if let Some(tables) = item.as_array_of_tables_mut() {
        let count = tables.len();
        let table = tables.get_mut(index).ok_or_else(|| beyond(count))?;
        return Ok(Item::Table(std::mem::take(table)));
    }
    let Some(list) = item.as_array_mut() else {
        return Err(format!("`{path}` is no list in the file"));
    };
    let count = list.len();
    let element = list.get_mut(index).ok_or_else(|| beyond(count))?;
    Ok(Item::Value(std::mem::replace(element, Value::from(0))))
}

/// Puts an element back where it was taken from. A value in place of a table is refused by whoever reads the file.
fn give_back(item: &mut Item, index: usize, element: Item) {
    if let Some(tables) = item.as_array_of_tables_mut() {
        if let (Some(slot), Ok(table)) = (tables.get_mut(index), element.into_table()) {
            *slot = table;
        }
    } else if let Some(slot) = item.as_array_mut().and_then(|list| list.get_mut(index))
        && let Ok(value) = element.into_value()
    {
        *slot = value;
    }
}

/// Puts a value in place of another, between the same spaces and comments.
pub(super) fn replace(old: &mut Value, mut new: Value) {
    *new.decor_mut() = old.decor().clone();
    *old = new;
}

/// Changes the value of a key, if the document has it; `*` at its end is every key of a table.
pub(super) fn change(item: &mut Item, key: &str, to: &dyn Fn(&mut Value)) {
    let (name, rest) = key.split_once('.').unwrap_or((key, ""));
    let Some(table) = item.as_table_like_mut() else {
        return;
    };
    let mut one = |inner: &mut Item| match rest {
        "" => drop(inner.as_value_mut().map(to)),
        rest => change(inner, rest, to),
    };
    if name == "*" {
        all(table, &mut one);
    } else if let Some(inner) = table.get_mut(name) {
        one(inner);
    }
}

fn all(table: &mut dyn TableLike, change: &mut dyn FnMut(&mut Item)) {
    for (_, inner) in table.iter_mut() {
        change(inner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
# about it
title = \"a\" # named
[process]
force_n = 150 # the spindle's
list = [1, 2, 3]
inner = { a = 1 }
[[command]]
at_s = 0
[[command]]
at_s = 1
";

    fn after(key: &str, text: &str) -> Result<String, String> {
        let mut document: DocumentMut = TEXT.parse().unwrap();
        KeyValue::typed(key, text).apply(&mut document)?;
        Ok(document.to_string())
    }

    #[test]
    fn a_value_is_written_at_its_key_and_nothing_else_changes() {
        for (key, text, from, to) in [
            ("process.force_n", "30", "force_n = 150 #", "force_n = 30 #"),
            (
                "process.force_n",
                ".5",
                "force_n = 150 #",
                "force_n = 0.5 #",
            ),
            ("title", "b c", "title = \"a\" #", "title = \"b c\" #"),
            ("title", "\"30\"", "title = \"a\" #", "title = \"30\" #"),
            ("process.list[1]", "-7", "[1, 2, 3]", "[1, -7, 3]"),
            ("process.list", "[4]", "[1, 2, 3]", "[4]"),
            ("process.inner.a", "true", "{ a = 1 }", "{ a = true }"),
            ("command[1].at_s", "2", "at_s = 1", "at_s = 2"),
        ] {
            assert_eq!(after(key, text).unwrap(), TEXT.replace(from, to), "{key}");
        }
    }

    #[test]
    fn an_effect_is_identified_by_its_name_and_joint() {
        let mut document: DocumentMut = TEXT.parse().unwrap();
        let mut put = |key: &str, value: f64| {
            KeyValue::number(key, value).apply(&mut document).unwrap();
        };
        put("effect.tool_runout.sine_m", 0.25);
        put("effect.joint_friction_3.friction_n_m", 20.0);
        put("effect.tool_runout.frequency_hz", 120.0);
        put("effect.joint_friction_3.friction_n_m", 21.0);
        let expected = "
[[effect]]
name = \"tool_runout\"
sine_m = 0.25
frequency_hz = 120

[[effect]]
name = \"joint_friction\"
joint = 3
friction_n_m = 21
";
        assert_eq!(document.to_string(), TEXT.to_owned() + expected);
    }

    #[test]
    fn what_is_not_there_is_made() {
        let value = |key: &str, text: &str, pointer: &[&str]| {
            let table: toml::Table = after(key, text).unwrap().parse().unwrap();
            let mut value = toml::Value::Table(table);
            for name in pointer {
                value = value[*name].clone();
            }
            value
        };
        let of = |text: &str| text.to_owned().into();
        assert_eq!(
            value("controller.kind", "pi", &["controller", "kind"]),
            of("pi")
        );
        let deep = ["device", "override", "bore_mm"];
        assert_eq!(value("device.override.bore_mm", "40", &deep), 40.into());
        assert_eq!(
            value("process.inner.b.c", "1", &["process", "inner", "b", "c"]),
            1.into()
        );
        let quoted = ["variables", "controller.gain", "min"];
        assert_eq!(
            value("variables.\"controller.gain\".min", "1", &quoted),
            1.into()
        );
    }

    #[test]
    fn what_leads_nowhere_is_refused() {
        for (key, reason) in [
            ("process.force_n.x", "`process.force_n` is no table"),
            ("command[2].at_s", "`command` has 2, counted from 0"),
            ("process.list[3]", "`process.list` has 3, counted from 0"),
            ("title[0]", "`title` is no list in the file"),
            ("command[a]", "`[a]` is no place in a list"),
            ("process..x", "a part of it is empty"),
        ] {
            assert_eq!(after(key, "1").unwrap_err(), reason);
        }
    }

    #[test]
    fn commas_within_brackets_and_quotes_divide_nothing() {
        assert_eq!(listed("30,60, 90"), ["30", "60", "90"]);
        assert_eq!(listed("[0, 1],[2,3]"), ["[0, 1]", "[2,3]"]);
        assert_eq!(listed("\"a,b\",c"), ["\"a,b\"", "c"]);
        assert_eq!(listed("30,"), ["30", ""]);
    }
}
