//! A whole job of a cell, from its first step to its last.

use glam::DVec3;

use super::{FrameLog, Simulation, SimulationError};
use crate::cell::Cell;
use crate::recording::csv::EdgeProfile;
use crate::recording::{Recording, RecordingError};
use crate::removal::{EdgeState, EdgeStationState};

/// A run that has ended.
pub struct CellRun {
    /// Signals, one sample a step.
    pub recording: Recording,
    /// Poses for the picture.
    pub frames: FrameLog,
    /// Where the tool touches, by sample [m]; empty where the cell names no arm file.
    pub contact_points: Vec<DVec3>,
    /// The edge as a turning tool left it.
    pub edge: Option<EdgeProfile>,
    /// Steps for one in which the arm's mass matrix was taken anew, on average [1].
    pub steps_per_mass_matrix: f64,
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
        CellRun::of(simulation, stop)
    }
}

impl CellRun {
    /// What a simulation gave, which has ended, or was stopped for this reason.
    ///
    /// # Errors
    /// Nothing could be recorded.
    pub fn of(
        mut simulation: Simulation<'_>,
        stop: Option<SimulationError>,
    ) -> Result<Self, RecordingError> {
        let steps_per_mass_matrix = simulation.steps_per_mass_matrix();
        let contact_points = simulation.take_contact_points();
        let (samples, frames, edge) = simulation.into_logs();
        Ok(Self {
            contact_points,
            steps_per_mass_matrix,
            edge: edge.as_ref().map(profile),
            recording: samples.into_recording()?,
            frames,
            stop,
        })
    }
}

/// The edge as a recording holds it.
fn profile(edge: &EdgeState) -> EdgeProfile {
    let stations = edge.stations();
    let of = |value: fn(&EdgeStationState) -> f64| stations.iter().map(value).collect();
    EdgeProfile {
        place: (0..stations.len()).map(|i| edge.place(i)).collect(),
        burr_before: of(|station| station.burr_before),
        burr_after: of(EdgeStationState::burr),
        chamfer_leg: of(EdgeStationState::leg),
        section_removed: of(|station| station.removed),
    }
}
