//! A recording that is watched while it is made.
//!
//! The layout goes first, then bodies and samples as they come, and at the end what only the whole run tells: the colours of the edge path, the
//! finished edge and the summary. A live recording is for the eye; what is kept is the file.

use std::collections::BTreeSet;

use ::rerun::archetypes::{RecordingInfo, StateChange};
use ::rerun::external::re_uri::ProxyUri;
use ::rerun::log::TimeColumn;
use ::rerun::{EntityPath, StoreKind};

use super::fingerprint::fingerprint;
use super::finished_edge::{write_finished_edge, write_summary};
use super::layout::write_layout;
use super::options::{PHASES, RerunOptions, slug};
use super::plots::{Plot, Series, plots};
use super::rrd::{LiveWriter, RrdError, RrdWriter};
use super::timelines::Axes;
use super::{cell, signals};
use crate::recording::schema::{self, PlotGroup};
use crate::recording::{Recording, RecordingError};
use crate::scene::Scene;

/// Phases of a job, whose lane must know its colours before they come.
const PHASE_NAMES: [&str; 4] = ["approach", "engage", "follow", "retract"];
/// Upper end of the force plot while its peak is not known, as a share of the desired force.
const FORCE_TOP: f64 = 2.1;

/// Where a live recording goes.
pub enum LiveOutlet {
    /// To whoever reads.
    Writer(LiveWriter),
    /// To a viewer that listens at an address such as `rerun+http://127.0.0.1:9876/proxy`.
    Viewer(String),
}

/// A recording that is sent while it is made.
pub struct LiveRecording {
    rrd: RrdWriter,
    options: RerunOptions,
    phase: String,
    /// The plots' lines that had a value in the first part; where a plot has several, their number stays what it is.
    lines: BTreeSet<(&'static str, String)>,
    /// Path length at the last sample [m].
    path_length: f64,
    /// The last sample's place on the timelines.
    last: Vec<TimeColumn>,
}

impl LiveRecording {
    /// Checks that this is an address at which a viewer could listen. Gives its host and port.
    ///
    /// # Errors
    /// Says what is wrong with it.
    pub fn address(text: &str) -> Result<(String, u16), String> {
        let uri: ProxyUri = text.parse().map_err(|error| format!("{error}"))?;
        Ok((uri.origin.host.to_string(), uri.origin.port))
    }

    /// Begins with the first samples and frames of a run, at least one sample.
    ///
    /// # Errors
    /// The viewer does not take it, or the scene's parts do not fit together.
    pub fn begin(
        outlet: LiveOutlet,
        samples: &Recording,
        scene: &Scene,
        options: &RerunOptions,
    ) -> Result<Self, RecordingError> {
        scene.check()?;
        let mut plots = live_plots(samples, scene)?;
        let lines = known_lines(&plots);
        keep_lines(&mut plots, &lines);
        let number = fingerprint("", samples, scene, options);
        let id = format!("{}-live-{number:016x}", slug(&scene.title));
        let start = || -> Result<Self, RrdError> {
            let kind = StoreKind::Blueprint;
            let mut rrd = match outlet {
                LiveOutlet::Writer(writer) => RrdWriter::begin_stream(writer, kind, &id, number)?,
                LiveOutlet::Viewer(address) => {
                    let address = address.parse().map_err(|_| RrdError::Gone)?;
                    RrdWriter::begin_sending(address, kind, &id, number)?
                }
            };
            write_layout(&mut rrd, scene, &plots, samples, options)?;
            rrd.begin_store(StoreKind::Recording, &id)?;
            let info = RecordingInfo::new().with_name(format!("{}, live", scene.title));
            rrd.add_static(&EntityPath::properties().to_string(), &info)?;
            cell::write_bodies(&mut rrd, scene)?;
            cell::write_edge_path(&mut rrd, &scene.edge_path)?;
            for plot in &plots {
                signals::write_looks(&mut rrd, plot)?;
            }
            signals::write_phase_looks(&mut rrd, &PHASE_NAMES)?;
            Ok(Self {
                rrd,
                options: options.clone(),
                phase: String::new(),
                lines,
                path_length: 0.0,
                last: Vec::new(),
            })
        };
        let mut live = start().map_err(live_error)?;
        live.add(samples, scene)?;
        Ok(live)
    }

