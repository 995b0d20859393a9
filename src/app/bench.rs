//! `idc run` of a bench scenario: from a rig to its recording and numbers.

use std::time::Instant;

use serde::Serialize;

use super::bench_picture::scene_of;
use super::error::AppError;
use super::run::Source;
use super::viewer::{PART_INTERVAL, Watch};
use crate::metrics::{BenchLimits, BenchSummary, BoundCheck, Timing, summarise_bench};
use crate::recording::Recording;
use crate::recording::provenance::Provenance;
use crate::rig::{Rig, RigError};
use crate::scenario::bench::LoadScenario;
use crate::scenario::{BenchScenario, JudgedValue};

/// A bench run that has ended.
pub struct FinishedBench {
    /// The recording.
    pub recording: Recording,
    /// Its numbers.
    pub summary: BenchSummary,
    /// Reason for an early stop.
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
    run_watched(rig, progress, None)
}

/// Runs a rig's whole job, and hands what is recorded over to who watches it.
pub(super) fn run_watched(
    rig: &Rig,
    progress: &mut dyn FnMut(usize, usize),
    watch: Option<&Watch>,
) -> Result<FinishedBench, AppError> {
    const PROGRESS_STEPS: usize = 500;
    let start = Instant::now();
    let length = (PART_INTERVAL / rig.scenario.step).round().max(1.0) as usize;
    let mut handed_over = 0;
    let (recording, stop) = rig.run(&mut |simulation| {
        if simulation.steps().is_multiple_of(PROGRESS_STEPS) {
            progress(simulation.steps(), simulation.total_steps());
        }
        if let Some(watch) = watch
            && (simulation.done() || simulation.steps().is_multiple_of(length))
            && let Ok(part) = simulation.since(handed_over)
            && let Ok(scene) = scene_of(&rig.scenario, &part)
        {
            handed_over = simulation.sample_count();
            watch.add(part, scene);
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
    let motion = match scenario.load {
        LoadScenario::Contact { motion, .. } => motion.map(|motion| motion.start),
        LoadScenario::Free => None,
    };
    let hand = scenario.hand.map(|hand| hand.start);
    let disturbed_from = motion.into_iter().chain(hand).reduce(f64::min);
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
        disturbed_from,
        moving,
        stroke_limits: (0.0, scenario.device.parameters.full_stroke),
        atmosphere: scenario.device.parameters.gas.atmosphere,
    }
}

/// summary.json of a bench run.
pub(super) fn document(
    scenario: &BenchScenario,
    finished: &FinishedBench,
    expectations: &[BoundCheck],
    source: &Source,
    origin: &Provenance,
) -> Result<String, AppError> {
    #[derive(Serialize)]
    struct Document<'a> {
        schema: u32,
        kind: &'static str,
        scenario: &'a str,
        title: &'a str,
        /// Keys that have other values than in the scenario's file.
        #[serde(skip_serializing_if = "Option::is_none")]
        set: Option<serde_json::Value>,
        /// Reason for an early stop of the run; null if it ran to its end.
        stopped: Option<String>,
        summary: &'a BenchSummary,
        expectations: &'a [BoundCheck],
        samples: usize,
        /// Values in use that nobody has measured in public.
        #[serde(skip_serializing_if = "<[_]>::is_empty")]
        judged: &'a [JudgedValue],
        provenance: &'a Provenance,
    }
    Ok(serde_json::to_string_pretty(&Document {
        schema: 1,
        kind: "bench",
        scenario: &source.name,
        title: &scenario.title,
        set: source.set(),
        stopped: finished.stop.as_ref().map(ToString::to_string),
        summary: &finished.summary,
        expectations,
        samples: finished.recording.sample_count(),
        judged: &scenario.device.judged,
        provenance: origin,
    })?)
}
