//! `idc run`: from a cell to its recording and numbers.

use std::time::Instant;

use super::error::AppError;
use super::picture::{motion_of, scene_of};
use super::viewer::{PART_INTERVAL, Watch};
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
    run_watched(cell, progress, None)
}

/// Simulates the whole job, and hands what is recorded over to who watches it.
pub(super) fn run_watched(
    cell: &Cell,
    progress: &mut dyn FnMut(usize, usize),
    watch: Option<&Watch>,
) -> Result<Finished, AppError> {
    let start = Instant::now();
    let mut simulation = Simulation::new(cell);
    let mut stop = None;
    let mut watched = watch.map(|watch| CellParts::new(cell, watch));
    while !simulation.done() && stop.is_none() {
        stop = simulation.step().err();
        if simulation.steps().is_multiple_of(PROGRESS_STEPS) {
            progress(simulation.steps(), simulation.total_steps());
        }
        if let Some(watched) = &mut watched
            && watched.is_due(&simulation)
        {
            watched.hand_over(&simulation)?;
        }
    }
    if let Some(watched) = &mut watched {
        watched.hand_over(&simulation)?;
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

/// What of a run has been handed over already.
struct CellParts<'a> {
    cell: &'a Cell,
    watch: &'a Watch,
    /// Samples a part.
    length: usize,
    samples: usize,
    frames: usize,
}

impl<'a> CellParts<'a> {
    fn new(cell: &'a Cell, watch: &'a Watch) -> Self {
        let length = (PART_INTERVAL / cell.scenario.simulation.step).round();
        Self {
            cell,
            watch,
            length: length.max(1.0) as usize,
            samples: 0,
            frames: 0,
        }
    }

    fn is_due(&self, simulation: &Simulation<'_>) -> bool {
        simulation.steps().is_multiple_of(self.length)
    }

    fn hand_over(&mut self, simulation: &Simulation<'_>) -> Result<(), AppError> {
        let (samples, frames) = simulation.logs();
        if samples.count() == self.samples {
            return Ok(());
        }
        let part = samples.since(self.samples)?;
        let new = frames.since(self.frames);
        let scene = if self.samples == 0 {
            scene_of(self.cell, &part, &new)?
        } else {
            motion_of(self.cell, &new)
        };
        self.samples = samples.count();
        self.frames = frames.times.len();
        self.watch.add(part, scene);
        Ok(())
    }
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
