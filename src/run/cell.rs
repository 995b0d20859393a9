//! A cell's whole job: simulated and measured.

use super::arm_sensors::with_arm_sensors;
use super::error::RunError;
use crate::cell::Cell;
use crate::metrics::{EdgeLimits, Summary, SummaryLimits, summarise, summarise_edge};
use crate::recording::Recording;
use crate::recording::csv::EdgeProfile;
use crate::scenario::ChamferScenario;
use crate::simulation::{CellRun, FrameLog, Simulation, SimulationError};

/// A run of a cell that has ended.
pub struct FinishedCell {
    /// The recording.
    pub recording: Recording,
    /// Poses for the picture.
    pub frames: FrameLog,
    /// Its numbers.
    pub summary: Summary,
    /// Reason for an early stop.
    pub stop: Option<SimulationError>,
    /// The edge as a turning tool left it.
    pub edge: Option<EdgeProfile>,
    /// Steps for one in which the arm's mass matrix was taken anew, on average [1].
    pub steps_per_mass_matrix: f64,
}

/// Simulates and measures the whole job; `observer` is given the simulation after every step.
///
/// # Errors
/// Nothing could be recorded or measured.
pub fn run_cell(
    cell: &Cell,
    observer: &mut dyn FnMut(&Simulation<'_>),
) -> Result<FinishedCell, RunError> {
    finish_cell(cell, cell.run(observer)?)
}

/// Measures what was simulated of a cell.
///
/// # Errors
/// It could not be measured.
pub fn finish_cell(cell: &Cell, run: CellRun) -> Result<FinishedCell, RunError> {
    let CellRun {
        recording,
        frames,
        contact_points,
        stop,
        edge,
        steps_per_mass_matrix,
    } = run;
    let recording = with_arm_sensors(cell, recording, &contact_points)?;
    let mut summary = summarise(&recording, &limits(cell))
        .map_err(RunError::metrics(&cell.setup.scenario.path))?;
    if let Some(edge) = &edge {
        summarise_edge(&mut summary, edge, &edge_limits(cell));
    }
    Ok(FinishedCell {
        recording,
        frames,
        summary,
        stop,
        edge,
        steps_per_mass_matrix,
    })
}

/// What its edge is measured against.
fn edge_limits(cell: &Cell) -> EdgeLimits {
    let ChamferScenario { leg, residual_burr } = cell.setup.scenario.workpiece.chamfer;
    EdgeLimits {
        leg,
        residual_burr,
        ends: (cell.setup.scenario.removal).map_or(0.0, |removal| removal.contact_length),
    }
}

fn limits(cell: &Cell) -> SummaryLimits {
    let joints = &cell.setup.arm.chain.joints;
    SummaryLimits {
        desired_force: cell.setup.passes[0].force,
        later_forces: cell.setup.passes[1..]
            .iter()
            .map(|pass| pass.force)
            .collect(),
        stroke_limits: (0.0, cell.setup.scenario.nominal.device.full_stroke),
        joint_efforts: joints.iter().map(|joint| joint.effort).collect(),
        joint_names: joints.iter().map(|joint| joint.name.clone()).collect(),
    }
}
