//! explanations.json: what a diagnosis goes on from when a recording has come since, with the hashes of what it is made of.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::CaseError;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::search::kept::KeptExplanation;
use crate::recording::provenance::{Provenance, SourceFile};

/// Name of the file.
pub const EXPLANATIONS: &str = "explanations.json";
/// Version of its form.
const SCHEMA: u32 = 1;
/// Probability below which an explanation is not kept [1].
const LEAST: f64 = 1e-4;
/// Probability that none of them holds from which they are no start [1]: the right one would not be sought among others.
const LIKELY_NONE: f64 = 0.1;
/// Explanations at most.
const MOST: usize = 8;

/// Explanations of a diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Explanations {
    /// Version of the form.
    schema: u32,
    /// Folder of the case, as it was given.
    pub case: PathBuf,
    /// Scenario file of its cell; none of a bench.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scenario: Option<PathBuf>,
    /// Recordings beside those that its rig file names.
    pub recordings: Vec<PathBuf>,
    /// What they were found in.
    pub made_of: Provenance,
    /// Probability that none of them holds [1].
    pub none_of_these: f64,
    /// The explanations, the likeliest first.
    pub explanations: Vec<Kept>,
}

/// An explanation with its probability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// Probability among those that were fitted in full [1].
    pub probability: f64,
    /// The explanation.
    #[serde(flatten)]
    pub explanation: KeptExplanation,
}

impl Explanations {
    pub(super) fn of(
        (case, scenario, recordings): (&Path, Option<&Path>, &[PathBuf]),
        diagnosis: &Diagnosis,
        made_of: &Provenance,
    ) -> Self {
        let kept = diagnosis.ranked.iter().filter(|r| r.probability >= LEAST);
        let kept = kept.filter_map(|r| {
            Some(Kept {
                probability: r.probability,
                explanation: KeptExplanation::of(&r.hypothesis)?,
            })
        });
        Self {
            schema: SCHEMA,
            case: case.to_owned(),
            scenario: scenario.map(Path::to_owned),
            recordings: recordings.to_vec(),
            made_of: made_of.clone(),
            none_of_these: diagnosis.none_of_these(),
            explanations: kept.take(MOST).collect(),
        }
    }

    /// Reads the file of a diagnosis.
    ///
    /// # Errors
    /// A file that cannot be read, or is none of this form.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let refused = |reason: String| CaseError::Explanations {
            file: path.display().to_string(),
            reason,
        };
        let bytes = crate::file::read(path).map_err(|error| refused(error.to_string()))?;
        let read: Self =
            serde_json::from_slice(&bytes).map_err(|error| refused(error.to_string()))?;
        match read.schema {
            SCHEMA => Ok(read),
            other => Err(refused(format!("schema {other}, expected {SCHEMA}"))),
        }
    }

    /// As JSON.
    ///
    /// # Errors
    /// A number that is not finite.
    pub fn text(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// A file that they were found in, and that is not there as it was; none where all are: then it is the same case, with recordings more or without.
    #[must_use]
    pub fn lost(&self, now: &Provenance) -> Option<&str> {
        let is_there = |old: &&SourceFile| now.files.iter().any(|file| file.sha256 == old.sha256);
        let lost = self.made_of.files.iter().find(|old| !is_there(old));
        lost.map(|lost| lost.file.as_str())
    }

    /// Why a diagnosis of a case as it stands now cannot go on from them, in words; none where it can: the same program, every file that they were found in is
    /// there as it was, and it is likely that one of them holds.
    #[must_use]
    pub fn outdated(&self, now: &Provenance) -> Option<String> {
        if let Some(lost) = self.lost(now) {
            return Some(format!("{lost} has changed"));
        }
        if self.none_of_these > LIKELY_NONE {
            return Some("none of its explanations was likely to hold".to_owned());
        }
        let program = |one: &Provenance| (one.program.clone(), one.libraries.clone());
        (program(&self.made_of) != program(now))
            .then(|| "it is of another version of the program".to_owned())
    }
}

/// A path that holds wherever the program is called from.
pub(super) fn whole(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
