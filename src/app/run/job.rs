//! What the program writes of a job.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::super::edge_course::edge_course;
use super::super::error::{AppError, ExitCode};
use super::super::files::{
    BAG, DRAWING, EDGE, EDGE_PROFILE, FIGURES, LEAN, OutputFolder, Picture, RECORDING, RUN,
    RunOutput, sketches,
};
use super::super::picture::{across_the_edge, finished_edge, scene_of};
use super::super::streaming::StreamingRecording;
use super::super::viewer::Watch;
use super::super::{bench, bench_figures, bench_picture};
use super::cell_run::{Listener, run_observed};
use super::source::Source;
use crate::cell::Cell;
use crate::document::{Style, html, markdown, text};
use crate::recording::Recording;
use crate::recording::csv::EdgeProfile;
use crate::recording::provenance::Provenance;
use crate::recording::seal::sealed;
use crate::report::{RunReport, Sketches, drives};
use crate::rig::Rig;
use crate::run::{Finished, FinishedBench, FinishedCell, Job, RunOrigin, RunResult};
use crate::scenario::{BenchScenario, Scenario, files_of_cell};
use crate::scene::Scene;
use crate::scene::finished_edge::FinishedEdge;
use crate::viewer::{Opening, RerunOptions, write_rrd};

/// Settings of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct RunOptions {
    /// Whether recording.rrd is written.
    pub recorded: bool,
    /// Whether recording.mcap is.
    pub with_bag: bool,
    /// First view of recording.rrd.
    pub opening: Opening,
    /// Style of the tables.
    pub style: Style,
}

/// A run that has ended, its files written.
pub(super) struct RunOutcome {
    /// What was simulated.
    pub finished: Finished,
    /// Its numbers.
    pub result: RunResult,
    /// Content of summary.json.
    pub document: String,
    /// Its numbers for people.
    pub table: String,
    /// Names of the files.
    pub names: Vec<&'static str>,
    /// Message on standard error: what stopped it, or which results lie outside their bounds.
    pub messages: Vec<String>,
    /// Its exit code.
    pub code: ExitCode,
    /// Parts of a viewer's content that only the whole run gives: the scene, and the numbers.
    pub shown: (Scene, String),
}

impl Job {
    /// Whether a run of it writes the file of this name, of those that a run may write.
    pub(super) fn writes(&self, name: &str, options: RunOptions) -> bool {
        match name {
            RECORDING => options.recorded,
            BAG => options.with_bag,
            LEAN => matches!(self, Self::Cell(_)),
            FIGURES => matches!(self, Self::Bench(_)),
            // Of a run that followed one.
            EDGE | DRAWING | EDGE_PROFILE => false,
            _ => true,
        }
    }

    /// Where its results come from, and what they are made of, wherever its files stand.
    pub(super) fn provenance(&self, source: &Source) -> Result<(Provenance, String), AppError> {
        let (files, seed): (Vec<&PathBuf>, u64) = match self {
            Self::Cell(cell) => {
                let Scenario {
                    path,
                    arm,
                    device,
                    workpiece,
                    collision,
                    simulation,
                    ..
                } = &cell.setup.scenario;
                (
                    files_of_cell(path, arm, device, workpiece, &collision.obstacles),
                    simulation.seed,
                )
            }
            Self::Bench(rig) => {
                let BenchScenario {
                    path, device, seed, ..
                } = &rig.scenario;
                (vec![path, &device.model], *seed)
            }
        };
        source.provenance(&files, seed)
    }

    /// Runs it and writes its files. `progress` is given steps done and in all.
    pub(super) fn perform(
        &self,
        source: &Source,
        folder: &OutputFolder,
        run_options: RunOptions,
        watch: Option<&Watch>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<RunOutcome, AppError> {
        match self {
            Self::Cell(cell) => {
                perform_cell(self, cell, source, folder, (run_options, watch), progress)
            }
            Self::Bench(rig) => {
                perform_bench(self, rig, source, folder, (run_options, watch), progress)
            }
        }
    }
}

/// What the page of a run is made of, beside its recording.
pub(super) struct Parts {
    /// Its numbers.
    pub result: RunResult,
    /// It in space.
    pub scene: Scene,
    /// Its pictures.
    pub sketches: Sketches,
}

impl Parts {
    /// Those of a cell's run.
    pub(super) fn of_cell(
        cell: &Cell,
        finished: &FinishedCell,
        origin: RunOrigin,
    ) -> Result<Self, AppError> {
        let bounds = finished.bounds(cell)?;
        let course = edge_course(cell, &finished.recording)?;
        let worked = (finished.edge.as_ref()).map(|edge| FinishedEdge {
            course,
            ..finished_edge(cell, edge)
        });
        let scene = Scene {
            finished_edge: worked,
            ..scene_of(cell, &finished.recording, &finished.frames)?
        };
        let sketches = Sketches {
            lean: Some(across_the_edge(cell)),
            ..sketches(&scene, &finished.recording)
        };
        Ok(Self {
            result: RunResult::of_cell(cell, finished, bounds, origin),
            scene,
            sketches,
        })
    }

    /// Those of a bench's run.
    pub(super) fn of_bench(
        rig: &Rig,
        finished: &FinishedBench,
        origin: RunOrigin,
    ) -> Result<Self, AppError> {
        let bounds = finished.bounds(rig)?;
        let scene = bench_picture::scene_of(&rig.scenario, &finished.recording)?;
        Ok(Self {
            result: RunResult::of_bench(rig, finished, bounds, origin),
            sketches: sketches(&scene, &finished.recording),
            scene,
        })
    }

