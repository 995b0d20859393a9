//! Writes the signals: the plots' lines and the phases' lane.

use ::rerun::Scalars;
use ::rerun::archetypes::{SeriesLines, StateChange, StateConfiguration};

use super::colours::rerun_colour;
use super::options::PHASES;
use super::plots::{Plot, Series, phase_colour};
use super::rrd::{RrdError, RrdWriter};
use super::timelines::Axes;
use crate::recording::Recording;

/// Rows of a chunk of signals: as many as Rerun itself puts into one, and few enough to stay in the processor's cache while they are encoded.
pub(super) const CHUNK_ROWS: usize = 4096;

/// Writes how a plot's lines look.
pub(super) fn write_looks(rrd: &mut RrdWriter, plot: &Plot) -> Result<(), RrdError> {
    let signals: Vec<&Series> = plot.signals().collect();
    if !signals.is_empty() {
        rrd.add_static(plot.entity, &look(&signals))?;
    }
    for guide in plot.guides() {
        rrd.add_static(&guide_entity(plot, guide), &look(&[guide]))?;
    }
    Ok(())
}

fn look(series: &[&Series]) -> SeriesLines {
    SeriesLines::new()
        .with_names(series.iter().map(|series| series.label.clone()))
        .with_colors(series.iter().map(|series| rerun_colour(series.colour)))
        .with_widths(series.iter().map(|series| series.width))
}

/// Writes the signals of a plot together, so that their times are stored once.
pub(super) fn write_signals(rrd: &mut RrdWriter, plot: &Plot, axes: &Axes) -> Result<(), RrdError> {
    let signals: Vec<&[f64]> = plot.signals().map(|series| &series.values[..]).collect();
    let count = signals.first().map_or(0, |values| values.len());
    for start in (0..count).step_by(CHUNK_ROWS) {
        let rows = start..count.min(start + CHUNK_ROWS);
        let row_by_row = rows
            .clone()
            .flat_map(|row| signals.iter().map(move |values| values[row]));
        let scalars = Scalars::new(row_by_row);
        let columns = scalars.columns(std::iter::repeat_n(signals.len(), rows.len()))?;
        rrd.add_columns(plot.entity, axes.range(rows), columns)?;
    }
    Ok(())
}

/// Writes the guides of a plot.
pub(super) fn write_guides(rrd: &mut RrdWriter, plot: &Plot, axes: &Axes) -> Result<(), RrdError> {
    for guide in plot.guides() {
        let times = match guide.values.len() {
            2 => axes.ends(),
            _ => axes.all_columns(),
        };
        let scalars = Scalars::new(guide.values.iter().copied());
        let columns = scalars.columns_of_unit_batches()?;
        rrd.add_columns(&guide_entity(plot, guide), times, columns)?;
    }
    Ok(())
}

fn guide_entity(plot: &Plot, guide: &Series) -> String {
    format!("{}/{}", plot.entity, guide.name)
}

/// The phases as one lane: a change at each start, and an end where no other phase follows.
pub(super) fn write_phases(
    rrd: &mut RrdWriter,
    recording: &Recording,
    axes: &Axes,
) -> Result<(), RrdError> {
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
    write_phase_looks(rrd, &names)?;
    let changes = StateChange::new().with_state(states);
    let columns = changes.columns_of_unit_batches()?;
    rrd.add_columns(PHASES, axes.columns(&indices), columns)
}

/// Writes the colours of phases of these names, in the order in which they come.
pub(super) fn write_phase_looks(rrd: &mut RrdWriter, names: &[&str]) -> Result<(), RrdError> {
    let colours = names.iter().enumerate();
    let colours = colours.map(|(index, name)| rerun_colour(phase_colour(name, index)));
    let look = StateConfiguration::new()
        .with_values(names.iter().copied())
        .with_colors(colours);
    rrd.add_static(PHASES, &look)
}
