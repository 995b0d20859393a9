//! Where a run comes from: a scenario's file, or such a file with other values for some of its keys.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::super::error::AppError;
use super::super::files::{VARIED, provenance};
use crate::recording::provenance::{Provenance, SourceFile};
use crate::run::RunOrigin;
use crate::scenario::{KeyValue, ScenarioError, ScenarioTemplate};

/// A scenario as a run's files name it.
#[derive(Debug, Clone)]
pub(in super::super) struct Source {
    /// Its file.
    pub name: String,
    /// Whether it was made of no file.
    is_text: bool,
    varied: Option<Varied>,
}

/// A scenario's file with other values.
#[derive(Debug, Clone)]
struct Varied {
    edits: Vec<KeyValue>,
    /// Its text beside the file: the same wherever the results go.
    text: String,
    /// Its text in the results' folder, to which its paths are made to fit.
    copy: String,
}

impl Source {
    /// A file as it stands.
    pub(super) fn file(path: &Path) -> Self {
        Self {
            name: path.display().to_string(),
            is_text: false,
            varied: None,
        }
    }

    /// A file with other values, which goes with the results into a folder that is there.
    pub(super) fn varied(
        template: &ScenarioTemplate,
        edits: &[KeyValue],
        title: Option<KeyValue>,
        folder: &Path,
    ) -> Result<Self, ScenarioError> {
        let all: Vec<KeyValue> = edits.iter().cloned().chain(title).collect();
        Ok(Self {
            name: folder.join(VARIED).display().to_string(),
            is_text: template.is_text(),
            varied: Some(Varied {
                text: template.text(&all)?,
                copy: template.text_in(folder, &all)?,
                edits: edits.to_vec(),
            }),
        })
    }

    /// A file, or none, with other values, or none, of which nothing is written.
    pub(super) fn in_memory(
        template: &ScenarioTemplate,
        edits: &[KeyValue],
    ) -> Result<Self, ScenarioError> {
        let name = template.path().display().to_string();
        if edits.is_empty() && !template.is_text() {
            return Ok(Self::file(template.path()));
        }
        let text = template.text(edits)?;
        Ok(Self {
            name,
            is_text: template.is_text(),
            varied: Some(Varied {
                copy: text.clone(),
                text,
                edits: edits.to_vec(),
            }),
        })
    }

    /// varied.toml.
    pub(super) fn copy(&self) -> Option<&str> {
        Some(&self.varied.as_ref()?.copy)
    }

    /// The values, by key.
    pub(in super::super) fn set(&self) -> Option<Value> {
        let value = |edit: &KeyValue| match edit.as_number() {
            Some(number) => number.into(),
            None => Value::from(edit.shown()),
        };
        let edits = self.varied.as_ref()?.edits.iter();
        Some(
            edits
                .map(|edit| (edit.key().to_owned(), value(edit)))
                .collect(),
        )
    }

    /// What a result says of it.
    pub(super) fn origin(&self, provenance: Provenance) -> RunOrigin {
        RunOrigin {
            scenario: self.name.clone(),
            set: self.set(),
            provenance,
        }
    }

    /// Where a run of files, the scenario's first, comes from; and what the run is made of, wherever its files stand.
    pub(super) fn provenance(
        &self,
        files: &[&PathBuf],
        seed: u64,
    ) -> Result<(Provenance, String), AppError> {
        let existing = &files[usize::from(self.is_text)..];
        let mut origin = provenance(existing, seed)?;
        let Some(varied) = &self.varied else {
            let content = origin.content();
            return Ok((origin, content));
        };
        // The file that it was made of stays in the list.
        let own = |text: &str| SourceFile::holding(&self.name, text.as_bytes());
        origin.files.insert(0, own(&varied.text));
        let content = origin.content();
        origin.files[0] = own(&varied.copy);
        Ok((origin, content))
    }
}
