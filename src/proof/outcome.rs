//! Outcome of one case of a sweep; a small file each, so that a sweep goes on where it was stopped.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::case_conditions::CaseConditions;
use super::score::CaseScore;

/// A case of a sweep and its score.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Its making: what must agree for a sweep to go on.
    pub made: Made,
    /// The effect's share of the largest that is plausible [1]; 0 where nothing is concealed.
    pub share: f64,
    /// Its visibility beside all that is tolerated, in standard deviations [1].
    pub shows: f64,
    /// Its numbers by name.
    pub parameters: BTreeMap<String, f64>,
    /// The score.
    pub score: CaseScore,
}

/// Making of a case of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Made {
    /// The effect; none where nothing is concealed.
    pub effect: Option<String>,
    /// Its size: 0 is the largest.
    pub size: usize,
    /// Number of sizes.
    pub sizes: usize,
    /// Seed of device, programmes and noise.
    pub seed: u64,
    /// Length of each recording [s].
    pub duration_s: f64,
    /// Conditions under which it was made.
    #[serde(default)]
    pub conditions: CaseConditions,
}

impl std::fmt::Display for Made {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let effect = self.effect.as_deref().unwrap_or("nothing");
        let Self {
            size,
            sizes,
            seed,
            duration_s,
            conditions,
            ..
        } = self;
        write!(
            formatter,
            "{effect}, size {size} of {sizes}, seed {seed}, {duration_s} s, {conditions:?}"
        )
    }
}

impl Outcome {
    /// Whether the effect was named, alone or with others.
    pub fn seen(&self) -> bool {
        let sought = if self.score.unlisted {
            Some("unlisted")
        } else {
            self.made.effect.as_deref()
        };
        let answered = self.score.answered.iter().flatten();
        sought.is_some_and(|sought| answered.into_iter().any(|name| name == sought))
    }

    /// The answer, in a word.
    pub fn answered(&self) -> String {
        match &self.score.answered {
            None => "no answer".to_owned(),
            Some(names) if names.is_empty() => "nothing".to_owned(),
            Some(names) => names.join(" + "),
        }
    }
}
