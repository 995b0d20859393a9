//! diagnosis.json: what was found, in the form of an answer that can be scored.

pub mod account;
pub mod band;
pub(super) mod certainty;
pub mod conclude;
pub mod details;
pub mod doubt;
pub mod estimate;
pub mod family;
pub mod finding;
pub mod parameters;
pub mod shared;
pub mod statements;
pub mod words;

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use self::details::Details;
use self::doubt::Doubt;
use self::parameters::Parameters;
use self::words::display_name;
use super::difference::mismatch::Mismatch;
use super::formula::unlisted::report::UnlistedReport;
use crate::effects::UNLISTED;
use crate::effects::meaning;
use crate::plant::LawText;
use crate::recorded_arm::vocabulary::arm_effect;
use crate::recording::RecordingError;
use crate::recording::atomic::write_text;

/// Version of the form that diagnoses are scored by; what goes beyond it is in `details`, which has a version of its own.
pub const SCHEMA: u32 = 1;

/// A diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Version of the format.
    pub schema: u32,
    /// Its conclusion.
    pub verdict: Verdict,
    /// Whether it predicts the recordings, each by the others, to near the noise of the sensors; none in files that are older.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explained: Option<Extent>,
    /// Physics that the nominal model lacks; nothing where nothing is missing.
    pub effects: Vec<FoundEffect>,
    /// Where the effects act.
    pub mismatch: Vec<Mismatch>,
    /// Wall time [s]; the one value that may differ between two runs.
    pub seconds: f64,
    /// Explanations that the recordings cannot tell apart.
    pub alternatives: Vec<Alternative>,
    /// Other notes for an engineer, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Details that are not scored.
    #[serde(flatten)]
    pub details: Details,
}

/// Verdict of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Known physics explains the recordings.
    Explained,
    /// The nominal model does.
    NothingMissing,
    /// Physics that has no name here is at work.
    Unlisted,
}

/// Extent to which recordings are explained.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// To near the sensors' noise, each recording by a fit to the others too.
    Fully,
    /// More than that is left; `departure` says how much and where.
    Partly,
}

/// An effect with what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoundEffect {
    /// Name in the vocabulary, or `unlisted`.
    pub name: String,
    /// Key of the rig file's number that is off, of `number_off`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// Where it enters.
    pub subsystem: String,
    /// Probability that it is at work [1].
    pub confidence: f64,
    /// Reasons why it is not stated as surer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<Doubt>,
    /// Its numbers by name, in the order of the vocabulary.
    pub parameters: Parameters,
    /// Variables on which it depends.
    pub depends_on: Vec<String>,
    /// The law, of an effect that is written as an expression.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<FoundLaw>,
    /// Knowledge of a model discrepancy.
    #[serde(flatten, default, skip_serializing_if = "Option::is_none")]
    pub unlisted: Option<Box<UnlistedReport>>,
}

/// A law as an expression.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoundLaw {
    /// Port at which it acts.
    pub acts_on: String,
    /// Its expression.
    pub is: String,
    /// Units of its constants, of those that have one.
    pub units: BTreeMap<String, String>,
}

impl FoundLaw {
    /// A law as a diagnosis reports it.
    #[must_use]
    pub fn of(law: &LawText) -> Self {
        let units = law.constants.iter();
        Self {
            acts_on: law.port.name().to_owned(),
            is: law.expression.text().to_owned(),
            units: units
                .filter_map(|c| Some((c.name.to_owned(), c.unit?.to_owned())))
                .collect(),
        }
    }

    /// In words.
    #[must_use]
    pub fn words(&self) -> String {
        let port = self.acts_on.replace('_', " ");
        format!("a law of the user's own, {port} = {}", self.is)
    }
}

impl FoundEffect {
    /// Its meaning, in a line for people.
    #[must_use]
    pub fn meaning(&self) -> String {
        if self.name == UNLISTED {
            return match &self.law {
                Some(law) => format!("{} = {}", law.acts_on.replace('_', " "), law.is),
                None => meaning(UNLISTED).to_owned(),
            };
        }
        if let Some(key) = &self.key {
            return format!("{key} is another than the rig file says");
        }
        // Joints of a cell have effects of the same name with a meaning of their own.
        let of_arm = arm_effect(&self.name).filter(|effect| effect.subsystem == self.subsystem);
        if let Some(effect) = of_arm {
            return effect.meaning.to_owned() + &self.parameters.place_words();
        }
        let own = self.law.as_ref().map(FoundLaw::words);
        own.unwrap_or_else(|| meaning(&self.name).to_owned())
    }

    /// Presentation of one of its numbers: words, unit, and that unit's multiples in one of SI.
    #[must_use]
    pub fn display_name(&self, name: &str) -> (String, String, f64) {
        if let Some(law) = &self.law {
            let unit = law.units.get(name).cloned().unwrap_or_default();
            return (name.to_owned(), unit, 1.0);
        }
        // The value of a number that is off is in the unit of its key.
        let (words, unit, factor) = display_name(self.key.as_deref().unwrap_or(name));
        (words, unit.to_owned(), factor)
    }
}

