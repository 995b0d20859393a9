//! `--set KEY=VALUE[,VALUE..]`: from the command line to the runs that it asks for.

use std::collections::BTreeSet;

use super::super::error::AppError;
use crate::scenario::{KeyValue, ScenarioError, ScenarioTemplate, listed};

/// Runs at most.
const MOST: usize = 1000;
/// Letters of a folder's name at most.
const LONGEST: usize = 120;

/// A key with the values that it is to have in turn.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Setting {
    key: String,
    values: Vec<KeyValue>,
}

impl Setting {
    /// As it is typed.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let expected = "expected KEY=VALUE or KEY=VALUE,VALUE,.. with a key of the scenario by its dotted path, as in process.force_n=30,60";
        let (key, values) = text.split_once('=').ok_or(expected)?;
        let key = key.trim();
        let values = listed(values);
        if key.is_empty() || values.iter().any(String::is_empty) {
            return Err(expected.to_owned());
        }
        let mut seen = BTreeSet::new();
        if let Some(twice) = values.iter().find(|value| !seen.insert(*value)) {
            return Err(format!("{twice} is in it twice, expected each value once"));
        }
        Ok(Self {
            values: values.iter().map(|v| KeyValue::typed(key, v)).collect(),
            key: key.to_owned(),
        })
    }
}

/// One of the runs.
#[derive(Debug, Clone)]
pub(super) struct Variant {
    /// Its values in place of the scenario's, in the order of the flags.
    pub edits: Vec<KeyValue>,
    /// Name of its folder: what differs between the runs; empty where there is one alone.
    pub name: String,
}

impl Variant {
    /// Its name for people, added to the scenario's title.
    pub(super) fn title(&self, title: &str) -> Option<KeyValue> {
        let own = self.edits.iter().any(|edit| edit.key() == "title");
        let differs = !self.name.is_empty() && !own;
        let words = self.name.replace('=', " = ").replace(',', ", ");
        differs.then(|| KeyValue::text("title", &format!("{title}: {words}")))
    }
}

/// The product of all settings; the last one changes first.
pub(super) fn product(settings: &[Setting]) -> Result<Vec<Variant>, AppError> {
    let refuse = |reason: String| AppError::Setting { reason };
    let mut keys = BTreeSet::new();
    if let Some(twice) = settings.iter().find(|s| !keys.insert(&s.key)) {
        let key = &twice.key;
        return Err(refuse(format!(
            "{key} is given twice, expected all its values in one --set {key}=VALUE,VALUE,.."
        )));
    }
    let count = (settings.iter())
        .try_fold(1usize, |count, s| count.checked_mul(s.values.len()))
        .unwrap_or(usize::MAX);
    if count > MOST {
        return Err(refuse(format!(
            "they ask for {count} runs, expected at most {MOST}"
        )));
    }
    let mut variants = vec![Variant {
        edits: Vec::new(),
        name: String::new(),
    }];
    for setting in settings {
        let with = |variant: &Variant| {
            let edits = setting.values.iter().map(|value| {
                let mut variant = variant.clone();
                variant.edits.push(value.clone());
                variant
            });
            edits.collect::<Vec<_>>()
        };
        variants = variants.iter().flat_map(with).collect();
    }
    name(&mut variants, settings);
    Ok(variants)
}

/// Names folders by the keys that vary, each by its last part where that is its own.
fn name(variants: &mut [Variant], settings: &[Setting]) {
    let varied: Vec<&str> = (settings.iter())
        .filter(|setting| setting.values.len() > 1)
        .map(|setting| setting.key.as_str())
        .collect();
    let mut names = BTreeSet::new();
    for variant in variants {
        let own = variant
            .edits
            .iter()
            .filter(|edit| varied.contains(&edit.key()));
        let parts: Vec<String> = own
            .map(|edit| format!("{}={}", short(edit.key(), &varied), edit.shown()))
            .collect();
        let safe = safe(&parts.join(","));
        let mut name = safe.clone();
        let mut number = 2;
        // File systems may not tell capitals.
        while !names.insert(name.to_lowercase()) {
            name = format!("{safe}-{number}");
            number += 1;
        }
        variant.name = name;
    }
}

