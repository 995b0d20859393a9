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

/// Subject of a part of an account.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SectionKind {
    /// Where recordings and model differ.
    Mismatch,
    /// The link of the chain that does not explain its own recording.
    Link,
    /// The effects that were found.
    Missing,
    /// Errors that remain.
    Remaining,
    /// Explanations that were ruled out.
    RuledOut,
    /// Explanations that the recordings do not tell apart.
    Ambiguous,
    /// The experiment to make next.
    NextExperiment,
    /// Numbers of the rig file, moved within their tolerances.
    OwnNumbers,
    /// Remarks on the recordings.
    Recordings,
    /// Impact of a contact flange.
    Impact,
    /// Its ringing.
    Ringing,
    /// Its settling.
    Settling,
    /// Its steady force error.
    SteadyError,
    /// Its force error while the arm moves.
    ErrorWhileMoving,
    /// Prediction of a run of it that was not fitted to.
    UnseenRun,
    /// Its runs.
    Runs,
    /// Joints and servos of a cell.
    Arm,
    /// Places on a cell's path.
    PathPlaces,
    /// What the improved file has no place for.
    NotWritten,
    /// Commands for the improved file.
    HowToRun,
}

impl SectionKind {
    /// Its title.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Mismatch => "Where it differs",
            Self::Link => "Which link",
            Self::Missing => "What is missing",
            Self::Remaining => "What is left",
            Self::RuledOut => "What was ruled out",
            Self::Ambiguous => "What the recordings do not tell apart",
            Self::NextExperiment => "What to record next",
            Self::OwnNumbers => "The rig file's own numbers",
            Self::Recordings => "The recordings",
            Self::Impact => "Impact",
            Self::Ringing => "Ringing",
            Self::Settling => "Settling",
            Self::SteadyError => "Steady error",
            Self::ErrorWhileMoving => "While the arm moves",
            Self::UnseenRun => "A run that it never saw",
            Self::Runs => "The runs",
            Self::Arm => "The arm",
            Self::PathPlaces => "Where on the path",
            Self::NotWritten => "What improved.toml leaves out",
            Self::HowToRun => "How to run what was found",
        }
    }
}

/// A part of an account.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Its subject.
    pub kind: SectionKind,
    /// The same for people.
    pub title: String,
    /// A paragraph each.
    pub paragraphs: Vec<String>,
    /// Lines that stand as they are, below the paragraphs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<String>,
}

impl Account {
    /// Adds a part, if it says anything.
    pub fn add(&mut self, kind: SectionKind, paragraphs: Vec<String>) {
        let paragraphs: Vec<String> = paragraphs.into_iter().filter(|p| !p.is_empty()).collect();
        if !paragraphs.is_empty() {
            self.sections.push(Section {
                kind,
                title: kind.title().to_owned(),
                paragraphs,
                table: None,
            });
        }
    }

    /// A part of it, if it says anything of that.
    #[must_use]
    pub fn section(&self, kind: SectionKind) -> Option<&Section> {
        self.sections.iter().find(|section| section.kind == kind)
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
        account.add(SectionKind::Mismatch, self.where_it_parts());
        account.add(SectionKind::Link, self.which_link());
        account.add(SectionKind::Missing, self.what_is_missing());
        if let Some(section) = account.sections.last_mut() {
            section.table = self.shape_table();
        }
        account.add(SectionKind::Remaining, self.what_is_left());
        account.add(SectionKind::RuledOut, vec![self.what_was_ruled_out()]);
        account.add(SectionKind::Ambiguous, self.not_told_apart());
        account.add(SectionKind::NextExperiment, vec![self.what_next()]);
        account.add(SectionKind::OwnNumbers, vec![self.own_numbers()]);
        let notes = self.notes.iter().map(|n| format!("{n}."));
        account.add(SectionKind::Recordings, notes.collect());
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
