//! A scenario file with other values for some of its keys: what a design study simulates, and what `idc run --set` does.

mod edit;

use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, TomlError, Value};

use super::AnyScenario;
use super::any::{from_text, keys_of_text};
use super::sections::{bench_sections, scenario_sections};
use crate::keys::document::{read_text, toml_text};
use crate::keys::error::{Location, ScenarioError};
use crate::keys::suggestion::nearest_dotted;

pub use edit::{KeyValue, listed};

/// Keys that name files or folders, from the scenario's folder; `*` stands for any name.
const PATHS: [&str; 6] = [
    "arm.urdf",
    "arm.recorded_arm",
    "arm.packages.*",
    "device.model",
    "workpiece.mesh",
    "workpiece.burr.path",
];

/// A scenario file, read once and checked as it stands.
#[derive(Debug, Clone)]
pub struct ScenarioTemplate {
    path: PathBuf,
    text: String,
    title: String,
    is_bench: bool,
    /// Whether it stands in no file.
    is_text: bool,
}

impl ScenarioTemplate {
    /// Reads a file of either kind.
    ///
    /// # Errors
    /// It is no scenario as it stands.
    pub fn read(path: &Path) -> Result<Self, ScenarioError> {
        Self::new(path, read_text(path)?, false)
    }

    /// A scenario that stands in no file, of its tables and keys as JSON has them. Its paths lead from the folder of `path`, by which messages call it.
    ///
    /// # Errors
    /// It is no scenario.
    pub fn of_json(path: &Path, tables: &serde_json::Value) -> Result<Self, ScenarioError> {
        let text = toml_text(tables).map_err(|reason| ScenarioError::Syntax {
            location: bare(path),
            reason,
        })?;
        let without_line = |error: ScenarioError| match error.location() {
            Some(location) if location.file == path => error.at(bare(path)),
            _ => error,
        };
        Self::new(path, text, true).map_err(without_line)
    }

    fn new(path: &Path, text: String, is_text: bool) -> Result<Self, ScenarioError> {
        let (title, is_bench) = match from_text(path, &text)? {
            AnyScenario::Cell(cell) => (cell.title, false),
            AnyScenario::Bench(bench) => (bench.title, true),
        };
        Ok(Self {
            path: path.to_owned(),
            text,
            title,
            is_bench,
            is_text,
        })
    }

    /// Whether it stands in no file.
    #[must_use]
    pub fn is_text(&self) -> bool {
        self.is_text
    }

    /// Keys that it gives in a table, those of tables in it by their names.
    ///
    /// # Errors
    /// None, once it has been read.
    pub fn keys_given(&self, table: &str) -> Result<Vec<String>, ScenarioError> {
        keys_of_text(&self.path, &self.text, table)
    }

    /// Its file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it is of a bench, not of a cell.
    #[must_use]
    pub fn is_bench(&self) -> bool {
        self.is_bench
    }

    /// Its name for people.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The scenario with these values for these keys, whatever the file says of them.
    ///
    /// # Errors
    /// As of a file with these values; a key of the scenario is named without a line, as no file holds the value.
    pub fn with(&self, edits: &[KeyValue]) -> Result<AnyScenario, ScenarioError> {
        let text = self.text(edits)?;
        from_text(&self.path, &text).map_err(|error| self.without_line(error))
    }

    /// The file's text with these values for these keys; what it says of other keys, and its comments, stay as they are.
    ///
    /// # Errors
    /// A key leads through what is no table or list, or beyond a list's end.
    pub fn text(&self, edits: &[KeyValue]) -> Result<String, ScenarioError> {
        let mut document = self.document()?;
        for edit in edits {
            edit.apply(&mut document).map_err(|reason| {
                let key = edit.key().to_owned();
                ScenarioError::Misplaced {
                    location: self.bare(),
                    key,
                    reason,
                }
            })?;
        }
        Ok(document.to_string())
    }

    /// As `text`, for a file that is to stand in another folder: its paths lead from there, or from the root, to what they lead to now.
    ///
    /// # Errors
    /// As `text`.
    pub fn text_in(&self, folder: &Path, edits: &[KeyValue]) -> Result<String, ScenarioError> {
        let text = self.text(edits)?;
        let mut document: DocumentMut = text.parse().map_err(|error| self.syntax(&error))?;
        let from = self.path.parent().unwrap_or(Path::new(""));
        for key in PATHS {
            edit::change(document.as_item_mut(), key, &|value: &mut Value| {
                if let Some(path) = value.as_str() {
                    let path = led_to(&from.join(path), folder);
                    edit::replace(value, Value::from(path));
                }
            });
        }
        Ok(document.to_string())
    }

    /// Whether a key is a count: it takes a whole number, and none half way to the next. The other edits come first.
    #[must_use]
    pub fn is_count(&self, key: &str, whole: i64, others: &[KeyValue]) -> bool {
        let tried = |value: f64| {
            let own = KeyValue::number(key, value);
            let all: Vec<KeyValue> = others.iter().cloned().chain([own]).collect();
            self.with(&all)
        };
        let whole = whole as f64;
        match (tried(whole), tried(whole + 0.5)) {
            (Ok(_), Err(_)) => true,
            // What goes with other values alone may be refused for them; a value of the wrong kind is refused first, by its own key.
            (Err(whole), Err(half)) => whole.key() != half.key(),
            (_, Ok(_)) => false,
        }
    }

