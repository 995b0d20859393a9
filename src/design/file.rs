//! Keys of a study file; what they must be to each other is the business of `study` and `variable`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Deserialize;

use crate::keys::declaration::of_file;
use crate::keys::declaration::{Plain, keys};

/// Version of the format.
pub(super) const SCHEMA: u32 = 1;

impl Plain for OverKeys {}
impl Plain for ScaleKeys {}

keys! {
    /// A study file: what is varied, what is minimised, and what must be kept.
    pub(super) struct StudyFile {
        /// version of the format
        schema: u32 = "schema" in 1..=1;
        study: StudyKeys = "study";
        objective: ObjectiveKeys = "objective";
        /// limits kept in every scenario that gives the metric: metrics by name, and `force_n`, forces that the device must be able to give at rest [N]
        limits: BTreeMap<String, BoundKeys> = "limits";
        /// variables: keys of `[device.override]` or, in quotes, of a table of the scenario
        variables: BTreeMap<String, VariableKeys> = "variables";
        /// what varies from part to part and is not the designer's to choose, drawn at the chosen design
        robustness: Option<RobustnessKeys> = "robustness";
    }

    /// `[study]`: the study, its scenarios and its search.
    pub(super) struct StudyKeys {
        /// name for people
        title: String = "title", being "not empty";
        /// scenario files, of benches or cells, from the study's folder
        scenarios: Vec<PathBuf> = "scenarios", being "at least one";
        /// seed of the search
        seed: u64 = "seed", or 1;
        /// most designs that are simulated, at least 50 for each variable
        evaluations: usize = "evaluations" in 50..=1_000_000, or 2000;
    }

    /// `[objective]`: what is minimised.
    pub(super) struct ObjectiveKeys {
        /// metric of docs/METRICS.md
        minimise: String = "minimise", or "coefficient_of_variation_percent";
        /// reduction of the scenarios to one number of it
        minimise_over: OverKeys = "minimise_over", or "mean";
        /// second objective, for the front: a metric, or one of the variables
        trade_off: Option<String> = "trade_off";
        /// reduction of the scenarios to one number of it; not of a variable
        trade_off_over: OverKeys = "trade_off_over", or "mean";
        /// levels of the second objective at which the front is sought
        front_points: usize = "front_points" in 3..=50, or 8;
    }

    /// A quantity in `[limits]`: one side, or both.
    pub(super) struct BoundKeys {
        /// the least that is allowed, in the unit of its name
        min: Option<f64> = "min";
        /// the most that is allowed, in the unit of its name
        max: Option<f64> = "max";
    }

    /// A variable in `[variables]`: a range, or a catalogue.
    pub(super) struct VariableKeys {
        /// the least that is tried, in the key's unit
        min: Option<f64> = "min";
        /// the most that is tried, in the key's unit
        max: Option<f64> = "max";
        /// its value in the design that all is compared with
        start: f64 = "start";
        /// scale of its steps
        scale: Option<ScaleKeys> = "scale", shown "\"linear\"";
        /// values that there are; for `bore_mm` the standard bores unless given
        catalogue: Option<Vec<f64>> = "catalogue";
        /// rod that goes with each bore of the catalogue
        rods: Option<Vec<f64>> = "rod_mm";
    }

    /// `[robustness]`: draws at the chosen design.
    pub(super) struct RobustnessKeys {
        /// draws, each of them simulated in every scenario
        runs: usize = "runs" in 10..=100_000, or 40;
        /// seed of the draws
        seed: u64 = "seed", or 1;
        /// what is drawn: keys of `[device.override]` or, in quotes, of any table of the scenario
        variables: BTreeMap<String, ScatterKeys> = "variables";
    }

    /// A table of `[robustness.variables]`: evenly from `min` to `max`, or normally distributed, then between `min` and `max` where they are given.
    pub(super) struct ScatterKeys {
        /// the least that is drawn, in the key's unit
        min: Option<f64> = "min";
        /// the most that is drawn, in the key's unit
        max: Option<f64> = "max";
        /// mean of a normal distribution, in the key's unit
        mean: Option<f64> = "mean";
        /// its standard deviation, in the key's unit
        standard_deviation: Option<f64> = "standard_deviation";
        /// whether it is a whole number, as a seed is
        whole: bool = "whole", or false;
    }
}

/// Reduction of the scenarios to one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum OverKeys {
    /// Their mean.
    Mean,
    /// The largest.
    Worst,
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
    of_file::<StudyFile>("A design study of idc")
}
