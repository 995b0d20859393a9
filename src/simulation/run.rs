//! A whole job of a cell, from its first step to its last.

use super::{FrameLog, Simulation, SimulationError};
use crate::cell::Cell;
use crate::recording::{Recording, RecordingError};

/// A run that has ended.
pub struct CellRun {
    /// Signals, one sample a step.
    pub recording: Recording,
    /// Poses for the picture.
    pub frames: FrameLog,
    /// Reason why it ended early, if it did.
    pub stop: Option<SimulationError>,
}

impl Cell {
    /// Simulates the whole job; `observer` is shown the simulation after every step.
    ///
    /// # Errors
    /// Nothing could be recorded.
    pub fn run(
        &self,
        observer: &mut dyn FnMut(&Simulation<'_>),
    ) -> Result<CellRun, RecordingError> {
        let mut simulation = Simulation::new(self);
        let mut stop = None;
        while !simulation.done() {
            stop = simulation.step().err();
            observer(&simulation);
        }
        let (samples, frames) = simulation.into_logs();
        Ok(CellRun {
            recording: samples.into_recording()?,
            frames,
            stop,
        })
    }
}
