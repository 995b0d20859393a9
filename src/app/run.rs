//! `idc run`: from a cell to its recording, numbers and files.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use super::error::AppError;
use super::picture::scene_of;
use crate::cell::Cell;
use crate::metrics::Verdict;
use crate::metrics::{Summary, SummaryLimits, Timing, summarise};
use crate::recording::atomic::write_text;
use crate::recording::parquet::write_parquet;
use crate::recording::rerun::{RerunOptions, write_rrd};
use crate::recording::{Recording, schema};
use crate::report::markdown;
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
        if simulation.steps() % PROGRESS_STEPS == 0 {
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
    Ok(Finished { recording, frames, summary, stop })
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

/// Writes recording.rrd, samples.parquet and summary.json, each beside its name and renamed.
pub(super) fn write_outputs(
    folder: &Path,
    cell: &Cell,
    finished: &Finished,
    verdicts: &[Verdict],
) -> Result<(), AppError> {
    std::fs::create_dir_all(folder).map_err(|source| AppError::OutputFolder {
        folder: folder.display().to_string(),
        source,
    })?;
    let mut metadata = BTreeMap::new();
    metadata.insert("title".to_owned(), cell.scenario.title.clone());
    metadata.insert("program".to_owned(), format!("idc {}", env!("CARGO_PKG_VERSION")));
    write_parquet(&folder.join("samples.parquet"), &finished.recording, &metadata)?;
    let options = RerunOptions {
        summary_markdown: markdown(&cell.scenario.title, &finished.summary, verdicts),
        ..RerunOptions::default()
    };
    let scene = scene_of(cell, &finished.recording, &finished.frames)?;
    write_rrd(&folder.join("recording.rrd"), &finished.recording, &scene, &options)?;
    let file = SummaryFile {
        schema: 1,
        scenario: cell.scenario.path.display().to_string(),
        title: &cell.scenario.title,
        stopped: finished.stop.as_ref().map(ToString::to_string),
        summary: &finished.summary,
        expectations: verdicts,
        joint_names: cell.arm.chain.joints.iter().map(|joint| joint.name.as_str()).collect(),
        samples: finished.recording.values(schema::CONTACT_FORCE)?.len(),
        notes: &cell.notes,
    };
    write_text(&folder.join("summary.json"), &serde_json::to_string_pretty(&file)?)?;
    Ok(())
}

/// summary.json.
#[derive(serde::Serialize)]
struct SummaryFile<'a> {
    schema: u32,
    scenario: String,
    title: &'a str,
    /// What stopped the run early; null if it ran to its end.
    stopped: Option<String>,
    summary: &'a Summary,
    expectations: &'a [Verdict],
    joint_names: Vec<&'a str>,
    samples: usize,
    notes: &'a [String],
}
