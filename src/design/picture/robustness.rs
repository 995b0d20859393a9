//! The draws as a picture: how the objective and each limited quantity are distributed over them, with the limits.

use plotters::prelude::*;

use super::style::{
    Area, CHOSEN, DARK, Drawn, FONT, FRONT, GREY, GRID, LARGE, LIMIT, MARGIN, PX, TEXT, extent,
    limits_of, svg, tick, written,
};
use crate::design::error::DesignError;
use crate::design::limits::Side;
use crate::design::result::StudyResult;
use crate::design::robustness::Robustness;
use crate::quantity::display_name::axis;

/// Height of the title, and of a row of panels.
const HEAD: i32 = 92 * PX;
const ROW: i32 = 270 * PX;

/// The picture as SVG; none if nothing was drawn at the chosen design.
///
/// # Errors
/// The drawing library refuses.
pub fn robustness_svg(result: &StudyResult) -> Result<Option<String>, DesignError> {
    let Some(robustness) = &result.robustness else {
        return Ok(None);
    };
    let rows = robustness.quantiles.len().div_ceil(2).max(1) as i32;
    let height = HEAD + rows * ROW;
    svg(("the limits under disturbance", height), |root| {
        draw(root, result, robustness)
    })
    .map(Some)
}

fn draw(root: &Area<'_>, result: &StudyResult, robustness: &Robustness) -> Drawn {
    heading(root, result, robustness)?;
    let (_, panels) = root.split_vertically(HEAD);
    let rows = robustness.quantiles.len().div_ceil(2).max(1);
    for (place, area) in panels.split_evenly((rows, 2)).iter().enumerate() {
        if place < robustness.quantiles.len() {
            panel(area, result, robustness, place)?;
        }
    }
    Ok(())
}

fn heading(root: &Area<'_>, result: &StudyResult, robustness: &Robustness) -> Drawn {
    let title = result.title.replace(char::is_control, " ");
    root.draw(&Text::new(title, (40 * PX, 26 * PX), written(LARGE)))?;
    let share = &robustness.all_limits;
    let [low, high] = share.interval_percent;
    let words = format!(
        "{} of {} draws at the chosen design keep all limits: {:.0} %, with 95 % confidence {low:.0} to {high:.0} %",
        share.kept, robustness.runs, share.share_percent
    );
    root.draw(&Text::new(words, (40 * PX, 52 * PX), written(TEXT)))?;
    let y = 76 * PX;
    let legend = [
        (40, FRONT, "draw that keeps all limits"),
        (280, CHOSEN, "draw that breaks one"),
    ];
    for (x, colour, words) in legend {
        root.draw(&Circle::new((x * PX, y), 4 * PX, colour.filled()))?;
        root.draw(&Text::new(words, ((x + 12) * PX, y), written(TEXT)))?;
    }
    let line = [(490 * PX, y), (516 * PX, y)];
    root.draw(&PathElement::new(line, DARK.stroke_width(2 * PX as u32)))?;
    root.draw(&Text::new(
        "chosen design as it is",
        (524 * PX, y),
        written(TEXT),
    ))?;
    let corners = [(720 * PX, y - 7 * PX), (746 * PX, y + 7 * PX)];
    root.draw(&Rectangle::new(corners, LIMIT.mix(0.25).filled()))?;
    root.draw(&Text::new("beyond a limit", (754 * PX, y), written(TEXT)))
}

/// One quantity: the share of the draws that lies at or below each value.
fn panel(area: &Area<'_>, result: &StudyResult, robustness: &Robustness, place: usize) -> Drawn {
    let own = &robustness.quantiles[place];
    let mut values: Vec<(f64, bool)> = (robustness.draws.iter())
        .filter_map(|draw| Some((draw.metrics[place]?, draw.kept)))
        .collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let bounds: Vec<(f64, bool)> = limits_of(result, &own.metric)
        .map(|limit| (limit.bound, limit.side == Side::Max))
        .collect();
    let (low, high) = extent(values.iter().map(|v| v.0).chain([own.chosen]));
    // A bound that is far off would press all draws into one line.
    let near = |bound: f64| (bound - low).abs().min((bound - high).abs()) <= 2.0 * (high - low);
    let seen = bounds
        .iter()
        .map(|bound| bound.0)
        .filter(|bound| near(*bound));
    let (low, high) = extent([low, high].into_iter().chain(seen));
    // What no draw changes still needs an axis, with as few digits as it can have.
    let size = low.abs().max(high.abs());
    let least = if size > 0.0 { 0.5 * size } else { 1.0 };
    let spread = high - low;
    let margin = if spread > 0.0 { MARGIN * spread } else { least };
    let across = (low - margin, high + margin);
    let mut chart = ChartBuilder::on(area)
        .margin_top(8 * PX)
        .margin_right(24 * PX)
        .margin_bottom(6 * PX)
        .margin_left(6 * PX)
        .x_label_area_size(54 * PX)
        .y_label_area_size(70 * PX)
        .build_cartesian_2d(across.0..across.1, 0.0..100.0)?;
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(PX as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(GREY.stroke_width(PX as u32))
        .set_all_tick_mark_size(5 * PX)
        .x_labels(5)
        .y_labels(5)
        .label_style((FONT, TEXT).into_font().color(&DARK))
        .axis_desc_style((FONT, TEXT).into_font().color(&DARK))
        .x_desc(axis(&own.metric))
        .y_desc("draws at or below [%]")
        .x_label_formatter(&|value| tick(*value, across))
        .y_label_formatter(&|value| format!("{value:.0}"))
        .draw()?;
    for (bound, most) in bounds {
        let bound = bound.clamp(across.0, across.1);
        let ends = if most {
            (bound, across.1)
        } else {
            (across.0, bound)
        };
        let corners = [(ends.0, 0.0), (ends.1, 100.0)];
        chart.draw_series([Rectangle::new(corners, LIMIT.mix(0.25).filled())])?;
    }
    let chosen = vec![(own.chosen, 0.0), (own.chosen, 100.0)];
    chart.draw_series([PathElement::new(chosen, DARK.stroke_width(2 * PX as u32))])?;
    let all = robustness.runs as f64;
    let dots = values.iter().enumerate().map(|(rank, (value, kept))| {
        let colour = if *kept { FRONT } else { CHOSEN };
        let share = 100.0 * (rank + 1) as f64 / all;
        Circle::new((*value, share), 4 * PX, colour.filled())
    });
    chart.draw_series(dots)?;
    Ok(())
}
