//! A bench's whole job: simulated and measured.

use super::error::RunError;
use crate::metrics::{BenchLimits, BenchSummary, summarise_bench};
use crate::recording::Recording;
use crate::rig::{Rig, RigError, RigSimulation};
use crate::scenario::BenchScenario;
use crate::scenario::bench::LoadScenario;

/// A run of a bench that has ended.
pub struct FinishedBench {
    /// The recording.
    pub recording: Recording,
    /// Its numbers.
    pub summary: BenchSummary,
    /// Reason for an early stop.
    pub stop: Option<RigError>,
}

/// Simulates and measures the whole job; `observer` is given the simulation after every step.
///
/// # Errors
/// Nothing could be recorded or measured.
pub fn run_bench(
    rig: &Rig,
    observer: &mut dyn FnMut(&RigSimulation<'_>),
) -> Result<FinishedBench, RunError> {
    let (recording, stop) = rig.run(observer)?;
    finish_bench(rig, recording, stop)
}

/// Measures what was simulated of a bench.
///
/// # Errors
/// It could not be measured.
pub fn finish_bench(
    rig: &Rig,
    recording: Recording,
    stop: Option<RigError>,
) -> Result<FinishedBench, RunError> {
    let summary = summarise_bench(&recording, &limits(&rig.scenario))
        .map_err(RunError::metrics(&rig.scenario.path))?;
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
        stroke_limits: (0.0, scenario.nominal.device.full_stroke),
        atmosphere: scenario.nominal.device.gas.atmosphere,
    }
}
