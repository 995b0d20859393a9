//! The result of a run: summary.json.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::bench::FinishedBench;
use super::cell::FinishedCell;
use crate::cell::{Cell, EstimatedArm};
use crate::metrics::{BenchSummary, BoundCheck, Label, Measured, Metric, Summary, labels};
use crate::recording::provenance::Provenance;
use crate::rig::Rig;
use crate::scenario::{AssumedValue, ChamferScenario};

/// The result of a run, as summary.json has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Version of the file's keys.
    pub schema: u32,
    /// Kind of the scenario; that of a cell is not written.
    #[serde(default, skip_serializing_if = "RunKind::is_cell")]
    pub kind: RunKind,
    /// The scenario's file.
    pub scenario: String,
    /// Its title.
    pub title: String,
    /// Keys that have other values than in that file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub set: Option<Value>,
    /// Limits of the finished edge, where a tool turned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamfer: Option<ChamferLimits>,
    /// Reason for an early stop; none if it ran to its end.
    #[serde(default)]
    pub stopped: Option<String>,
    /// Its numbers.
    pub summary: RunSummary,
    /// Bounds that the scenario sets on them.
    #[serde(default)]
    pub expectations: Vec<BoundCheck>,
    /// Joints of the arm, base first; none of a bench.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joint_names: Vec<String>,
    /// Samples of its recording.
    #[serde(default)]
    pub samples: usize,
    /// Steps for one in which the arm's mass matrix was taken anew, on average; none of a bench.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps_per_mass_matrix: Option<f64>,
    /// Notes on what was simulated.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Masses of the arm that are estimated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimated_masses: Option<EstimatedArm>,
    /// Values in use that nobody has measured in public.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[serde(rename = "judged")]
    pub assumed: Vec<AssumedValue>,
    /// Its origin.
    #[serde(default)]
    pub provenance: Provenance,
}

/// Kind of a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunKind {
    /// A cell: an arm that follows an edge.
    #[default]
    Cell,
    /// A bench: the device alone.
    Bench,
}

impl RunKind {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde asks")]
    fn is_cell(&self) -> bool {
        *self == Self::Cell
    }
}

/// Numbers of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum RunSummary {
    /// Of a cell.
    Cell(Box<Summary>),
    /// Of a bench.
    Bench(Box<BenchSummary>),
}

/// Limits of a finished edge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChamferLimits {
    /// Least leg of the chamfer [mm].
    pub leg_min_mm: f64,
    /// Largest leg [mm]; none where there is no limit.
    pub leg_max_mm: Option<f64>,
    /// Height of the burr that may be left [mm].
    pub residual_burr_max_mm: f64,
}

/// Scenario of a run as its result names it.
#[derive(Debug, Clone, Default)]
pub struct RunOrigin {
    /// Its file.
    pub scenario: String,
    /// Keys that have other values than in that file.
    pub set: Option<Value>,
    /// Files and programs.
    pub provenance: Provenance,
}

impl RunResult {
    /// That of a cell.
    #[must_use]
    pub fn of_cell(
        cell: &Cell,
        finished: &FinishedCell,
        expectations: Vec<BoundCheck>,
        origin: RunOrigin,
    ) -> Self {
        let setup = &cell.setup;
        let joints = setup.arm.chain.joints.iter();
        Self {
            schema: 1,
            kind: RunKind::Cell,
            scenario: origin.scenario,
            title: setup.scenario.title.clone(),
            set: origin.set,
            chamfer: (finished.edge.as_ref())
                .map(|_| ChamferLimits::of(&setup.scenario.workpiece.chamfer)),
            stopped: finished.stop.as_ref().map(ToString::to_string),
            summary: RunSummary::Cell(Box::new(finished.summary.clone())),
            expectations,
            joint_names: joints.map(|joint| joint.name.clone()).collect(),
            samples: finished.recording.sample_count(),
            steps_per_mass_matrix: Some(finished.steps_per_mass_matrix),
            notes: setup.notes.clone(),
            estimated_masses: cell.estimated.clone(),
            assumed: setup.scenario.assumed_values().cloned().collect(),
            provenance: origin.provenance,
        }
    }

