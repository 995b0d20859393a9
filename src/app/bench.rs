//! `idc run` of a bench scenario: from a rig to its recording and numbers.

use std::time::Instant;

use serde::Serialize;

use super::bench_picture::scene_of;
use super::error::AppError;
use super::run::Source;
use super::viewer::{PART_INTERVAL, Watch};
use crate::metrics::{BenchSummary, BoundCheck, Timing};
use crate::recording::provenance::Provenance;
use crate::rig::Rig;
use crate::run::{FinishedBench, run_bench};
use crate::scenario::{AssumedValue, BenchScenario};

/// Runs a rig's whole job, and hands what is recorded over to who watches it.
pub(super) fn run_watched(
    rig: &Rig,
    progress: &mut dyn FnMut(usize, usize),
    watch: Option<&Watch>,
) -> Result<FinishedBench, AppError> {
    let length = (PART_INTERVAL / rig.scenario.step).round().max(1.0) as usize;
    let mut handed_over = 0;
    let start = Instant::now();
    let mut finished = run_bench(rig, &mut |simulation| {
        progress(simulation.steps(), simulation.total_steps());
        if let Some(watch) = watch
            && (simulation.done() || simulation.steps().is_multiple_of(length))
            && let Ok(part) = simulation.since(handed_over)
            && let Ok(scene) = scene_of(&rig.scenario, &part)
        {
            handed_over = simulation.sample_count();
            watch.add(part, scene);
        }
    })?;
    finished.summary.timing = Some(Timing::since(start, finished.summary.duration_s));
    Ok(finished)
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
        #[serde(rename = "judged")]
        assumed: &'a [AssumedValue],
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
        assumed: &scenario.device.assumed,
        provenance: origin,
    })?)
}