    /// What is said of it.
    pub(super) fn report<'a>(
        &'a self,
        recording: &'a Recording,
        profile: Option<&'a EdgeProfile>,
    ) -> RunReport<'a> {
        RunReport {
            result: &self.result,
            recording,
            sketches: &self.sketches,
            profile,
        }
    }
}

fn perform_cell(
    job: &Job,
    cell: &Cell,
    source: &Source,
    folder: &OutputFolder,
    (run_options, watch): (RunOptions, Option<&Watch>),
    progress: &mut dyn FnMut(usize, usize),
) -> Result<RunOutcome, AppError> {
    let (origin, content) = job.provenance(source)?;
    let target = folder.path().join(RECORDING);
    let options = RerunOptions {
        opening: run_options.opening,
        ..RerunOptions::default()
    };
    std::thread::scope(|scope| {
        let streaming = (run_options.recorded)
            .then(|| StreamingRecording::begin(scope, cell, &target, &content, options));
        let watching = watch.map(|watch| Listener::watching(cell, watch));
        let of_stream = streaming.iter().map(StreamingRecording::listener);
        let listeners = watching.into_iter().chain(of_stream).collect();
        let finished = run_observed(cell, progress, listeners)?;
        let parts = Parts::of_cell(cell, &finished, source.origin(origin))?;
        let report = parts.report(&finished.recording, finished.edge.as_ref());
        let report = report.document();
        let summary = markdown(&report);
        let scene = &parts.scene;
        let (page, encoded) = rayon::join(
            || html(&report),
            || streaming.map(|streaming| streaming.end(&finished.recording, scene, &summary)),
        );
        let encoded = encoded.transpose()?;
        let document = document(&parts.result)?;
        let names = folder.write(RunOutput {
            title: &parts.result.title,
            recording: &finished.recording,
            picture: encoded
                .map(|encoded| -> Picture<'_> { Box::new(move |path| encoded.write(path)) }),
            joints: run_options.with_bag.then(|| joint_names(cell)),
            summary: &document,
            edge_profile: finished.edge.as_ref().map(EdgeProfile::text).as_deref(),
            figures: None,
            varied: source.copy(),
            sketches: &parts.sketches,
            report: &page,
        })?;
        let table = text(&report, run_options.style);
        let finished = Finished::Cell(Box::new(finished));
        Ok(RunOutcome::new(
            finished,
            parts,
            (document, table),
            names,
            summary,
        ))
    })
}

fn perform_bench(
    job: &Job,
    rig: &Rig,
    source: &Source,
    folder: &OutputFolder,
    (run_options, watch): (RunOptions, Option<&Watch>),
    progress: &mut dyn FnMut(usize, usize),
) -> Result<RunOutcome, AppError> {
    let (origin, _) = job.provenance(source)?;
    let finished = bench::run_watched(rig, progress, watch)?;
    let scenario = &rig.scenario;
    let parts = Parts::of_bench(rig, &finished, source.origin(origin))?;
    let report = parts.report(&finished.recording, None);
    let report = report.document();
    let document = document(&parts.result)?;
    let options = RerunOptions {
        summary_markdown: markdown(&report),
        opening: run_options.opening,
        ..RerunOptions::default()
    };
    let picture = |path: &Path| write_rrd(path, &finished.recording, &parts.scene, &options);
    let names = folder.write(RunOutput {
        title: &scenario.title,
        recording: &finished.recording,
        picture: run_options.recorded.then_some(Box::new(picture)),
        joints: run_options.with_bag.then(Vec::new),
        summary: &document,
        edge_profile: None,
        figures: Some(&bench_figures::figures(scenario, &finished.recording)?),
        varied: source.copy(),
        sketches: &parts.sketches,
        report: &html(&report),
    })?;
    let table = text(&report, run_options.style);
    let summary = options.summary_markdown;
    let finished = Finished::Bench(Box::new(finished));
    Ok(RunOutcome::new(
        finished,
        parts,
        (document, table),
        names,
        summary,
    ))
}

impl RunOutcome {
    fn new(
        finished: Finished,
        parts: Parts,
        (document, table): (String, String),
        names: Vec<&'static str>,
        summary: String,
    ) -> Self {
        Self {
            finished,
            messages: messages(&parts.result),
            code: code(&parts.result),
            result: parts.result,
            document,
            table,
            names,
            shown: (parts.scene, summary),
        }
    }
}

/// Names of the arm's joints, base first.
fn joint_names(cell: &Cell) -> Vec<String> {
    let joints = &cell.setup.arm.chain.joints;
    joints.iter().map(|joint| joint.name.clone()).collect()
}

/// summary.json.
fn document(result: &RunResult) -> Result<String, AppError> {
    let text = serde_json::to_string_pretty(result)?;
    Ok(sealed(&text, RUN, BTreeMap::new()))
}

/// Exit code of a result.
pub(super) fn code(result: &RunResult) -> ExitCode {
    if result.stopped.is_some() {
        ExitCode::Stopped
    } else if result.is_within_bounds() {
        ExitCode::Done
    } else {
        ExitCode::OutsideBounds
    }
}

/// Messages on standard error: what stopped it, or which results lie outside their bounds, and drives at their limit.
fn messages(result: &RunResult) -> Vec<String> {
    let drives = drives(result).map(|drives| {
        format!(
            "drives at their limit: {drives} ([expect] drives_saturated_s = {{ max = .. }} sets how long they may be)"
        )
    });
    result.complaints().into_iter().chain(drives).collect()
}
