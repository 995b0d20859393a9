//! `idc run`: from a cell to its recording and numbers.

use std::time::Instant;

use super::error::AppError;
use crate::cell::Cell;
use crate::metrics::{Summary, SummaryLimits, Timing, summarise};
use crate::recording::Recording;
use crate::simulation::{FrameLog, Simulation, SimulationError};

/// Steps between two looks at the progress bar.
const PROGRESS_STEPS: usize = 500;

/// A run that has ended.
pub struct Finished {
    /// What was recorded.
    pub recording: Recording,
    /// Poses for the picture.
    pub frames: FrameLog,
    /// Its numbers.
    pub summary: Summary,
    /// What stopped it early.
    pub stop: Option<SimulationError>,
}

/// Simulates the whole job. `progress` is told steps done and in all.
///
/// # Errors
/// Nothing could be recorded or measured.
pub fn run_cell(cell: &Cell, progress: &mut dyn FnMut(usize, usize)) -> Result<Finished, AppError> {
    let start = Instant::now();
    let mut simulation = Simulation::new(cell);
    let mut stop = None;
    while !simulation.done() && stop.is_none() {
        stop = simulation.step().err();
        if simulation.steps().is_multiple_of(PROGRESS_STEPS) {
            progress(simulation.steps(), simulation.total_steps());
        }
    }
    let wall = start.elapsed().as_secs_f64();
    let (samples, frames) = simulation.into_logs();
    let recording = samples.into_recording()?;
    let mut summary = summarise(&recording, &limits(cell)).map_err(|source| AppError::Metrics {
        file: cell.scenario.path.display().to_string(),
        source,
    })?;
    summary.timing = Some(Timing::new(summary.duration_s, wall));
    Ok(Finished {
        recording,
        frames,
        summary,
        stop,
    })
}

fn limits(cell: &Cell) -> SummaryLimits {
    let joints = &cell.arm.chain.joints;
    SummaryLimits {
        desired_force: cell.scenario.process.force,
        stroke_limits: (0.0, cell.scenario.device.parameters.full_stroke),
        joint_efforts: joints.iter().map(|joint| joint.effort).collect(),
        joint_names: joints.iter().map(|joint| joint.name.clone()).collect(),
    }
}
