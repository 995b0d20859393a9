//! Signals of one recording: lines, lanes.

use ::rerun::Scalars;
use ::rerun::archetypes::{SeriesLines, StateChange, StateConfiguration};
use ::rerun::log::TimeColumn;

use super::super::colours::role_colour;
use crate::scene::board::{BoardRole, Lane, Sheet, SheetPlot};
use crate::viewer::colours::{VERMILLION, rerun_colour};
use crate::viewer::options::slug;
use crate::viewer::rrd::{RrdError, RrdWriter};
use crate::viewer::timelines::SIM_TIME;

/// Timeline of the recordings' times: that of all of our files.
pub(super) const TIME: &str = SIM_TIME;

/// Entity of a sheet.
pub(super) fn entity(sheet: usize) -> String {
    format!("/recording_{}", sheet + 1)
}

/// Entity of the lanes of a sheet.
pub(super) fn lanes_entity(sheet: &str) -> String {
    format!("{sheet}/parts_from_the_model")
}

/// Entity of a plot of a sheet.
pub(super) fn plot_entity(sheet: &str, plot: &SheetPlot) -> String {
    // Without its unit.
    let words = plot.title.split(" [").next().unwrap_or_default();
    format!("{sheet}/{}", slug(words))
}

/// Writes a sheet.
pub(super) fn write(rrd: &mut RrdWriter, entity: &str, sheet: &Sheet) -> Result<(), RrdError> {
    let Some((first, last)) = sheet.time.first().zip(sheet.time.last()) else {
        return Ok(());
    };
    let times = TimeColumn::new_duration_secs(TIME, sheet.time.iter().copied());
    let ends = TimeColumn::new_duration_secs(TIME, [*first, *last]);
    for plot in sheet.rows.iter().flatten() {
        let entity = plot_entity(entity, plot);
        write_lines(rrd, &entity, plot, &times)?;
        for (index, (label, value)) in plot.guides.iter().enumerate() {
            let entity = format!("{entity}/guide_{}", index + 1);
            let look = SeriesLines::new()
                .with_names([label.clone()])
                .with_colors([rerun_colour(role_colour(BoardRole::Guide))])
                .with_widths([1.2]);
            rrd.add_static(&entity, &look)?;
            let columns = Scalars::new([*value; 2]).columns_of_unit_batches()?;
            rrd.add_columns(&entity, vec![ends.clone()], columns)?;
        }
    }
    for lane in &sheet.lanes {
        let entity = format!("{}/{}", lanes_entity(entity), slug(&lane.name));
        write_lane(rrd, &entity, lane)?;
    }
    Ok(())
}

fn write_lines(
    rrd: &mut RrdWriter,
    entity: &str,
    plot: &SheetPlot,
    times: &TimeColumn,
) -> Result<(), RrdError> {
    let lines = &plot.lines;
    if lines.is_empty() {
        return Ok(());
    }
    // Lines that lie on one another are seen all the same: each is narrower than the one below it.
    let width = |role| match role {
        BoardRole::Measured => 4.0,
        BoardRole::Nominal => 2.2,
        BoardRole::Improved | BoardRole::Guide => 1.4,
    };
    let look = SeriesLines::new()
        .with_names(lines.iter().map(|line| line.label.clone()))
        .with_colors(lines.iter().map(|l| rerun_colour(role_colour(l.role))))
        .with_widths(lines.iter().map(|line| width(line.role)));
    rrd.add_static(entity, &look)?;
    let rows = times.times_raw().len();
    let row_by_row = (0..rows).flat_map(|row| lines.iter().map(move |line| line.values[row]));
    let columns = Scalars::new(row_by_row).columns(std::iter::repeat_n(lines.len(), rows))?;
    rrd.add_columns(entity, vec![times.clone()], columns)
}

/// A change at each start, and an end where no other state follows.
fn write_lane(rrd: &mut RrdWriter, entity: &str, lane: &Lane) -> Result<(), RrdError> {
    let mut changes: Vec<(f64, &str)> = Vec::new();
    for (index, (start, end, state)) in lane.spans.iter().enumerate() {
        changes.push((*start, state));
        let next = lane.spans.get(index + 1);
        if next.is_none_or(|(start, ..)| start > end) {
            changes.push((*end, ""));
        }
    }
    let mut states: Vec<&str> = lane.spans.iter().map(|(.., state)| &state[..]).collect();
    states.sort_unstable();
    states.dedup();
    let look = StateConfiguration::new()
        .with_colors(states.iter().map(|_| rerun_colour(VERMILLION)))
        .with_values(states);
    rrd.add_static(entity, &look)?;
    let times = TimeColumn::new_duration_secs(TIME, changes.iter().map(|(time, _)| *time));
    let names = StateChange::new().with_state(changes.iter().map(|(_, state)| *state));
    rrd.add_columns(entity, vec![times], names.columns_of_unit_batches()?)
}
