//! Recordings as Rerun files: `recording.rrd`.
//!
//! A file holds the cell in space (bodies, the edge path coloured by force error, the contact force
//! as an arrow), the signals as plots in their bands and limits, the phases as a coloured lane, a
//! summary, and the screen layout in which the viewer opens it all. Everything can be watched along
//! simulated time or along path length. Equal input gives equal bytes.

mod blueprint;
mod cell;
mod colours;
mod footer;
mod layout;
mod plots;
mod rrd;
mod shading;
mod timelines;
mod view_box;

use std::io::Write as _;
use std::path::Path;

use ::rerun::archetypes::{RecordingInfo, SeriesLines, StateChange, StateConfiguration};
use ::rerun::{EntityPath, Scalars, StoreKind, TextDocument};
use glam::DVec3;

use self::layout::LayoutInput;
use self::plots::{Plot, phase_colour};
use self::rrd::{RrdError, RrdWriter};
use self::timelines::Axes;
use super::atomic::write_atomic;
use super::scene::Scene;
use super::{Recording, RecordingError};

/// Entity of the phases' lane.
const PHASES: &str = "/phases";
/// Entity of the summary.
const SUMMARY: &str = "/summary";

/// How a recording is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct RerunOptions {
    /// Text of the summary panel, in Markdown; without it there is no such panel.
    pub summary_markdown: String,
    /// Length of the force arrow per force [m/N].
    pub arrow_metres_per_newton: f64,
    /// What the viewer does when it opens the file.
    pub opening: Opening,
    /// From the middle of what a 3D view shows towards the eye, in the world.
    pub eye_direction: DVec3,
}

/// What the viewer does when it opens a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Opening {
    /// It waits at the start.
    Paused,
    /// It plays up to the end of a span of simulated time, then that span in a loop. A short span
    /// at high speed holds the viewer at a moment, as for a picture.
    Playing {
        /// Start and end of the span [s].
        span: [f64; 2],
        /// Simulated seconds a second.
        speed: f64,
    },
}

impl Default for RerunOptions {
    fn default() -> Self {
        Self {
            summary_markdown: String::new(),
            arrow_metres_per_newton: 1e-3,
            opening: Opening::Paused,
            eye_direction: DVec3::new(0.75, -1.0, 0.55),
        }
    }
}

/// Writes a recording and its scene as a Rerun file that opens as a finished screen.
///
/// # Errors
/// [`RecordingError::Scene`] if the scene's parts do not fit together;
/// [`RecordingError::Write`] if the file cannot be written; nothing is left then.
pub fn write_rrd(
    path: &Path,
    recording: &Recording,
    scene: &Scene,
    options: &RerunOptions,
) -> Result<(), RecordingError> {
    scene.check()?;
    let plots = plots::plots(recording, &scene.limits)?;
    let fingerprint = fingerprint(recording, scene, options);
    let id = format!("{}-{fingerprint:016x}", slug(&scene.title));
    let encode = || -> Result<Vec<u8>, RrdError> {
        let mut rrd = RrdWriter::begin(StoreKind::Blueprint, &id, fingerprint)?;
        write_layout(&mut rrd, scene, &plots, recording, options)?;
        rrd.begin_store(StoreKind::Recording, &id)?;
        write_data(&mut rrd, recording, scene, &plots, options)?;
        rrd.finish()
    };
    let bytes = encode().map_err(|e| RecordingError::write(path, e))?;
    write_atomic(path, |file| file.write_all(&bytes))
}

fn write_layout(
    rrd: &mut RrdWriter,
    scene: &Scene,
    plots: &[Plot],
    recording: &Recording,
    options: &RerunOptions,
) -> Result<(), RrdError> {
    let screen = layout::screen(&LayoutInput {
        plots,
        cell: view_box::cell_box(scene),
        edge: view_box::ViewBox::around(scene.edge_path.points_in_world.iter().copied()),
        eye_direction: options.eye_direction,
        has_phases: !recording.phases().is_empty(),
        has_summary: !options.summary_markdown.is_empty(),
    });
    blueprint::write_blueprint(rrd, &screen, &layout::time_panel(options.opening))
}

