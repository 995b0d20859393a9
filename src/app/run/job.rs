//! What the program writes of a job.

use std::path::{Path, PathBuf};

use super::super::edge_course::edge_course;
use super::super::error::{AppError, ExitCode};
use super::super::files::{
    DRAWING, EDGE, EDGE_PROFILE, FIGURES, LEAN, OutputFolder, Picture, RECORDING, RunOutput,
    Sketches,
};
use super::super::picture::{across_the_edge, finished_edge, scene_of};
use super::super::report::page_of_run;
use super::super::streaming::StreamingRecording;
use super::super::viewer::Watch;
use super::super::{bench, bench_figures, bench_picture};
use super::cell_run::{Listener, SummaryDocument, run_observed};
use super::source::Source;
use crate::cell::Cell;
use crate::metrics::{BoundCheck, Summary};
use crate::recording::csv::EdgeProfile;
use crate::recording::provenance::Provenance;
use crate::report::{
    Style, bench_markdown, bench_text, drives as saturated_drives, markdown, text,
};
use crate::rig::Rig;
use crate::run::Job;
use crate::scenario::{BenchScenario, Scenario, files_of_cell};
use crate::scene::Scene;
use crate::scene::finished_edge::FinishedEdge;
use crate::viewer::{Opening, RerunOptions, write_rrd};

/// Settings of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct RunOptions {
    /// Whether recording.rrd is written.
    pub recorded: bool,
    /// First view of recording.rrd.
    pub opening: Opening,
    /// Style of the tables.
    pub style: Style,
}

/// A run that has ended, its files written.
pub(super) struct RunOutcome {
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
    pub(super) fn writes(&self, name: &str, recorded: bool) -> bool {
        match name {
            RECORDING => recorded,
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

    /// Runs it and writes its files. `progress` gets steps done and in all.
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
        let verdicts = finished.bounds(cell)?;
        let title = &cell.setup.scenario.title;
        let document = SummaryDocument::new(cell, &finished, &verdicts, source, &origin).text()?;
        let course = edge_course(cell, &finished.recording)?;
        let worked = (finished.edge.as_ref()).map(|edge| FinishedEdge {
            course,
            ..finished_edge(cell, edge)
        });
        let scene = Scene {
            finished_edge: worked,
            ..scene_of(cell, &finished.recording, &finished.frames)?
        };
        let summary = markdown(title, &finished.summary, &verdicts);
        let (report, encoded) = rayon::join(
            || {
                let sketches = Sketches {
                    lean: Some(across_the_edge(cell)),
                    ..Sketches::of(&scene, &finished.recording)
                };
                let page = page_of_run(
                    &document,
                    &finished.recording,
                    finished.edge.as_ref(),
                    &sketches,
                );
                page.map(|page| (page, sketches))
            },
            || streaming.map(|streaming| streaming.end(&finished.recording, &scene, &summary)),
        );
        let ((report, sketches), encoded) = (report?, encoded.transpose()?);
        let names = folder.write(RunOutput {
            title,
            recording: &finished.recording,
            picture: encoded
                .map(|encoded| -> Picture<'_> { Box::new(move |path| encoded.write(path)) }),
            summary: &document,
            edge_profile: finished.edge.as_ref().map(EdgeProfile::text).as_deref(),
            figures: None,
            varied: source.copy(),
            sketches: &sketches,
            report: &report,
        })?;
        let (code, mut messages) = exit_code(finished.stop.as_ref(), &verdicts);
        messages.extend(drives_at_their_limit(&finished.summary));
        Ok(RunOutcome {
            table: text(title, &finished.summary, &verdicts, run_options.style),
            document,
            names,
            messages,
            code,
            shown: (scene, summary),
        })
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
    let verdicts = finished.bounds(rig)?;
    let document = bench::document(scenario, &finished, &verdicts, source, &origin)?;
    let scene = bench_picture::scene_of(scenario, &finished.recording)?;
    let sketches = Sketches::of(&scene, &finished.recording);
    let report = page_of_run(&document, &finished.recording, None, &sketches)?;
    let options = RerunOptions {
        summary_markdown: bench_markdown(&scenario.title, &finished.summary, &verdicts),
        opening: run_options.opening,
        ..RerunOptions::default()
    };
    let picture = |path: &Path| write_rrd(path, &finished.recording, &scene, &options);
    let names = folder.write(RunOutput {
        title: &scenario.title,
        recording: &finished.recording,
        picture: run_options.recorded.then_some(Box::new(picture)),
        summary: &document,
        edge_profile: None,
        figures: Some(&bench_figures::figures(scenario, &finished.recording)?),
        varied: source.copy(),
        sketches: &sketches,
        report: &report,
    })?;
    let (code, messages) = exit_code(finished.stop.as_ref(), &verdicts);
    Ok(RunOutcome {
        table: bench_text(
            &scenario.title,
            &finished.summary,
            &verdicts,
            run_options.style,
        ),
        document,
        names,
        messages,
        code,
        shown: (scene, options.summary_markdown),
    })
}

/// Why a run stopped early, if it did, or else which results lie outside their bounds.
pub(super) fn exit_code(
    stop: Option<&impl std::fmt::Display>,
    verdicts: &[BoundCheck],
) -> (ExitCode, Vec<String>) {
    if let Some(stop) = stop {
        return (ExitCode::Stopped, vec![format!("stopped: {stop}")]);
    }
    let outside = verdicts.iter().filter(|verdict| !verdict.kept);
    let messages: Vec<String> = outside
        .map(|verdict| sentence(&verdict.name(), verdict.value, [verdict.min, verdict.max]))
        .collect();
    match messages.is_empty() {
        true => (ExitCode::Done, messages),
        false => (ExitCode::OutsideBounds, messages),
    }
}

/// Which drives were at their limit, when and for how long.
fn drives_at_their_limit(summary: &Summary) -> Option<String> {
    let drives = saturated_drives(summary)?;
    Some(format!(
        "drives at their limit: {drives} ([expect] drives_saturated_s = {{ max = .. }} sets how long they may be)"
    ))
}

/// A result that lies outside its bounds, from least to largest.
pub(super) fn sentence(metric: &str, value: Option<f64>, [min, max]: [Option<f64>; 2]) -> String {
    let bound = |word: &str, bound: Option<f64>| bound.map(|bound| format!("{word} {bound}"));
    let bounds = [bound("at least", min), bound("at most", max)];
    let bounds = bounds
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(" and ");
    let value = value.map_or("not determined by this run".to_owned(), |value| {
        format!("{value:.6}")
    });
    format!("outside its bounds: {metric} is {value}, expected {bounds}")
}
