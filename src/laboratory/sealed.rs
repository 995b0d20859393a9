//! The sealed truth of a case: what only a score may look at.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The truth of a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SealedCase {
    /// Name of the case.
    pub case: String,
    /// Effects at work.
    pub effects: Vec<SealedEffect>,
    /// Effects of the vocabulary that are there too, of a size that may be seen: to name them is no error.
    #[serde(default)]
    pub also_there: Vec<String>,
    /// Standard deviation of each channel's noise, by column.
    pub noise: BTreeMap<String, f64>,
    /// Where it shows.
    pub mismatch: Vec<SealedInterval>,
    /// The nominal numbers as they really are.
    #[serde(default)]
    pub true_parameters: BTreeMap<String, f64>,
    /// Visibility of the effects beside all that is tolerated, in standard deviations [1]; 0 where it is not known.
    #[serde(default)]
    pub shows: f64,
    /// Seed.
    pub seed: u64,
}

/// Something at work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SealedEffect {
    /// Name that an answer should give.
    pub name: String,
    /// The true effect.
    pub truth: String,
    /// Where it enters.
    pub subsystem: String,
    /// Its numbers by name; of an unlisted one `depends_on`.
    pub parameters: BTreeMap<String, Known>,
    /// Of a law: the law in a line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
}

/// A number, or names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Known {
    /// A number.
    Number(f64),
    /// Names.
    Names(Vec<String>),
}

/// A time in which a channel is moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SealedInterval {
    /// Name of the recording, without `.csv`.
    pub recording: String,
    /// Column.
    pub channel: String,
    /// From [s].
    pub start_s: f64,
    /// Until [s].
    pub end_s: f64,
}
