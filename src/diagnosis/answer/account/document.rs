//! An account as a document: its parts and their kinds.

use crate::listed::listed;
use serde::{Deserialize, Serialize};

/// An account: the sentences of a diagnosis, which its document arranges.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Its conclusion.
    pub headline: String,
    /// Its parts, in order.
    pub sections: Vec<AccountSection>,
}

listed! {
    /// Subject of a part of an account.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum SectionKind,
    /// Its title.
    title: &'static str {
        /// Where recordings and model differ.
        Mismatch = "Where it differs",
        /// The link of the chain that does not explain its own recording.
        Link = "Which link",
        /// The effects that were found.
        Missing = "What is missing",
        /// Errors that remain.
        Remaining = "What is left",
        /// A law that a user tried.
        Tried = "The law tried",
        /// Explanations that were ruled out.
        RuledOut = "What was ruled out",
        /// Explanations that the recordings do not tell apart.
        Ambiguous = "What the recordings do not tell apart",
        /// The experiment to make next.
        NextExperiment = "What to record next",
        /// Numbers of the rig file, moved within their tolerances.
        OwnNumbers = "The rig file's own numbers",
        /// Remarks on the recordings.
        Recordings = "The recordings",
        /// Impact of a contact flange.
        Impact = "Impact",
        /// Its ringing.
        Ringing = "Ringing",
        /// Its settling.
        Settling = "Settling",
        /// Its steady force error.
        SteadyError = "Steady error",
        /// Its force error while the arm moves.
        ErrorWhileMoving = "While the arm moves",
        /// The same simulated.
        Simulated = "As a simulation",
        /// Prediction of a run of it that was not fitted to.
        UnseenRun = "A run that it never saw",
        /// Its runs.
        Runs = "The runs",
        /// Joints and servos of a cell.
        Arm = "The arm",
        /// Places on a cell's path.
        PathPlaces = "Where on the path",
        /// What the improved file has no place for.
        NotWritten = "What improved.toml leaves out",
        /// Numbers for a robot's controller.
        Controller = "What to write into the controller",
        /// Commands for the improved file.
        HowToRun = "How to run what was found",
    }
}

/// A part of an account.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccountSection {
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
            self.sections.push(AccountSection {
                kind,
                title: kind.title().to_owned(),
                paragraphs,
                table: None,
            });
        }
    }

    /// Adds to a part, with words on which of two subjects each paragraph is of; a part of its own where there is none of that kind.
    pub fn add_to(&mut self, kind: SectionKind, [of_own, of_added]: [&str; 2], added: Vec<String>) {
        let of = |section: &&mut AccountSection| section.kind == kind;
        match self.sections.iter_mut().find(of) {
            Some(section) if !added.is_empty() => {
                section.paragraphs.insert(0, of_own.to_owned());
                section.paragraphs.push(of_added.to_owned());
                section.paragraphs.extend(added);
            }
            Some(_) => {}
            None => self.add(kind, added),
        }
    }

    /// Adds a remark on the recordings and on what became of them.
    pub fn remark(&mut self, sentence: &str) {
        let paragraph = format!("{sentence}.");
        let of = |section: &&mut AccountSection| section.kind == SectionKind::Recordings;
        match self.sections.iter_mut().find(of) {
            Some(section) => section.paragraphs.push(paragraph),
            None => self.add(SectionKind::Recordings, vec![paragraph]),
        }
    }

    /// A part of it, if it says anything of that.
    #[must_use]
    pub fn section(&self, kind: SectionKind) -> Option<&AccountSection> {
        self.sections.iter().find(|section| section.kind == kind)
    }
}
