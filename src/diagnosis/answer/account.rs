//! The account: what an engineer can act on.

mod difference;
mod document;
mod doubts;
mod link;
mod missing;
mod rivals;
mod tried;
mod unlisted;

pub use document::{Account, AccountSection, SectionKind};

use super::details::RemainingError;
use super::finding::Diagnosis;
use super::words::listed;

/// Other channels that differ from the model, named at most.
const MOST_OTHERS: usize = 3;

impl Diagnosis {
    /// The account.
    #[must_use]
    pub fn account(&self) -> Account {
        let mut account = Account {
            headline: self.headline(),
            sections: Vec::new(),
        };
        account.add(SectionKind::Mismatch, self.where_it_differs());
        account.add(SectionKind::Link, self.which_link());
        account.add(SectionKind::Missing, self.what_is_missing());
        if let Some(section) = account.sections.last_mut() {
            section.table = self.shape_table().or_else(|| self.smallest_table());
        }
        account.add(SectionKind::Remaining, self.what_is_left());
        account.add(SectionKind::Tried, self.how_the_law_fares());
        account.add(SectionKind::RuledOut, vec![self.what_was_ruled_out()]);
        account.add(SectionKind::Ambiguous, self.not_distinguished());
        account.add(SectionKind::NextExperiment, vec![self.what_next()]);
        account.add(SectionKind::OwnNumbers, vec![self.own_numbers()]);
        let notes = self.notes.iter().map(|n| format!("{n}."));
        account.add(SectionKind::Recordings, notes.collect());
        account
    }

    fn headline(&self) -> String {
        let stopped = match self.effort.stopped {
            true => "; the search was stopped by its limit",
            false => "",
        };
        format!("{}{stopped}", self.finding())
    }

    /// The finding in a line.
    fn finding(&self) -> String {
        let names = self.headline_names();
        if names.is_empty() && !self.best().finds_nothing() {
            "what is missing is not settled: no effect is sure".to_owned()
        } else if names.is_empty() {
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
