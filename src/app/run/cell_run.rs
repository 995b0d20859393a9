//! A run of a cell, watched part by part while it goes on.

use std::time::Instant;

use super::super::error::AppError;
use super::super::picture::{motion_of, scene_of};
use super::super::viewer::{PART_INTERVAL, Watch};
use crate::cell::Cell;
use crate::metrics::Timing;
use crate::recording::{Recording, RecordingError};
use crate::run::{FinishedCell, run_cell};
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