    /// Advice on a key that a scenario of its kind does not have: the nearest one with its table.
    #[must_use]
    pub fn advice(&self, key: &str) -> String {
        let sections = match self.is_bench {
            true => bench_sections(),
            false => scenario_sections(),
        };
        nearest_dotted(key, &sections)
    }

    fn document(&self) -> Result<DocumentMut, ScenarioError> {
        self.text.parse().map_err(|error| self.syntax(&error))
    }

    fn syntax(&self, error: &TomlError) -> ScenarioError {
        ScenarioError::Syntax {
            location: self.bare(),
            reason: error.message().to_owned(),
        }
    }

    fn bare(&self) -> Location {
        bare(&self.path)
    }

    fn without_line(&self, error: ScenarioError) -> ScenarioError {
        match error.location() {
            // Its line is one of the text with the values in it.
            Some(location) if location.file == self.path => error.at(self.bare()),
            _ => error,
        }
    }
}

/// A file, and no place in it.
fn bare(file: &Path) -> Location {
    Location {
        file: file.to_owned(),
        position: None,
        excerpt: None,
    }
}

/// The path to a file or folder from another folder, both there: relative where they share more than the root.
#[must_use]
pub fn led_to(path: &Path, folder: &Path) -> String {
    let (Ok(full), Ok(folder)) = (path.canonicalize(), folder.canonicalize()) else {
        return path.display().to_string();
    };
    let shared = (full.components().zip(folder.components()))
        .take_while(|(one, other)| one == other)
        .count();
    if shared < 2 {
        return full.display().to_string();
    }
    let up = folder.components().skip(shared).map(|_| "..".into());
    let down = (full.components().skip(shared)).map(|part| part.as_os_str().to_owned());
    let parts: PathBuf = up.chain(down).collect();
    parts.display().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::BenchScenario;

    fn shipped(name: &str) -> PathBuf {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
        folder.join(format!("{name}.toml"))
    }

    fn edits(values: &[(&str, f64)]) -> Vec<KeyValue> {
        let edit = |(key, value): &(&str, f64)| KeyValue::number(*key, *value);
        values.iter().map(edit).collect()
    }

    fn bench(template: &ScenarioTemplate, values: &[(&str, f64)]) -> BenchScenario {
        match template.with(&edits(values)).unwrap() {
            AnyScenario::Bench(bench) => *bench,
            AnyScenario::Cell(_) => panic!("a cell"),
        }
    }

    fn refused(template: &ScenarioTemplate, key: &str, value: f64) -> String {
        let error = template.with(&edits(&[(key, value)])).unwrap_err();
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
        let parameters = &mut other.nominal.device;
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
        let before = &as_it_is.nominal.device;
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
        let message = refused(&template, "device.override.bore_mm", 400.0);
        assert!(
            message.ends_with(
                "hand_push.toml: `device.override.bore_mm` is 400 mm, expected 2 to 300 mm"
            ),
            "{message}"
        );
        let message = refused(&template, "device.override.cylinder_count", 1.5);
        assert!(message.contains("a whole number"), "{message}");
        let message = refused(&template, "device.override.bohr_mm", 30.0);
        assert!(message.contains("did you mean `bore_mm`?"), "{message}");
        let message = refused(&template, "bench.duration_s.long", 30.0);
        assert!(
            message.contains("`bench.duration_s` is no table"),
            "{message}"
        );
    }

    #[test]
    fn a_count_is_distinguished_from_a_number() {
        let cell = ScenarioTemplate::read(&shipped("deburred_edge")).unwrap();
        for (key, whole, expected) in [
            ("simulation.seed", 1, true),
            ("workpiece.burr.seed", 1, true),
            ("workpiece.edge.edge", 0, true),
            ("device.override.cylinder_count", 1, true),
            ("workpiece.misplacement.shift_mm", -1, false),
            ("process.force_n", 30, false),
            ("pass[1].force_n", 30, false),
            ("process.feed_mm_per_s", 20, false),
        ] {
            assert_eq!(cell.is_count(key, whole, &[]), expected, "{key}");
        }
    }

    /// Every shipped scenario, put elsewhere, is the same scenario.
    #[test]
    fn a_file_elsewhere_leads_to_the_same_files() {
        let folder = tempfile::tempdir().unwrap();
        let mut tried = 0;
        for entry in std::fs::read_dir(shipped("x").parent().unwrap()).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let template = ScenarioTemplate::read(&path).unwrap();
            let copy = folder.path().join("scenario.toml");
            std::fs::write(&copy, template.text_in(folder.path(), &[]).unwrap()).unwrap();
            let files = |path: &Path| match crate::scenario::load_any(path).unwrap() {
                AnyScenario::Cell(cell) => {
                    let full = |path: &PathBuf| path.canonicalize().unwrap();
                    let burr = match &cell.workpiece.burr {
                        crate::scenario::BurrScenario::Table { path } => Some(full(path)),
                        _ => None,
                    };
                    let mut files: Vec<PathBuf> = burr.into_iter().collect();
                    files.extend(
                        [&cell.arm.urdf, &cell.device.model, &cell.workpiece.mesh].map(full),
                    );
                    files.extend(cell.arm.package_directories.values().map(full));
                    files
                }
                AnyScenario::Bench(bench) => vec![bench.device.model.canonicalize().unwrap()],
            };
            assert_eq!(files(&path), files(&copy), "{}", path.display());
            tried += 1;
        }
        assert!(tried > 10, "{tried}");
    }
}
