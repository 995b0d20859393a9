//! An account as a document: its parts and their kinds.

use serde::{Deserialize, Serialize};

use super::super::words::wrapped;

/// An account: what account.txt says, and a page.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Its conclusion.
    pub headline: String,
    /// Its parts, in order.
    pub sections: Vec<AccountSection>,
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
    /// A law that a user tried.
    Tried,
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
    /// The same simulated.
    Simulated,
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
            Self::Tried => "The law tried",
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
            Self::Simulated => "As a simulation",
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