/// A set of effects that would do as well, or nearly.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alternative {
    /// Names.
    pub effects: Vec<String>,
    /// Formula of the model discrepancy among them, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// Odds against the answer given [1].
    pub odds: f64,
}

/// An answer that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum AnswerError {
    /// JSON has no such number.
    #[error("the diagnosis holds {value} as `{key}`, which is no number")]
    NotFinite {
        /// Which.
        key: String,
        /// Its value.
        value: f64,
    },
    /// The verdict does not go with the effects.
    #[error("the diagnosis says {verdict:?} with {count} effects named: {names}")]
    Verdict {
        /// Its verdict.
        verdict: Verdict,
        /// Number of effects that it names.
        count: usize,
        /// Their names.
        names: String,
    },
    /// JSON.
    #[error("cannot write the diagnosis as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The file.
    #[error(transparent)]
    Write(#[from] RecordingError),
}

impl Answer {
    /// Notes what became of a step that failed: what was found stands without it.
    pub fn note(&mut self, sentence: String) {
        self.details.account.remark(&sentence);
        self.notes.push(sentence);
    }

    /// A result of a last step; one that failed is noted and goes without.
    pub fn kept<T>(&mut self, what: &str, result: Result<T, impl std::fmt::Display>) -> Option<T> {
        result
            .map_err(|error| self.note(format!("{what} is missing: {error}")))
            .ok()
    }

    /// Takes out what is no number, and notes it: the rest of what was found is not lost for it.
    pub fn take_out_what_is_no_number(&mut self) {
        let mut notes: Vec<String> = Vec::new();
        for effect in &mut self.effects {
            let name = &effect.name;
            effect.parameters.retain(|(parameter, e)| {
                let finite = [e.value, e.low, e.high].iter().all(|v| v.is_finite());
                if !finite {
                    notes.push(format!("{parameter} of {name} could not be determined"));
                }
                finite
            });
            if !effect.confidence.is_finite() {
                effect.confidence = 0.0;
                notes.push(format!("how sure {name} is could not be determined"));
            }
            let shape = effect.unlisted.iter().flat_map(|u| u.numbers());
            if shape.into_iter().any(|(_, value)| !value.is_finite()) {
                effect.unlisted = None;
                notes.push(format!("the shape of {name} could not be determined"));
            }
        }
        let places = self.mismatch.len();
        (self.mismatch).retain(|place| place.start_s.is_finite() && place.end_s.is_finite());
        let rivals = self.alternatives.len();
        self.alternatives.retain(|rival| rival.odds.is_finite());
        if places > self.mismatch.len() || rivals > self.alternatives.len() {
            notes.push(
                "places of the mismatch or odds of rivals could not be determined".to_owned(),
            );
        }
        for note in notes {
            self.note(note);
        }
    }

    /// As JSON, numbers in their shortest form.
    ///
    /// # Errors
    /// A number that is not finite, a verdict that does not go with the effects.
    pub fn text(&self) -> Result<String, AnswerError> {
        self.check_verdict()?;
        if let Some((key, value)) = self.numbers().into_iter().find(|(_, v)| !v.is_finite()) {
            return Err(AnswerError::NotFinite { key, value });
        }
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Writes diagnosis.json, whole or not at all.
    ///
    /// # Errors
    /// As [`Self::text`], or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), AnswerError> {
        Ok(write_text(path, &self.text()?)?)
    }

    fn check_verdict(&self) -> Result<(), AnswerError> {
        let unlisted = self.effects.iter().any(|effect| effect.name == UNLISTED);
        let fits = match self.verdict {
            Verdict::NothingMissing => self.effects.is_empty(),
            Verdict::Explained => !self.effects.is_empty() && !unlisted,
            Verdict::Unlisted => unlisted,
        };
        if fits {
            return Ok(());
        }
        let names: Vec<&str> = self.effects.iter().map(|e| e.name.as_str()).collect();
        Err(AnswerError::Verdict {
            verdict: self.verdict,
            count: names.len(),
            names: names.join(", "),
        })
    }

