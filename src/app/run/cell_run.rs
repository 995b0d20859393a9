//! A run of a cell, watched part by part while it goes on, and its summary.json.

use std::time::Instant;

use super::super::error::AppError;
use super::super::picture::{motion_of, scene_of};
use super::super::viewer::{PART_INTERVAL, Watch};
use super::source::Source;
use crate::cell::{Cell, EstimatedArm};
use crate::metrics::{BoundCheck, Summary, Timing};
use crate::recording::provenance::Provenance;
use crate::recording::{Recording, RecordingError};
use crate::run::{FinishedCell, run_cell};
use crate::scenario::{AssumedValue, ChamferScenario};
use crate::scene::Scene;
use crate::simulation::{FrameLog, SampleLog};

/// Simulates the whole job, and gives what is recorded to listeners while it goes on.
pub(super) fn run_observed(
    cell: &Cell,
    progress: &mut dyn FnMut(usize, usize),
    mut listeners: Vec<Listener<'_>>,
) -> Result<FinishedCell, AppError> {
    let start = Instant::now();
    let mut failed = None;
    let finished = run_cell(cell, &mut |simulation| {
        progress(simulation.steps(), simulation.total_steps());
        for listener in &mut listeners {
            let due = simulation.done() || simulation.steps().is_multiple_of(listener.part);
            if failed.is_none() && due {
                failed = listener.hand_over(simulation.logs()).err();
            }
        }
    });
    match failed {
        Some(error) => Err(error),
        None => {
            let mut finished = finished?;
            finished.summary.timing = Some(Timing::since(start, finished.summary.duration_s));
            Ok(finished)
        }
    }
}

/// Tolerance of the edge; a leg without upper bound has none.
fn chamfer(cell: &Cell) -> serde_json::Value {
    let ChamferScenario {
        leg: [least, most],
        residual_burr,
    } = cell.setup.scenario.workpiece.chamfer;
    serde_json::json!({
        "leg_min_mm": 1e3 * least,
        "leg_max_mm": most.is_finite().then_some(1e3 * most),
        "residual_burr_max_mm": 1e3 * residual_burr,
    })
}

/// Samples and frames of a run that have come since the last part.
pub(in super::super) struct RunPart {
    samples: SampleLog,
    frames: FrameLog,
    first: bool,
}

impl RunPart {
    /// Signals shown of it: of the first part the cell as well, of others what moves.
    pub(in super::super) fn shown(self, cell: &Cell) -> Result<(Recording, Scene), RecordingError> {
        let samples = self.samples.into_recording()?;
        let scene = if self.first {
            scene_of(cell, &samples, &self.frames)?
        } else {
            motion_of(cell, &self.frames)
        };
        Ok((samples, scene))
    }
}

/// Who is given a run part by part while it goes on.
pub(in super::super) struct Listener<'a> {
    /// Steps a part.
    part: usize,
    observe: Box<dyn FnMut(RunPart) -> Result<(), AppError> + 'a>,
    /// Samples and frames that were handed over already.
    samples: usize,
    frames: usize,
}

impl<'a> Listener<'a> {
    /// One that is given parts of so many steps.
    pub(in super::super) fn new(
        part: usize,
        observe: impl FnMut(RunPart) -> Result<(), AppError> + 'a,
    ) -> Self {
        Self {
            part: part.max(1),
            observe: Box::new(observe),
            samples: 0,
            frames: 0,
        }
    }

    /// One that shows the run in a viewer.
    pub(super) fn watching(cell: &'a Cell, watch: &'a Watch) -> Self {
        let part = (PART_INTERVAL / cell.setup.scenario.simulation.step).round() as usize;
        Self::new(part, move |part| {
            let (samples, scene) = part.shown(cell)?;
            watch.add(samples, scene);
            Ok(())
        })
    }

    fn hand_over(&mut self, (samples, frames): (&SampleLog, &FrameLog)) -> Result<(), AppError> {
        if samples.count() == self.samples {
            return Ok(());
        }
        let part = RunPart {
            samples: samples.since(self.samples),
            frames: frames.since(self.frames),
            first: self.samples == 0,
        };
        self.samples = samples.count();
        self.frames = frames.times.len();
        (self.observe)(part)
    }
}

/// Content of summary.json, which `--json` prints.
#[derive(serde::Serialize)]
pub(super) struct SummaryDocument<'a> {
    schema: u32,
    scenario: &'a str,
    title: &'a str,
    /// Keys that have other values than in the scenario's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    set: Option<serde_json::Value>,
    /// What the edge should be like, where a tool turns.
    #[serde(skip_serializing_if = "Option::is_none")]
    chamfer: Option<serde_json::Value>,
    /// Reason for an early stop of the run; null if it ran to its end.
    stopped: Option<String>,
    summary: &'a Summary,
    expectations: &'a [BoundCheck],
    joint_names: Vec<&'a str>,
    samples: usize,
    notes: &'a [String],
    /// Masses of the arm that are estimated, and what that leaves open.
    #[serde(skip_serializing_if = "Option::is_none")]
    estimated_masses: Option<&'a EstimatedArm>,
    /// Values in use that nobody has measured in public.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[serde(rename = "judged")]
    assumed: Vec<&'a AssumedValue>,
    provenance: &'a Provenance,
}

impl<'a> SummaryDocument<'a> {
    /// The document of a run.
    pub(super) fn new(
        cell: &'a Cell,
        finished: &'a FinishedCell,
        expectations: &'a [BoundCheck],
        source: &'a Source,
        origin: &'a Provenance,
    ) -> Self {
        Self {
            schema: 1,
            scenario: &source.name,
            title: &cell.setup.scenario.title,
            set: source.set(),
            chamfer: finished.edge.as_ref().map(|_| chamfer(cell)),
            stopped: finished.stop.as_ref().map(ToString::to_string),
            summary: &finished.summary,
            expectations,
            joint_names: cell
                .setup
                .arm
                .chain
                .joints
                .iter()
                .map(|joint| joint.name.as_str())
                .collect(),
            samples: finished.recording.sample_count(),
            notes: &cell.setup.notes,
            estimated_masses: cell.estimated.as_ref(),
            assumed: cell.setup.scenario.assumed_values().collect(),
            provenance: origin,
        }
    }

    /// As JSON.
    pub(super) fn text(&self) -> Result<String, AppError> {
        Ok(serde_json::to_string_pretty(self)?)
    }
}
