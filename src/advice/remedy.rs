//! A change of a scenario that makes its job possible, and all that were found.

use std::fmt;

use crate::scenario::KeyValue;

/// A change of a scenario with which its job can be done.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedy {
    /// What is changed, one word for programs.
    pub kind: &'static str,
    /// What is changed, for people.
    pub words: String,
    /// Keys of the scenario with their values then.
    pub edits: Vec<KeyValue>,
}

/// Changes to a scenario each of which alone makes its job possible.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Advice {
    /// The changes, in the order in which they were looked for.
    pub remedies: Vec<Remedy>,
    /// Kinds of change that were looked for.
    pub tried: Vec<&'static str>,
    /// Whether the search ended before all was tried, its extent being used up.
    pub cut_short: bool,
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let edits = self.edits.iter();
        let edits = edits.map(|edit| format!("{} = {}", edit.key(), edit.shown()));
        let edits: Vec<_> = edits.collect();
        write!(f, "{}: {}", self.words, edits.join(" and "))
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.tried.is_empty() {
            return Ok(());
        }
        if self.remedies.is_empty() {
            let tried = self.tried.join(", ");
            write!(
                f,
                "; no change was found with which it can be done (tried: {tried})"
            )?;
        } else {
            let ways = self.remedies.iter().map(ToString::to_string);
            let ways: Vec<_> = ways.collect();
            write!(f, "; it can be done with {}", ways.join(", or with "))?;
        }
        if self.cut_short {
            write!(f, "; not all was tried, --effort 3 searches longer")?;
        }
        Ok(())
    }
}