    /// Sends the samples and frames that have come since, at least one sample.
    ///
    /// # Errors
    /// The viewer does not take it.
    pub fn add(&mut self, samples: &Recording, scene: &Scene) -> Result<(), RecordingError> {
        let mut plots = live_plots(samples, scene)?;
        keep_lines(&mut plots, &self.lines);
        self.send(samples, scene, &plots).map_err(live_error)
    }

    fn send(&mut self, samples: &Recording, scene: &Scene, plots: &[Plot]) -> Result<(), RrdError> {
        cell::write_frames(&mut self.rrd, scene, self.path_length, &self.options)?;
        let axes = Axes::of(samples, self.path_length);
        for plot in plots {
            signals::write_signals(&mut self.rrd, plot, &axes)?;
            signals::write_guides(&mut self.rrd, plot, &axes)?;
        }
        for phase in samples.phases() {
            if phase.name != self.phase {
                self.phase.clone_from(&phase.name);
                let start = samples.samples_in(phase).start;
                let start = start.min(samples.sample_count() - 1);
                self.change_phase(axes.columns(&[start]))?;
            }
        }
        self.last = axes.columns(&[samples.sample_count() - 1]);
        if let Some(channel) = samples.channel(schema::PATH_LENGTH) {
            let known = channel.values.iter().rev().find(|length| !length.is_nan());
            self.path_length = known.copied().unwrap_or(self.path_length);
        }
        self.rrd.flush()
    }

    fn change_phase(&mut self, at: Vec<TimeColumn>) -> Result<(), RrdError> {
        let change = StateChange::new().with_state([self.phase.clone()]);
        self.rrd.add_row(PHASES, at, &change)
    }

    /// Sends what only the whole run tells.
    ///
    /// # Errors
    /// The viewer does not take it.
    pub fn end(mut self, scene: &Scene, summary_markdown: &str) -> Result<(), RecordingError> {
        let mut finish = || -> Result<(), RrdError> {
            cell::write_edge_path(&mut self.rrd, &scene.edge_path)?;
            write_finished_edge(&mut self.rrd, scene.finished_edge.as_ref(), None)?;
            write_summary(&mut self.rrd, summary_markdown, scene)?;
            if !self.phase.is_empty() {
                self.phase.clear();
                let end = self.last.clone();
                self.change_phase(end)?;
            }
            self.rrd.flush()
        };
        finish().map_err(live_error)?;
        self.rrd.finish().map(drop).map_err(live_error)
    }
}

/// The lines that have a value.
fn known_lines(plots: &[Plot]) -> BTreeSet<(&'static str, String)> {
    let lines = plots.iter().flat_map(|plot| {
        let drawn = |line: &&Series| line.values.iter().any(|value| value.is_finite());
        let lines = plot.series.iter().filter(drawn);
        lines.map(|line| (plot.entity, line.name.clone()))
    });
    lines.collect()
}

fn keep_lines(plots: &mut Vec<Plot>, lines: &BTreeSet<(&'static str, String)>) {
    for plot in plots.iter_mut() {
        let entity = plot.entity;
        plot.series
            .retain(|line| lines.contains(&(entity, line.name.clone())));
    }
    plots.retain(|plot| !plot.series.is_empty());
}

/// The plots of a part of a run, with ranges that do not depend on that part.
fn live_plots(samples: &Recording, scene: &Scene) -> Result<Vec<Plot>, RecordingError> {
    let mut plots = plots(samples, &scene.limits)?;
    for plot in &mut plots {
        match plot.group {
            PlotGroup::Force => {
                let desired = samples.channel(schema::DESIRED_FORCE);
                let desired = desired.map_or(f64::NAN, |channel| channel.values[0]);
                plot.range = (desired > 0.0).then_some([-0.05 * desired, FORCE_TOP * desired]);
            }
            PlotGroup::Pressure => plot.range = None,
            _ => (),
        }
    }
    Ok(plots)
}

fn live_error(error: RrdError) -> RecordingError {
    RecordingError::Live {
        cause: error.to_string(),
    }
}
