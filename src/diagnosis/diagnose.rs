//! From a case to everything that is found in it.

use super::answer::{Alternative, Answer, Estimate, FoundEffect, Mismatch, SCHEMA, Verdict};
use super::case::{Case, Prepared, prepare};
use super::clean::Cleaning;
use super::estimate::{Estimates, estimates};
use super::evidence::Evidence;
use super::mismatch::{Interval, intervals};
use super::recorded::{COLUMNS, RecordedError};
use super::search::{Hypothesis, Search};
use crate::plant::PlantParameters;

/// Odds below which an explanation is no alternative [1].
pub const LEAST_ODDS: f64 = 0.01;

/// An explanation among others.
#[derive(Debug, Clone)]
pub struct Ranked {
    /// The explanation.
    pub hypothesis: Hypothesis,
    /// What it costs, penalty included [1].
    pub score: f64,
    /// Its odds against the best one [1].
    pub odds: f64,
    /// Its probability among those looked at in full [1].
    pub probability: f64,
}

/// What was found.
#[derive(Debug)]
pub struct Diagnosis {
    /// The rig as believed.
    pub believed: PlantParameters,
    /// The recordings, cleaned.
    pub evidence: Evidence,
    /// What was set aside in each of them.
    pub cleanings: Vec<Cleaning>,
    /// What an engineer should know of the recordings, a sentence each.
    pub notes: Vec<String>,
    /// Explanations, best first.
    pub ranked: Vec<Ranked>,
    /// Numbers of the best.
    pub estimates: Estimates,
    /// Where its effects act.
    pub mismatch: Vec<Interval>,
}

/// Diagnoses a case; `say` is told how far it is.
///
/// # Errors
/// Recordings that nothing can be told from.
pub fn diagnose(case: &Case, say: &mut dyn FnMut(&str)) -> Result<Diagnosis, RecordedError> {
    let Prepared {
        evidence,
        cleanings,
        notes,
    } = prepare(case)?;
    let search = Search {
        evidence: &evidence,
        believed: case.believed.clone(),
        tolerated: case.tolerated.clone(),
    };
    let found = search.run(say);
    let ranked = rank(&search, found);
    let best = &ranked[0].hypothesis;
    Ok(Diagnosis {
        believed: case.believed.clone(),
        estimates: estimates(&case.believed, best, evidence.count()),
        mismatch: intervals(&evidence, &case.believed, best),
        ranked,
        cleanings,
        notes,
        evidence,
    })
}

fn rank(search: &Search<'_>, found: Vec<Hypothesis>) -> Vec<Ranked> {
    let scores: Vec<f64> = found.iter().map(|h| search.score(h)).collect();
    let odds = |score: f64| (-0.5 * (score - scores[0])).exp();
    let sum: f64 = scores.iter().map(|score| odds(*score)).sum();
    found
        .into_iter()
        .zip(&scores)
        .map(|(hypothesis, score)| Ranked {
            hypothesis,
            score: *score,
            odds: odds(*score),
            probability: odds(*score) / sum,
        })
        .collect()
}

impl Diagnosis {
    /// The best explanation.
    pub fn best(&self) -> &Hypothesis {
        &self.ranked[0].hypothesis
    }

    /// Rivals that the recordings do not rule out.
    pub fn rivals(&self) -> impl Iterator<Item = &Ranked> {
        self.ranked[1..].iter().filter(|r| r.odds >= LEAST_ODDS)
    }

    /// Probability that an effect is at work, by its name.
    fn confidence(&self, name: &str) -> f64 {
        let names = |r: &&Ranked| r.hypothesis.effects.iter().any(|e| e.name == name);
        let with = self.ranked.iter().filter(names);
        with.map(|r| r.probability).sum::<f64>().min(1.0)
    }

    /// What is missing, with its numbers: the one place where a diagnosis gets its effects from.
    fn found(&self) -> Vec<FoundEffect> {
        let effects = self.estimates.effects.iter();
        effects
            .map(|(effect, numbers)| FoundEffect {
                name: effect.name.to_owned(),
                subsystem: effect.subsystem.name().to_owned(),
                confidence: self.confidence(effect.name),
                parameters: numbers
                    .iter()
                    .filter(|number| number.reported)
                    .map(|number| {
                        let [low, high] = number.interval;
                        let value = number.value;
                        (number.name.to_owned(), Estimate { value, low, high })
                    })
                    .collect(),
                depends_on: Vec::new(),
            })
            .collect()
    }

    /// What an engineer can act on.
    pub fn account(&self) -> String {
        self.notes.join("\n") + "\n"
    }

    /// diagnosis.json.
    pub fn answer(&self, seconds: f64) -> Answer {
        let effects = self.found();
        Answer {
            schema: SCHEMA,
            verdict: if effects.is_empty() {
                Verdict::NothingMissing
            } else {
                Verdict::Explained
            },
            effects,
            mismatch: self
                .mismatch
                .iter()
                .map(|interval| Mismatch {
                    recording: self.evidence.recordings[interval.recording].name.clone(),
                    channel: COLUMNS[interval.channel as usize].to_owned(),
                    start_s: interval.start,
                    end_s: interval.end,
                })
                .collect(),
            seconds,
            alternatives: self
                .rivals()
                .map(|ranked| Alternative {
                    effects: names_of(&ranked.hypothesis),
                    odds: ranked.odds,
                })
                .collect(),
            notes: self.notes.clone(),
        }
    }
}

/// Names of an explanation's effects.
pub fn names_of(hypothesis: &Hypothesis) -> Vec<String> {
    let effects = hypothesis.effects.iter();
    effects.map(|effect| effect.name.to_owned()).collect()
}
