//! The trade-off front as a picture: every design that keeps the limits, the front, the starting and the chosen design, the limits.
//!
//! The drawing library counts in whole units; a unit is a tenth of a pixel here, so that the curves are smooth.

mod overlay;
mod robustness;
mod style;

use plotters::prelude::*;

use super::error::DesignError;
use super::result::{Candidate, StudyResult};
use crate::quantity::display_name::axis;
use style::{
    Area, CHOSEN, Chart, DARK, Drawn, FONT, FRONT, GREY, GRID, LARGE, MARGIN, PX, TEXT, extent,
    inside, limits_of, svg, tick, written,
};

pub use robustness::robustness_svg;

const HEIGHT: i32 = 620 * PX;
/// The start is drawn on the edge if it lies further from the front than this many times the front's extent.
const FAR: f64 = 3.0;

/// The picture as SVG; none if the study has no second objective.
///
/// # Errors
/// The drawing library refuses.
pub fn front_svg(result: &StudyResult) -> Result<Option<String>, DesignError> {
    let Some(trade_off) = &result.objectives.trade_off else {
        return Ok(None);
    };
    svg(("the trade-off", HEIGHT), |root| {
        draw(root, result, trade_off)
    })
    .map(Some)
}

fn draw(root: &Area<'_>, result: &StudyResult, trade_off: &str) -> Drawn {
    heading(root, result)?;
    let names = &result.objectives;
    let [across, up] = ranges(result, trade_off);
    let mut chart = ChartBuilder::on(root)
        .margin_top(96 * PX)
        .margin_right(28 * PX)
        .margin_bottom(8 * PX)
        .margin_left(6 * PX)
        .x_label_area_size(60 * PX)
        .y_label_area_size(84 * PX)
        .build_cartesian_2d(across.0..across.1, up.0..up.1)?;
    let label = |text: &str, over: Option<&str>| match over {
        Some(over) if names.scenarios > 1 => {
            format!("{}, {over} of {} scenarios", axis(text), names.scenarios)
        }
        _ => axis(text),
    };
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(PX as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(GREY.stroke_width(PX as u32))
        .set_all_tick_mark_size(5 * PX)
        .x_labels(8)
        .y_labels(8)
        .label_style((FONT, TEXT).into_font().color(&DARK))
        .axis_desc_style((FONT, TEXT).into_font().color(&DARK))
        .x_desc(label(trade_off, names.trade_off_over.as_deref()))
        .y_desc(label(&names.minimised, Some(&names.minimised_over)))
        .x_label_formatter(&|value| tick(*value, across))
        .y_label_formatter(&|value| tick(*value, up))
        .draw()?;
    let limits = overlay::limits(&chart, result, trade_off, [across, up]);
    overlay::tints(&chart, &limits)?;
    series(&mut chart, result, [across, up])?;
    overlay::words(&chart, &limits)?;
    overlay::marks(&chart, result, [across, up])
}

/// Title, and a legend in one row below it.
fn heading(root: &Area<'_>, result: &StudyResult) -> Drawn {
    let title = result.title.replace(char::is_control, " ");
    root.draw(&Text::new(title, (88 * PX, 28 * PX), written(LARGE)))?;
    let y = 62 * PX;
    let dot = |x: i32, radius: i32, fill: ShapeStyle| Circle::new((x, y), radius, fill);
    let mut x = 88 * PX;
    root.draw(&dot(x + 8 * PX, 3 * PX, GREY.mix(0.35).filled()))?;
    root.draw(&Text::new(
        "keeps the limits",
        (x + 20 * PX, y),
        written(TEXT),
    ))?;
    x += 160 * PX;
    let key = [(x, y), (x + 26 * PX, y)];
    root.draw(&PathElement::new(key, FRONT.stroke_width(2 * PX as u32)))?;
    root.draw(&dot(x + 13 * PX, 4 * PX, FRONT.filled()))?;
    root.draw(&Text::new(
        "front: none is better in both",
        (x + 34 * PX, y),
        written(TEXT),
    ))?;
    x += 262 * PX;
    root.draw(&dot(x + 8 * PX, 7 * PX, CHOSEN.filled()))?;
    root.draw(&Text::new("chosen", (x + 22 * PX, y), written(TEXT)))?;
    x += 98 * PX;
    overlay::start_mark(root, (x + 8 * PX, y), result.start.feasible)?;
    let start = if result.start.feasible {
        "start"
    } else {
        "start, breaks a limit"
    };
    root.draw(&Text::new(start, (x + 22 * PX, y), written(TEXT)))?;
    Ok(())
}

/// Range that must be seen: the front and the chosen design, the start unless it is far, and what limits both axes if that is near.
fn ranges(result: &StudyResult, trade_off: &str) -> [(f64, f64); 2] {
    let keys = [trade_off, result.objectives.minimised.as_str()];
    [0, 1].map(|axis| {
        let of = |candidate: &Candidate| [candidate.trade_off, Some(candidate.objective)][axis];
        let front = result
            .front
            .iter()
            .map(|point| [point.trade_off, point.objective][axis]);
        let (low, high) = extent(front.chain(of(&result.chosen)));
        let near = |value: f64, times: f64| {
            high <= low
                || (low - times * (high - low)..=high + times * (high - low)).contains(&value)
        };
        let start = of(&result.start).filter(|value| near(*value, FAR));
        let bounds = limits_of(result, keys[axis]).map(|limit| limit.bound);
        let bounds = bounds.filter(|bound| near(*bound, 0.5));
        let (low, high) = extent([low, high].into_iter().chain(start).chain(bounds));
        // A front that is one point still needs an axis.
        let least = 0.02 * low.abs().max(high.abs()).max(1e-9);
        let margin = MARGIN * (high - low).max(least);
        (low - margin, high + margin)
    })
}

fn series(chart: &mut Chart<'_, '_>, result: &StudyResult, ranges: [(f64, f64); 2]) -> Drawn {
    let others = result.others.iter().filter(|point| inside(**point, ranges));
    chart
        .draw_series(others.map(|p| Circle::new((p[0], p[1]), 3 * PX, GREY.mix(0.25).filled())))?;
    let front: Vec<(f64, f64)> = result
        .front
        .iter()
        .map(|p| (p.trade_off, p.objective))
        .collect();
    // Between two designs nothing was computed: the staircase is what is known to be reachable.
    let stairs: Vec<(f64, f64)> = front
        .iter()
        .enumerate()
        .flat_map(|(i, point)| match i.checked_sub(1) {
            Some(before) => vec![(point.0, front[before].1), *point],
            None => vec![*point],
        })
        .collect();
    chart.draw_series(std::iter::once(PathElement::new(
        stairs,
        FRONT.stroke_width(2 * PX as u32),
    )))?;
    chart.draw_series(
        front
            .iter()
            .map(|point| Circle::new(*point, 4 * PX, FRONT.filled())),
    )?;
    Ok(())
}
