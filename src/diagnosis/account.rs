//! The account: what an engineer can act on.

mod difference;
mod link;
mod missing;
mod rivals;
mod unlisted;

use serde::{Deserialize, Serialize};

use super::answer::UNLISTED;
use super::details::RemainingError;
use super::diagnose::{Diagnosis, names_of};
use super::words::{listed, wrapped};

/// Other channels that differ from the model, named at most.
const MOST_OTHERS: usize = 3;

/// An account: what account.txt says, and a page.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Its conclusion.
    pub headline: String,
    /// Its parts, in order.
    pub sections: Vec<Section>,
}

/// A part of an account.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Its subject.
    pub title: String,
    /// A paragraph each.
    pub paragraphs: Vec<String>,
    /// Lines that stand as they are, below the paragraphs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<String>,
}

impl Account {
    /// Adds a part, if it says anything.
    pub fn add(&mut self, title: &str, paragraphs: Vec<String>) {
        let paragraphs: Vec<String> = paragraphs.into_iter().filter(|p| !p.is_empty()).collect();
        if !paragraphs.is_empty() {
            self.sections.push(Section {
                title: title.to_owned(),
                paragraphs,
                table: None,
            });
        }
    }

    /// As text, under the name of the case.
    #[must_use]
    pub fn text(&self, case: &str) -> String {
        let mut text = format!("{case}: {}\n", self.headline);
        for section in &self.sections {
            text.push_str(&format!("\n{}\n", section.title));
            for paragraph in &section.paragraphs {
                text.push_str(&wrapped("  ", paragraph));
            }
            text.push_str(section.table.as_deref().unwrap_or_default());
        }
        text
    }
}

impl Diagnosis {
    /// The account.
    #[must_use]
    pub fn account(&self) -> Account {
        let mut account = Account {
            headline: self.headline(),
            sections: Vec::new(),
        };
        account.add("Where it parts", self.where_it_parts());
        account.add("Which link", self.which_link());
        account.add("What is missing", self.what_is_missing());
        if let Some(section) = account.sections.last_mut() {
            section.table = self.shape_table();
        }
        account.add("What is left", self.what_is_left());
        account.add("What was ruled out", vec![self.what_was_ruled_out()]);
        let title = "What the recordings do not tell apart";
        account.add(title, self.not_told_apart());
        account.add("What to record next", vec![self.what_next()]);
        account.add("The rig file's own numbers", vec![self.own_numbers()]);
        let notes = self.notes.iter().map(|n| format!("{n}."));
        account.add("The recordings", notes.collect());
        account
    }

    fn headline(&self) -> String {
        let mut names = names_of(self.best());
        if let Some(unlisted) = names.iter_mut().find(|name| *name == UNLISTED) {
            "physics that no known effect explains".clone_into(unlisted);
        }
        if names.is_empty() {
            let errors = self.remaining_errors();
            match errors.iter().any(RemainingError::is_beyond_noise) || self.remaining.is_some() {
                false => "nothing is missing".to_owned(),
                true => "no effect is found missing, and more than noise is left".to_owned(),
            }
        } else {
            format!("missing: {}", listed(&names))
        }
    }

    fn name(&self, recording: usize) -> &str {
        &self.evidence.recordings[recording].name
    }
}