    /// All numbers with their keys.
    fn numbers(&self) -> Vec<(String, f64)> {
        let mut numbers = vec![("seconds".to_owned(), self.seconds)];
        for effect in &self.effects {
            let name = &effect.name;
            numbers.push((format!("{name}.confidence"), effect.confidence));
            for (parameter, estimate) in &effect.parameters {
                let of = |key: &str| format!("{name}.{parameter}.{key}");
                numbers.push((of("value"), estimate.value));
                numbers.push((of("low"), estimate.low));
                numbers.push((of("high"), estimate.high));
            }
            let unlisted = effect.unlisted.iter().flat_map(|u| u.numbers());
            numbers.extend(unlisted.map(|(key, value)| (format!("{name}.{key}"), value)));
        }
        for mismatch in &self.mismatch {
            let of = |key: &str| format!("mismatch.{}.{key}", mismatch.recording);
            numbers.push((of("start_s"), mismatch.start_s));
            numbers.push((of("end_s"), mismatch.end_s));
        }
        let odds = self.alternatives.iter();
        numbers
            .extend(odds.map(|a| (format!("alternatives.{}.odds", a.effects.join("+")), a.odds)));
        numbers
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::estimate::Estimate;
    use super::*;

    pub(in super::super) fn answer() -> Answer {
        let estimate = Estimate::new;
        Answer {
            schema: SCHEMA,
            verdict: Verdict::Explained,
            explained: None,
            effects: vec![FoundEffect {
                name: "coulomb_viscous_friction".to_owned(),
                key: None,
                subsystem: "force_balance".to_owned(),
                confidence: 0.98,
                doubts: Vec::new(),
                parameters: vec![
                    (
                        "viscous_coefficient_n_s_per_m".to_owned(),
                        estimate(90.0, 70.0, 112.0),
                    ),
                    ("coulomb_force_n".to_owned(), estimate(12.1, 11.6, 12.7)),
                ]
                .into(),
                depends_on: vec!["velocity_sign".to_owned()],
                law: None,
                unlisted: None,
            }],
            mismatch: vec![Mismatch {
                recording: "ride.csv".to_owned(),
                channel: "force_n".to_owned(),
                start_s: 1.2,
                end_s: 1.48,
            }],
            seconds: 8.4,
            alternatives: vec![Alternative {
                formula: None,
                effects: vec!["stribeck_friction".to_owned()],
                odds: 0.02,
            }],
            notes: Vec::new(),
            details: Details::default(),
        }
    }

    #[test]
    fn the_file_has_the_keys_that_are_scored() {
        let json: serde_json::Value = serde_json::from_str(&answer().text().unwrap()).unwrap();
        assert_eq!(json["schema"], 1);
        assert_eq!(json["verdict"], "explained");
        let effect = &json["effects"][0];
        assert_eq!(effect["name"], "coulomb_viscous_friction");
        assert_eq!(effect["subsystem"], "force_balance");
        assert_eq!(effect["confidence"], 0.98);
        assert_eq!(effect["parameters"]["coulomb_force_n"]["low"], 11.6);
        assert_eq!(effect["depends_on"][0], "velocity_sign");
        let mismatch = &json["mismatch"][0];
        assert_eq!(mismatch["recording"], "ride.csv");
        assert_eq!(mismatch["channel"], "force_n");
        assert_eq!(
            (&mismatch["start_s"], &mismatch["end_s"]),
            (&1.2.into(), &1.48.into())
        );
        assert_eq!(json["seconds"], 8.4);
        assert_eq!(json["alternatives"][0]["odds"], 0.02);
        assert!(json.get("notes").is_none());
    }

    #[test]
    fn numbers_are_short_and_parameters_keep_their_order() {
        let text = answer().text().unwrap();
        assert!(text.contains("\"value\": 12.1,"), "{text}");
        let place = |name: &str| text.find(name).unwrap();
        assert!(place("viscous_coefficient") < place("coulomb_force_n"));
        let back: Answer = serde_json::from_str(&text).unwrap();
        assert_eq!(back, answer());
    }

    #[test]
    fn what_is_no_number_is_refused_by_its_key() {
        let mut bad = answer();
        bad.effects[0].parameters[1].1.high = f64::NAN;
        let message = bad.text().unwrap_err().to_string();
        assert_eq!(
            message,
            "the diagnosis holds NaN as `coulomb_viscous_friction.coulomb_force_n.high`, which is no number"
        );
        let mut bad = answer();
        bad.alternatives[0].odds = f64::INFINITY;
        assert!(
            bad.text()
                .unwrap_err()
                .to_string()
                .contains("alternatives.stribeck_friction.odds")
        );
        let null = answer().text().unwrap().replace("12.7", "null");
        assert!(serde_json::from_str::<Answer>(&null).is_err());
    }

    #[test]
    fn a_verdict_that_does_not_go_with_the_effects_is_refused() {
        let mut bad = answer();
        bad.verdict = Verdict::NothingMissing;
        assert!(
            bad.text()
                .unwrap_err()
                .to_string()
                .contains("NothingMissing with 1 effects named")
        );
        bad.verdict = Verdict::Unlisted;
        assert!(bad.text().is_err());
        bad.effects[0].name = UNLISTED.to_owned();
        assert!(bad.text().is_ok());
        bad.effects.clear();
        bad.verdict = Verdict::NothingMissing;
        assert!(bad.text().is_ok());
    }

    #[test]
    fn it_is_written_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("diagnosis.json");
        answer().write(&path).unwrap();
        assert_eq!(
            std::fs::read_to_string(&path).unwrap(),
            answer().text().unwrap()
        );
        assert!(
            answer()
                .write(&folder.path().join("nowhere/x.json"))
                .is_err()
        );
    }
}
