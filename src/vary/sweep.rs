//! A sweep: a scenario, and the values of its keys by run.

use super::Points;
use crate::scenario::{AnyScenario, KeyValue, ScenarioError, ScenarioTemplate};

/// Many runs of a scenario.
pub struct Sweep {
    /// The scenario.
    pub template: ScenarioTemplate,
    /// Keys with one value for all runs.
    pub fixed: Vec<KeyValue>,
    /// Values of the others, by run.
    pub points: Points,
}

impl Sweep {
    /// Whether the runs are held to bounds, with the values of the first.
    pub fn is_bounded(&self) -> bool {
        let first = self.template.with(&self.edits(&self.points.at(0)));
        match first.or_else(|_| self.with(&[])) {
            Ok(AnyScenario::Cell(cell)) => !cell.expect.is_empty(),
            Ok(AnyScenario::Bench(bench)) => !bench.expect.is_empty(),
            Err(_) => false,
        }
    }

    /// The scenario with changes beside the fixed ones.
    ///
    /// # Errors
    /// Those of the scenario with them.
    pub fn with(&self, edits: &[KeyValue]) -> Result<AnyScenario, ScenarioError> {
        let all: Vec<KeyValue> = self.fixed.iter().chain(edits).cloned().collect();
        self.template.with(&all)
    }

    /// All changes of a run with these values.
    pub fn edits(&self, values: &[String]) -> Vec<KeyValue> {
        let own = self.points.variables().iter().zip(values);
        let own = own.map(|(variable, value)| KeyValue::typed(&variable.key, value));
        self.fixed.iter().cloned().chain(own).collect()
    }
}
