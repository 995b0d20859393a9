//! The TOML of a study file, key by key. Plain data: defaults and ranges are the business of `study` and `variable`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Deserialize;

use crate::scenario::schema::plain_schema;
use crate::scenario::sections::keys;

/// Version of the format.
pub(super) const SCHEMA: u32 = 1;

/// A study file.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub schema: u32,
    pub study: StudyKeys,
    #[serde(default)]
    pub objective: ObjectiveKeys,
    #[serde(default)]
    pub limits: BTreeMap<String, BoundKeys>,
    #[serde(default)]
    pub variables: BTreeMap<String, VariableKeys>,
}

/// `[study]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyKeys {
    pub title: String,
    pub scenarios: Vec<PathBuf>,
    pub seed: Option<u64>,
    pub evaluations: Option<usize>,
}

/// `[objective]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectiveKeys {
    pub minimise: Option<String>,
    pub minimise_over: Option<OverKeys>,
    pub trade_off: Option<String>,
    pub trade_off_over: Option<OverKeys>,
    pub front_points: Option<usize>,
}

/// How the scenarios make one number.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum OverKeys {
    /// Their mean.
    Mean,
    /// The largest.
    Worst,
}

/// A quantity in `[limits]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BoundKeys {
    pub min: Option<f64>,
    pub max: Option<f64>,
}

/// A variable in `[variables]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct VariableKeys {
    pub min: Option<f64>,
    pub max: Option<f64>,
    pub start: f64,
    pub scale: Option<ScaleKeys>,
    pub catalogue: Option<Vec<f64>>,
    pub rod_mm: Option<Vec<f64>>,
}

/// How a variable is stepped through.
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
    ]
}
