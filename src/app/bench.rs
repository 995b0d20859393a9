//! `idc run` of a bench scenario: from a rig to its recording and numbers.

use std::time::Instant;

use super::bench_picture::scene_of;
use super::error::AppError;
use super::viewer::{PART_INTERVAL, Watch};
use crate::metrics::Timing;
use crate::rig::Rig;
use crate::run::{FinishedBench, run_bench};

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
