//! A scenario file with other numbers for some of its keys: what a design study simulates.

use std::path::{Path, PathBuf};

use super::AnyScenario;
use super::document::read_text;
use super::error::{Place, ScenarioError};
use super::load::from_text;

/// A scenario file, read once and checked as it stands.
#[derive(Debug, Clone)]
pub struct ScenarioTemplate {
    path: PathBuf,
    text: String,
}

impl ScenarioTemplate {
    /// Reads a file of either kind.
    ///
    /// # Errors
    /// It is no scenario as it stands.
    pub fn read(path: &Path) -> Result<Self, ScenarioError> {
        let text = read_text(path)?;
        from_text(path, &text)?;
        Ok(Self {
            path: path.to_owned(),
            text,
        })
    }

    /// The scenario with these values for these dotted keys, each in its key's unit, whatever the file says of them.
    ///
    /// # Errors
    /// As of a file with these values; a key of the scenario is named without a line, as no file holds the value.
    pub fn with(&self, values: &[(String, f64)]) -> Result<AnyScenario, ScenarioError> {
        let bare = Place {
            file: self.path.clone(),
            position: None,
            excerpt: None,
        };
        let mut table: toml::Table =
            self.text
                .parse()
                .map_err(|error: toml::de::Error| ScenarioError::Syntax {
                    place: bare.clone(),
                    reason: error.message().to_owned(),
                })?;
        for (key, value) in values {
            set(&mut table, key, *value);
        }
        from_text(&self.path, &table.to_string()).map_err(|error| match error.place() {
            // Its line is one of the text above.
            Some(place) if place.file == self.path => error.at(bare),
            _ => error,
        })
    }
}

/// Puts a number at a dotted key. What is no table on the way gives place to one, to be refused for what is in it or missing.
fn set(table: &mut toml::Table, key: &str, value: f64) {
    match key.split_once('.') {
        None => {
            // A count is a count: 2.0 cylinders are refused.
            let whole = value.fract() == 0.0 && value.abs() < 1e15;
            let value = if whole {
                toml::Value::Integer(value as i64)
            } else {
                toml::Value::Float(value)
            };
            table.insert(key.to_owned(), value);
        }
        Some((first, rest)) => {
            let inner = table
                .entry(first)
                .or_insert_with(|| toml::Table::new().into());
            if !inner.is_table() {
                *inner = toml::Table::new().into();
            }
            if let toml::Value::Table(inner) = inner {
                set(inner, rest, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::BenchScenario;

    fn shipped(name: &str) -> PathBuf {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
        folder.join(format!("{name}.toml"))
    }

    fn bench(template: &ScenarioTemplate, values: &[(&str, f64)]) -> BenchScenario {
        let values: Vec<(String, f64)> =
            values.iter().map(|(k, v)| ((*k).to_owned(), *v)).collect();
        match template.with(&values).unwrap() {
            AnyScenario::Bench(bench) => *bench,
            AnyScenario::Cell(_) => panic!("a cell"),
        }
    }

    fn refused(template: &ScenarioTemplate, key: &str, value: f64) -> String {
        let error = template.with(&[(key.to_owned(), value)]).unwrap_err();
        assert_eq!(error.key(), Some(key));
        error.to_string()
    }

    #[test]
    fn only_the_keys_named_are_other_ones() {
        let path = shipped("paper_step");
        let template = ScenarioTemplate::read(&path).unwrap();
        let as_it_is = bench(&template, &[]);
        let mut other = bench(
            &template,
            &[
                ("device.override.bore_mm", 40.0),
                ("device.override.regulator_time_constant_s", 0.25),
                ("device.override.cylinder_count", 3.0),
            ],
        );
        let parameters = &mut other.device.parameters;
        assert_eq!(
            (
                parameters.bore,
                parameters.regulator.time_constant,
                parameters.cylinder_count
            ),
            (0.04, 0.25, 3)
        );
        // The file's own override stays where it is not replaced.
        assert_eq!(parameters.regulator.dead_time, 0.5);
        let before = &as_it_is.device.parameters;
        parameters.bore = before.bore;
        parameters.cylinder_count = before.cylinder_count;
        parameters.regulator.time_constant = before.regulator.time_constant;
        assert_eq!(format!("{other:?}"), format!("{as_it_is:?}"));
        let loaded = crate::scenario::load_bench(&path).unwrap();
        assert_eq!(format!("{as_it_is:?}"), format!("{loaded:?}"));
    }

    #[test]
    fn what_cannot_be_is_refused_by_its_key() {
        let template = ScenarioTemplate::read(&shipped("hand_push")).unwrap();
        let message = refused(&template, "device.override.bore_mm", 300.0);
        assert!(
            message.ends_with(
                "hand_push.toml: `device.override.bore_mm` is 300 mm, expected 4 to 200 mm"
            ),
            "{message}"
        );
        let message = refused(&template, "device.override.cylinder_count", 1.5);
        assert!(message.contains("a whole number"), "{message}");
        let message = refused(&template, "device.override.bohr_mm", 30.0);
        assert!(message.contains("did you mean `bore_mm`?"), "{message}");
    }
}
