//! Result of a study. Serialises to design.json, where every number is in the unit that its name ends with.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Write;

use serde::{Deserialize, Deserializer, Serialize};

use super::candidate::{Design, ScenarioOutcome};
use super::limits::Side;
use super::robustness::Robustness;
use crate::recording::provenance::Provenance;
use crate::scenario::AssumedValue;

/// A study with what it was made of: design.json.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudyDocument {
    /// The study's file.
    pub study: String,
    /// Files of its scenarios.
    pub scenarios: Vec<String>,
    /// Variables, and their bounds.
    pub variables: Vec<VariedKey>,
    /// Its result.
    #[serde(flatten)]
    pub result: StudyResult,
    /// Values in use that nobody has measured in public.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[serde(rename = "judged")]
    pub assumed: Vec<AssumedValue>,
    /// Its origin.
    #[serde(default)]
    pub provenance: Provenance,
}

/// A key that is varied, in its own unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariedKey {
    /// The key.
    pub key: String,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// The values that there are, of a catalogue.
    pub choices: Option<Vec<f64>>,
}

/// The result of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudyResult {
    /// Version of the format.
    pub schema: u32,
    /// The study's title.
    pub title: String,
    /// Names of the objectives.
    pub objectives: ObjectiveNames,
    /// Seed of the search.
    pub seed: u64,
    /// Designs that were evaluated.
    pub evaluations: usize,
    /// Those of them that could not be simulated or kept not all limits, by the reason or by the limit most exceeded.
    pub infeasible: BTreeMap<String, usize>,
    /// The starting design.
    pub start: Candidate,
    /// The chosen design: it keeps all limits, and none that was found has a lower objective.
    pub chosen: Candidate,
    /// Designs of which none is better in both objectives, by the second one; empty without one.
    pub front: Vec<FrontPoint>,
    /// Variables of the chosen design that sit on a bound, within 0.5 % of their range.
    pub active_bounds: Vec<ActiveBound>,
    /// Limits that the chosen design just keeps, within 0.5 % of the bound.
    pub active_limits: Vec<ActiveLimit>,
    /// Effect of a change of one variable alone on the chosen design.
    pub sensitivities: Vec<Sensitivity>,
    /// What draws at the chosen design do, if the study asks for them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robustness: Option<Robustness>,
    /// Both objectives of every other design that keeps the limits, second one first.
    #[serde(default)]
    pub others: Vec<[f64; 2]>,
}

/// Names of both objectives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ObjectiveNames {
    /// Metric that was minimised, unit included.
    pub minimised: String,
    /// `mean` or `worst` over the scenarios.
    pub minimised_over: Cow<'static, str>,
    /// Metric or variable of the second objective, unit included.
    pub trade_off: Option<String>,
    /// `mean` or `worst` over the scenarios; none for a variable.
    pub trade_off_over: Option<Cow<'static, str>>,
    /// Number of scenarios.
    pub scenarios: usize,
}

/// A design with all that it does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Keys and values.
    pub design: Design,
    /// The objective, in its unit.
    #[serde(deserialize_with = "number")]
    pub objective: f64,
    /// The second objective, in its unit.
    pub trade_off: Option<f64>,
    /// Whether it keeps all limits.
    pub feasible: bool,
    /// Each limit.
    pub limits: Vec<LimitState>,
    /// Least and greatest force at rest [N].
    #[serde(rename = "force_range_n")]
    pub force_range: [f64; 2],
    /// Metrics by scenario.
    pub scenarios: Vec<ScenarioOutcome>,
}

/// A limit and what a design reaches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitState {
    /// `impact_peak_n at most 400 N`.
    pub limit: String,
    /// Its key, unit included.
    pub key: String,
    /// `min` or `max`.
    pub side: Side,
    /// Its bound, in that unit.
    pub bound: f64,
    /// Value that the design reaches, in that unit.
    #[serde(deserialize_with = "number")]
    pub value: f64,
    /// Whether it is kept.
    pub kept: bool,
    /// Whether it is kept, but by no more than 0.5 % of the bound.
    pub active: bool,
}

/// A point of the front.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrontPoint {
    /// The second objective, in its unit.
    pub trade_off: f64,
    /// The objective, in its unit.
    pub objective: f64,
    /// The design.
    pub design: Design,
}

/// A variable on its bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ActiveBound {
    /// Its key.
    pub variable: String,
    /// `min` or `max`.
    pub side: Side,
    /// The bound, in the key's unit.
    pub bound: f64,
    /// Change of the objective if the variable alone went beyond it by a tenth, or to the next entry [%]; none if that cannot be simulated.
    pub objective_change_percent: Option<f64>,
}

/// A limit that the chosen design just keeps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ActiveLimit {
    /// `impact_peak_n at most 400 N`.
    pub limit: String,
    /// What its bound was loosened to for the next number [`unit`].
    pub loosened_to: f64,
    /// Unit of the bound.
    pub unit: String,
    /// Change of the objective when all continuous variables are chosen anew under the looser limit [%].
    pub objective_change_percent: Option<f64>,
}

/// Effect of a change of one variable alone on the chosen design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sensitivity {
    /// Its key.
    pub variable: String,
    /// Value that was tried: a tenth more or less, or the next entry of the catalogue.
    pub value: f64,
    /// Change of the variable [%].
    pub change_percent: f64,
    /// Change of the objective [%]; none if it cannot be simulated.
    pub objective_change_percent: Option<f64>,
    /// Whether the value lies outside the study's bounds.
    pub beyond_bound: bool,
    /// Limits that it breaks.
    pub breaks: Vec<String>,
    /// Why it cannot be simulated.
    pub failure: Option<String>,
}

/// A number that JSON may have as `null` because it is none.
fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

impl StudyResult {
    /// The chosen design as TOML that a scenario takes as it stands, with a comment that says where it is from.
    #[must_use]
    pub fn override_text(&self) -> String {
        let names = &self.objectives;
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "# Design study: {}",
            self.title.replace(char::is_control, " ")
        );
        let _ = writeln!(
            text,
            "# {} {} (start: {})",
            names.minimised,
            crate::quantity::display_name::number(self.chosen.objective),
            crate::quantity::display_name::number(self.start.objective),
        );
        text + &self.chosen.design.override_text()
    }

    /// Steps within the bounds that keep the limits and still lower the objective by more than `percent`: the search has not ended then.
    pub fn improving_steps(&self, percent: f64) -> impl Iterator<Item = &Sensitivity> {
        self.sensitivities.iter().filter(move |step| {
            let lower = step
                .objective_change_percent
                .is_some_and(|change| change < -percent);
            lower && !step.beyond_bound && step.breaks.is_empty()
        })
    }
}