/// The last part of a key, or the whole of it where another one ends so.
pub(super) fn short<'a>(key: &'a str, among: &[&str]) -> &'a str {
    let last = |key: &'a str| key.rsplit('.').next().unwrap_or(key);
    let own = last(key);
    let alike = |other: &&&str| other.rsplit('.').next() == Some(own);
    if among.iter().filter(alike).count() > 1 {
        key
    } else {
        own
    }
}

/// A name that every file system and shell takes.
fn safe(name: &str) -> String {
    let letter = |c: char| match c {
        c if c.is_ascii_alphanumeric() => c,
        '.' | '_' | '-' | '+' | '=' | ',' => c,
        _ => '_',
    };
    name.chars().take(LONGEST).map(letter).collect()
}

/// Names the flag that a refusal is about: that of the key, or all where it is about none.
pub(in super::super) fn blamed(
    error: ScenarioError,
    edits: &[KeyValue],
    template: &ScenarioTemplate,
) -> AppError {
    let about = |edit: &&KeyValue| {
        error.key().is_some_and(|key| {
            let within = |inner: &str, outer: &str| {
                (inner.strip_prefix(outer)).is_some_and(|rest| {
                    rest.is_empty() || rest.starts_with('.') || rest.starts_with('[')
                })
            };
            within(key, edit.key()) || within(edit.key(), key)
        })
    };
    let own: Vec<KeyValue> = edits.iter().filter(about).cloned().collect();
    let error = match (error, own.as_slice()) {
        (ScenarioError::UnknownKey { location, .. }, [edit]) => ScenarioError::UnknownKey {
            location,
            key: edit.key().to_owned(),
            advice: template.advice(edit.key()),
        },
        (error, _) => error,
    };
    with_flags(error.into(), if own.is_empty() { edits } else { &own })
}

/// A refusal with the flags that led to it.
pub(super) fn with_flags(error: AppError, edits: &[KeyValue]) -> AppError {
    let flags = (edits.iter()).map(|edit| format!("--set {}={}", edit.key(), edit.shown()));
    AppError::Set {
        flags: flags.collect::<Vec<_>>().join(" "),
        source: Box::new(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(texts: &[&str]) -> Vec<String> {
        let settings: Vec<Setting> = texts.iter().map(|t| Setting::parse(t).unwrap()).collect();
        let variants = product(&settings).unwrap();
        variants.into_iter().map(|variant| variant.name).collect()
    }

    #[test]
    fn folders_are_called_by_what_differs() {
        assert_eq!(
            names(&["process.force_n=30,60", "process.feed_mm_per_s=5"]),
            ["force_n=30", "force_n=60"]
        );
        assert_eq!(
            names(&["a.x=1,2", "b.y=3,4"]),
            ["x=1,y=3", "x=1,y=4", "x=2,y=3", "x=2,y=4"]
        );
        assert_eq!(
            names(&["command[0].force_n=1,2", "process.force_n=3,4"])[0],
            "command_0_.force_n=1,process.force_n=3"
        );
        // A path is no path in a name, and no two are the same.
        assert_eq!(
            names(&["device.model=../a/b.toml,../a_b.toml"]),
            ["model=.._a_b.toml", "model=.._a_b.toml-2"]
        );
        assert_eq!(names(&["process.force_n=30"]), [""]);
    }

    #[test]
    fn what_is_no_setting_is_refused() {
        for text in ["force_n", "=30", "force_n=", "force_n=30,,60"] {
            assert!(Setting::parse(text).unwrap_err().contains("KEY=VALUE"));
        }
        let twice = Setting::parse("force_n=30,30").unwrap_err();
        assert!(twice.contains("30 is in it twice"), "{twice}");
        let setting = |text| Setting::parse(text).unwrap();
        let refused = |settings: &[Setting]| product(settings).unwrap_err().to_string();
        let message = refused(&[setting("a=1"), setting("a=2")]);
        assert!(message.contains("a is given twice"), "{message}");
        let many: Vec<String> = (0..32).map(|n| n.to_string()).collect();
        let many = many.join(",");
        let message = refused(&[setting(&format!("a={many}")), setting(&format!("b={many}"))]);
        assert!(
            message.contains("1024 runs, expected at most 1000"),
            "{message}"
        );
    }
}
