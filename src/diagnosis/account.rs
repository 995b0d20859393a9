//! The account: what an engineer can act on.

mod link;
mod missing;
mod parting;
mod rivals;
mod unlisted;

use super::answer::UNLISTED;
use super::diagnose::{Diagnosis, names_of};
use super::words::{listed, wrapped};

/// Other channels that part from the model, named at most.
const MOST_OTHERS: usize = 3;

impl Diagnosis {
    /// The account of a case by its name.
    #[must_use]
    pub fn account(&self, case: &str) -> String {
        let mut text = format!("{case}: {}\n", self.headline());
        let mut part = |title, paragraphs: &[String]| add(&mut text, title, paragraphs);
        part("Where it parts", &self.where_it_parts());
        part("Which link", &self.which_link());
        part("What is missing", &self.what_is_missing());
        text.push_str(&self.shape_table().unwrap_or_default());
        let mut part = |title, paragraphs: &[String]| add(&mut text, title, paragraphs);
        part("What is left", &self.what_is_left());
        part("What was ruled out", &[self.what_was_ruled_out()]);
        let title = "What the recordings do not tell apart";
        part(title, &self.not_told_apart());
        part("What to record next", &[self.what_next()]);
        part("The rig file's own numbers", &[self.own_numbers()]);
        let notes: Vec<String> = self.notes.iter().map(|n| format!("{n}.")).collect();
        part("The recordings", &notes);
        text
    }

    fn headline(&self) -> String {
        let mut names = names_of(self.best());
        if let Some(unlisted) = names.iter_mut().find(|name| *name == UNLISTED) {
            *unlisted = "physics that no known effect explains".to_owned();
        }
        if names.is_empty() {
            "nothing is missing".to_owned()
        } else {
            format!("missing: {}", listed(&names))
        }
    }

    fn name(&self, recording: usize) -> &str {
        &self.evidence.recordings[recording].name
    }
}

/// Adds paragraphs under a title, where there are any.
fn add(text: &mut String, title: &str, paragraphs: &[String]) {
    let mut paragraphs = paragraphs.iter().filter(|p| !p.is_empty()).peekable();
    if paragraphs.peek().is_none() {
        return;
    }
    text.push_str(&format!("\n{title}\n"));
    for paragraph in paragraphs {
        text.push_str(&wrapped("  ", paragraph));
    }
}