fn write_data(
    rrd: &mut RrdWriter,
    recording: &Recording,
    scene: &Scene,
    plots: &[Plot],
    options: &RerunOptions,
) -> Result<(), RrdError> {
    let info = RecordingInfo::new().with_name(scene.title.clone());
    rrd.add_static(&EntityPath::properties().to_string(), &info)?;
    cell::write_cell(rrd, scene, options)?;
    let axes = Axes::of(recording);
    for plot in plots {
        write_plot(rrd, plot, &axes)?;
    }
    write_phases(rrd, recording, &axes)?;
    if !options.summary_markdown.is_empty() {
        let text = TextDocument::from_markdown(options.summary_markdown.clone());
        rrd.add_static(SUMMARY, &text)?;
    }
    Ok(())
}

fn write_plot(rrd: &mut RrdWriter, plot: &Plot, axes: &Axes) -> Result<(), RrdError> {
    for series in &plot.series {
        let entity = format!("{}/{}", plot.entity, series.name);
        let look = SeriesLines::new()
            .with_names([series.label.clone()])
            .with_colors([colours::rerun_colour(series.colour)])
            .with_widths([series.width]);
        rrd.add_static(&entity, &look)?;
        let scalars = Scalars::new(series.values.iter().copied());
        let columns = scalars.columns_of_unit_batches()?;
        rrd.add_columns(&entity, axes.columns(&series.indices), columns)?;
    }
    Ok(())
}

/// The phases as one lane: a change at each start, and an end where no other phase follows.
fn write_phases(rrd: &mut RrdWriter, recording: &Recording, axes: &Axes) -> Result<(), RrdError> {
    let phases = recording.phases();
    if phases.is_empty() {
        return Ok(());
    }
    let mut names: Vec<&str> = Vec::new();
    let mut states: Vec<&str> = Vec::new();
    let mut indices: Vec<usize> = Vec::new();
    let last = recording.sample_count() - 1;
    for (index, phase) in phases.iter().enumerate() {
        if !names.contains(&phase.name.as_str()) {
            names.push(&phase.name);
        }
        let samples = recording.samples_in(phase);
        states.push(&phase.name);
        indices.push(samples.start.min(last));
        let next = phases.get(index + 1);
        if next.is_none_or(|next| next.start > phase.end) {
            // An empty name ends the lane's bar.
            states.push("");
            indices.push(samples.end.min(last));
        }
    }
    let colours = names
        .iter()
        .enumerate()
        .map(|(index, name)| colours::rerun_colour(phase_colour(name, index)));
    let look = StateConfiguration::new()
        .with_values(names.iter().copied())
        .with_colors(colours);
    rrd.add_static(PHASES, &look)?;
    let changes = StateChange::new().with_state(states);
    let columns = changes.columns_of_unit_batches()?;
    rrd.add_columns(PHASES, axes.columns(&indices), columns)
}

/// Letters, digits and dashes of a title.
fn slug(title: &str) -> String {
    let keep = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    };
    title.chars().map(keep).collect()
}

/// A number that follows from the content (FNV-1a): two recordings open in one viewer are told
/// apart, the same recording written twice is the same.
fn fingerprint(recording: &Recording, scene: &Scene, options: &RerunOptions) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bytes: &[u8]| {
        for byte in bytes {
            hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    };
    add(scene.title.as_bytes());
    add(options.summary_markdown.as_bytes());
    let channels = recording.channels().iter();
    for values in channels
        .map(|channel| &channel.values[..])
        .chain([recording.time()])
    {
        for value in values {
            add(&value.to_bits().to_le_bytes());
        }
    }
    hash
}

#[cfg(test)]
mod tests;
