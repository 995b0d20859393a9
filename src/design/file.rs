//! The TOML of a study file, key by key. Plain data: defaults and ranges are the business of `study` and `variable`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Deserialize;

use crate::scenario::schema::plain_schema;
use crate::scenario::sections::keys;

/// Seed of the search, and of the draws.
pub(super) const DEFAULT_SEED: u64 = 1;

/// Version of the format.
pub(super) const SCHEMA: u32 = 1;

/// A study file: what is varied, what is minimised, and what must be kept.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    /// Version of the format.
    #[schemars(range(min = 1, max = 1))]
    pub schema: u32,
    /// The study and its scenarios.
    pub study: StudyKeys,
    /// The objective.
    #[serde(default)]
    pub objective: ObjectiveKeys,
    /// Limits kept in every scenario that gives the metric: metrics by name, and `force_n`, forces that the device must be able to give at rest [N].
    #[serde(default)]
    pub limits: BTreeMap<String, BoundKeys>,
    /// Variables: keys of `[device.override]` or, in quotes, of a table of the scenario.
    #[serde(default)]
    pub variables: BTreeMap<String, VariableKeys>,
    /// What varies from part to part and is not the designer's to choose, drawn at the chosen design.
    pub robustness: Option<RobustnessKeys>,
}

/// `[study]`: its scenarios and its search.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyKeys {
    /// Name for people.
    pub title: String,
    /// Scenario files, of benches or cells, from the study's folder.
    #[schemars(length(min = 1))]
    pub scenarios: Vec<PathBuf>,
    /// Seed of the search.
    #[schemars(extend("default" = 1))]
    pub seed: Option<u64>,
    /// Most designs that are simulated, at least 50 for each variable.
    #[schemars(range(min = 50, max = 1_000_000), extend("default" = 2000))]
    pub evaluations: Option<usize>,
}

/// `[objective]`: what is minimised.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectiveKeys {
    /// Metric of docs/METRICS.md.
    #[schemars(extend("default" = "coefficient_of_variation_percent"))]
    pub minimise: Option<String>,
    /// Reduction of the scenarios to one number of it.
    #[schemars(extend("default" = "mean"))]
    pub minimise_over: Option<OverKeys>,
    /// Second objective, for the front: a metric, or one of the variables.
    pub trade_off: Option<String>,
    /// Reduction of the scenarios to one number of it; not of a variable.
    #[schemars(extend("default" = "mean"))]
    pub trade_off_over: Option<OverKeys>,
    /// Levels of the second objective at which the front is sought.
    #[schemars(range(min = 3, max = 50), extend("default" = 8))]
    pub front_points: Option<usize>,
}

/// Reduction of the scenarios to one number.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum OverKeys {
    /// Their mean.
    Mean,
    /// The largest.
    Worst,
}

/// A quantity in `[limits]`: one side, or both.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BoundKeys {
    /// The least that is allowed, in the unit of its name.
    pub min: Option<f64>,
    /// The most that is allowed, in the unit of its name.
    pub max: Option<f64>,
}

/// A variable in `[variables]`: a range, or a catalogue.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct VariableKeys {
    /// The least that is tried, in the key's unit.
    pub min: Option<f64>,
    /// The most that is tried, in the key's unit.
    pub max: Option<f64>,
    /// Its value in the design that all is compared with.
    pub start: f64,
    /// Scale of its steps.
    #[schemars(extend("default" = "linear"))]
    pub scale: Option<ScaleKeys>,
    /// Values that there are; for `bore_mm` the standard bores unless given.
    #[schemars(length(min = 1))]
    pub catalogue: Option<Vec<f64>>,
    /// Rod that goes with each bore of the catalogue [mm].
    #[schemars(length(min = 1))]
    pub rod_mm: Option<Vec<f64>>,
}

/// `[robustness]`: draws at the chosen design.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RobustnessKeys {
    /// Draws, each of them simulated in every scenario.
    #[schemars(range(min = 10, max = 100_000), extend("default" = 40))]
    pub runs: Option<usize>,
    /// Seed of the draws.
    #[schemars(extend("default" = 1))]
    pub seed: Option<u64>,
    /// What is drawn: keys of `[device.override]` or, in quotes, of any table of the scenario.
    #[serde(default)]
    pub variables: BTreeMap<String, ScatterKeys>,
}

/// A table of `[robustness.variables]`: evenly from `min` to `max`, or normally distributed, then between `min` and `max` where they are given.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ScatterKeys {
    /// The least that is drawn, in the key's unit.
    pub min: Option<f64>,
    /// The most that is drawn, in the key's unit.
    pub max: Option<f64>,
    /// Mean of a normal distribution, in the key's unit.
    pub mean: Option<f64>,
    /// Its standard deviation, in the key's unit.
    pub standard_deviation: Option<f64>,
    /// Whether it is a whole number, as a seed is.
    #[schemars(extend("default" = false))]
    pub whole: Option<bool>,
}

/// Scale of a variable's steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum ScaleKeys {
    /// Equal differences.
    Linear,
    /// Equal ratios.
    Log,
}

/// JSON Schema of a study file, for editors.
#[must_use]
pub fn schema() -> serde_json::Value {
    plain_schema::<StudyFile>()
}

/// Tables of a study file with their keys; `*` stands for a name that the user gives.
pub(super) fn study_sections() -> Vec<(&'static str, &'static [&'static str])> {
    vec![
        ("", keys::<StudyFile>()),
        ("study", keys::<StudyKeys>()),
        ("objective", keys::<ObjectiveKeys>()),
        ("limits.*", keys::<BoundKeys>()),
        ("variables.*", keys::<VariableKeys>()),
        ("robustness", keys::<RobustnessKeys>()),
        ("robustness.variables.*", keys::<ScatterKeys>()),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::robustness::DEFAULT_RUNS;
    use super::super::study::{DEFAULT_EVALUATIONS, DEFAULT_FRONT_POINTS, DEFAULT_METRIC};
    use super::DEFAULT_SEED;

    #[test]
    fn the_schema_tells_the_defaults_that_are_taken() {
        let schema = super::schema();
        let default = |table: &str, key: &str| {
            schema["properties"][table]["properties"][key]["default"].clone()
        };
        assert_eq!(default("study", "seed"), DEFAULT_SEED);
        assert_eq!(default("study", "evaluations"), DEFAULT_EVALUATIONS);
        assert_eq!(default("robustness", "runs"), DEFAULT_RUNS);
        assert_eq!(default("robustness", "seed"), DEFAULT_SEED);
        assert_eq!(default("objective", "minimise"), DEFAULT_METRIC);
        assert_eq!(default("objective", "front_points"), DEFAULT_FRONT_POINTS);
    }
}