    /// That of a bench.
    #[must_use]
    pub fn of_bench(
        rig: &Rig,
        finished: &FinishedBench,
        expectations: Vec<BoundCheck>,
        origin: RunOrigin,
    ) -> Self {
        Self {
            schema: 1,
            kind: RunKind::Bench,
            scenario: origin.scenario,
            title: rig.scenario.title.clone(),
            set: origin.set,
            chamfer: None,
            stopped: finished.stop.as_ref().map(ToString::to_string),
            summary: RunSummary::Bench(Box::new(finished.summary.clone())),
            expectations,
            joint_names: Vec::new(),
            samples: finished.recording.sample_count(),
            steps_per_mass_matrix: None,
            notes: Vec::new(),
            estimated_masses: None,
            assumed: rig.scenario.device.assumed.clone(),
            provenance: origin.provenance,
        }
    }

    /// Whether it is of a bench.
    #[must_use]
    pub fn is_bench(&self) -> bool {
        self.kind == RunKind::Bench
    }

    /// Its numbers for people, in the order of the file; without those that only some runs have, and without the time that it took.
    #[must_use]
    pub fn metrics(&self) -> Vec<(Label, Option<f64>)> {
        fn of<S: Measured>(summary: &S) -> Vec<(bool, Option<f64>)> {
            let shown = |metric: &Metric<S>| {
                let value = (metric.value)(summary);
                (value.is_some() || !metric.is_optional, value)
            };
            S::METRICS.iter().map(shown).collect()
        }
        let values = match &self.untimed() {
            RunSummary::Cell(summary) => of(summary.as_ref()),
            RunSummary::Bench(summary) => of(summary.as_ref()),
        };
        let all = labels(self.is_bench()).into_iter().zip(values);
        let all = all.filter(|(_, (is_shown, _))| *is_shown);
        all.map(|(label, (_, value))| (label, value)).collect()
    }

    /// Its numbers without the time that it took, which differs from run to run.
    #[must_use]
    pub fn untimed(&self) -> RunSummary {
        let mut summary = self.summary.clone();
        match &mut summary {
            RunSummary::Cell(summary) => summary.timing = None,
            RunSummary::Bench(summary) => summary.timing = None,
        }
        summary
    }

    /// A number by its key; none where the run does not determine it.
    #[must_use]
    pub fn metric(&self, key: &str) -> Option<f64> {
        let mut all = self.metrics().into_iter();
        all.find(|(label, _)| label.key == key)
            .and_then(|(_, value)| value)
    }

    /// Reason for an early stop, or else each result that lies outside its bounds, a sentence each.
    #[must_use]
    pub fn complaints(&self) -> Vec<String> {
        match &self.stopped {
            Some(reason) => vec![format!("stopped: {reason}")],
            None => outside(&self.expectations),
        }
    }

    /// Whether all its bounds are kept.
    #[must_use]
    pub fn is_within_bounds(&self) -> bool {
        self.expectations.iter().all(|bound| bound.kept)
    }
}

/// Results that lie outside their bounds, a sentence each.
#[must_use]
pub fn outside(bounds: &[BoundCheck]) -> Vec<String> {
    let outside = bounds.iter().filter(|bound| !bound.kept);
    let sentence = |bound: &BoundCheck| {
        let value = bound
            .value
            .map_or("not determined by this run".to_owned(), |value| {
                format!("{value:.6}")
            });
        let (name, ends) = (bound.name(), bound.ends());
        format!("outside its bounds: {name} is {value}, expected {ends}")
    };
    outside.map(sentence).collect()
}

impl ChamferLimits {
    fn of(chamfer: &ChamferScenario) -> Self {
        let [least, most] = chamfer.leg;
        Self {
            leg_min_mm: 1e3 * least,
            leg_max_mm: most.is_finite().then_some(1e3 * most),
            residual_burr_max_mm: 1e3 * chamfer.residual_burr,
        }
    }
}
