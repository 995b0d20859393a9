//! `idc run` of a bench scenario: from a rig to its recording and numbers.

use std::time::Instant;

use serde::Serialize;

use super::error::AppError;
use super::files::provenance;
use crate::metrics::{BenchLimits, BenchSummary, Timing, Verdict, summarise_bench};
use crate::recording::Recording;
use crate::recording::provenance::Provenance;
use crate::rig::{Rig, RigError};
use crate::scenario::BenchScenario;
use crate::scenario::bench::LoadScenario;

/// A bench run that has ended.
pub struct FinishedBench {
    /// What was recorded.
    pub recording: Recording,
    /// Its numbers.
    pub summary: BenchSummary,
    /// What stopped it early.
    pub stop: Option<RigError>,
}

/// Runs a rig's whole job. `progress` is told steps done and in all.
///
/// # Errors
/// Nothing could be recorded or measured.
pub fn run_rig(
    rig: &Rig,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<FinishedBench, AppError> {
    const PROGRESS_STEPS: usize = 500;
    let start = Instant::now();
    let (recording, stop) = rig.run(&mut |done, total| {
        if done.is_multiple_of(PROGRESS_STEPS) {
            progress(done, total);
        }
    })?;
    let wall = start.elapsed().as_secs_f64();
    let mut summary = summarise_bench(&recording, &limits(&rig.scenario)).map_err(|source| {
        AppError::Metrics {
            file: rig.scenario.path.display().to_string(),
            source,
        }
    })?;
    summary.timing = Some(Timing::new(summary.duration_s, wall));
    Ok(FinishedBench {
        recording,
        summary,
        stop,
    })
}

fn limits(scenario: &BenchScenario) -> BenchLimits {
    let steps = scenario.command.steps();
    // The first period brings the rig into its swing.
    let moving = match scenario.load {
        LoadScenario::Contact {
            motion: Some(motion),
            ..
        } => Some((motion.start + 1.0 / motion.frequency, scenario.duration)),
        _ => None,
    };
    BenchLimits {
        command_times: steps.iter().map(|(time, _)| *time).collect(),
        moving,
        stroke_limits: (0.0, scenario.device.parameters.full_stroke),
        atmosphere: scenario.device.parameters.gas.atmosphere,
    }
}

/// summary.json of a bench run.
pub(super) fn document(
    scenario: &BenchScenario,
    finished: &FinishedBench,
    expectations: &[Verdict],
) -> Result<String, AppError> {
    #[derive(Serialize)]
    struct Document<'a> {
        schema: u32,
        kind: &'static str,
        scenario: String,
        title: &'a str,
        /// What stopped the run early; null if it ran to its end.
        stopped: Option<String>,
        summary: &'a BenchSummary,
        expectations: &'a [Verdict],
        samples: usize,
        provenance: Provenance,
    }
    Ok(serde_json::to_string_pretty(&Document {
        schema: 1,
        kind: "bench",
        scenario: scenario.path.display().to_string(),
        title: &scenario.title,
        stopped: finished.stop.as_ref().map(ToString::to_string),
        summary: &finished.summary,
        expectations,
        samples: finished.recording.sample_count(),
        provenance: provenance(&[&scenario.path, &scenario.device.model], scenario.seed)?,
    })?)
}
