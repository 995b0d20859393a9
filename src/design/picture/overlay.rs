//! The overlay of the data: limits with their words, the starting and the chosen design with their values.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::style::{
    Area, CHOSEN, CHOSEN_WORDS, Chart, DARK, Drawn, FONT, GREY, LIMIT, LIMIT_WORDS, PX, TEXT,
    inside, limits_of,
};
use crate::design::limits::Side;
use crate::design::result::{LimitState, StudyResult};
use crate::quantity::display_name::{raised, with_unit};

type Corners = [(i32, i32); 2];

/// A limit on an axis, in the picture's units.
pub(super) struct LimitLine {
    words: String,
    line: Corners,
    /// Corners of the region that it forbids.
    forbidden: Corners,
    /// Anchor of its words, and whether they end there.
    place: ((i32, i32), bool),
}

/// The limits on both axes that the picture shows.
pub(super) fn limits(
    chart: &Chart<'_, '_>,
    result: &StudyResult,
    trade_off: &str,
    ranges: [(f64, f64); 2],
) -> Vec<LimitLine> {
    let at = |x: f64, y: f64| chart.plotting_area().map_coordinate(&(x, y));
    let [across, up] = ranges;
    let ((left, bottom), (right, top)) = (at(across.0, up.0), at(across.1, up.1));
    let vertical = limits_of(result, trade_off).map(|limit| {
        let (x, _) = at(limit.bound, up.0);
        let at_most = limit.side == Side::Max;
        let forbidden = if at_most { right } else { left };
        let words = words_of(limit);
        // On the forbidden side, where no data are, if there is room.
        let room = (forbidden - x).abs() > width(&words) + 16 * PX;
        let ends = at_most != room;
        let gap = if ends { -8 * PX } else { 8 * PX };
        let line = LimitLine {
            words,
            line: [(x, top), (x, bottom)],
            forbidden: [(x.min(forbidden), top), (x.max(forbidden), bottom)],
            // Below the label of a start that lies beyond the picture.
            place: ((x + gap, top + 60 * PX), ends),
        };
        (limit, [limit.bound, up.0], line)
    });
    let horizontal = limits_of(result, &result.objectives.minimised).map(|limit| {
        let (_, y) = at(across.0, limit.bound);
        let at_most = limit.side == Side::Max;
        let forbidden = if at_most { top } else { bottom };
        let gap = if at_most { -14 * PX } else { 14 * PX };
        let line = LimitLine {
            words: words_of(limit),
            line: [(left, y), (right, y)],
            forbidden: [(left, y.min(forbidden)), (right, y.max(forbidden))],
            place: ((left + 10 * PX, y + gap), false),
        };
        (limit, [across.0, limit.bound], line)
    });
    let shown = vertical.chain(horizontal);
    let shown = shown.filter(|(_, point, _)| inside(*point, ranges));
    shown.map(|(_, _, line)| line).collect()
}

fn words_of(limit: &LimitState) -> String {
    let side = if limit.side == Side::Max {
        "at most"
    } else {
        "at least"
    };
    format!("limit: {side} {}", short_with_unit(&limit.key, limit.bound))
}

/// Estimated width of a text; the viewer's font decides.
fn width(text: &str) -> i32 {
    text.chars().count() as i32 * TEXT * 40 / 100
}

/// A tint over what the limits forbid, and where it is better to be.
pub(super) fn tints(chart: &Chart<'_, '_>, limits: &[LimitLine]) -> Drawn {
    let area = pixels(chart);
    for limit in limits {
        area.draw(&Rectangle::new(limit.forbidden, LIMIT.mix(0.08).filled()))?;
    }
    let (across, down) = chart.plotting_area().get_pixel_range();
    let place = (across.start + 10 * PX, down.end - 10 * PX);
    let style = (FONT, TEXT).into_font().color(&GREY);
    let style = style.pos(Pos::new(HPos::Left, VPos::Bottom));
    area.draw(&Text::new("\u{2199} better in both", place, style))
}

/// The limits' lines and words.
pub(super) fn words(chart: &Chart<'_, '_>, limits: &[LimitLine]) -> Drawn {
    let area = pixels(chart);
    for limit in limits {
        dashed(&area, limit.line)?;
        let (place, ends) = limit.place;
        label(
            &area,
            place,
            &limit.words,
            LIMIT_WORDS,
            (ends, FontStyle::Normal),
        )?;
    }
    Ok(())
}

/// The whole picture, in its own units.
fn pixels<'b>(chart: &Chart<'_, 'b>) -> Area<'b> {
    chart.plotting_area().strip_coord_spec().use_screen_coord()
}

fn dashed(area: &Area<'_>, [from, to]: Corners) -> Drawn {
    let length = (to.0 - from.0).abs().max((to.1 - from.1).abs());
    let at = |place: i32| {
        let share = f64::from(place.min(length)) / f64::from(length.max(1));
        let along = |a: i32, b: i32| a + (share * f64::from(b - a)).round() as i32;
        (along(from.0, to.0), along(from.1, to.1))
    };
    for start in (0..length).step_by(12 * PX as usize) {
        let dash = [at(start), at(start + 7 * PX)];
        area.draw(&PathElement::new(dash, LIMIT.stroke_width(2 * PX as u32)))?;
    }
    Ok(())
}

/// A diamond; hollow if the design breaks a limit.
pub(super) fn start_mark(root: &Area<'_>, (x, y): (i32, i32), feasible: bool) -> Drawn {
    let size = 8 * PX;
    let corners = vec![
        (x, y - size),
        (x + size, y),
        (x, y + size),
        (x - size, y),
        (x, y - size),
    ];
    let fill = if feasible { DARK } else { WHITE };
    root.draw(&Polygon::new(corners.clone(), fill.filled()))?;
    root.draw(&PathElement::new(corners, DARK.stroke_width(2 * PX as u32)))
}

/// The starting and the chosen design with their values. Nothing lies below the front, so there the chosen one's label is never on data.
pub(super) fn marks(chart: &Chart<'_, '_>, result: &StudyResult, ranges: [(f64, f64); 2]) -> Drawn {
    let area = pixels(chart);
    let [across, up] = ranges;
    let names = &result.objectives;
    let trade_off = names.trade_off.as_deref().unwrap_or_default();
    for (candidate, word) in [(&result.start, "start"), (&result.chosen, "chosen")] {
        let Some(x) = candidate.trade_off else {
            continue;
        };
        let shown = (
            x.clamp(across.0, across.1),
            candidate.objective.clamp(up.0, up.1),
        );
        let (x_shown, y_shown) = chart.plotting_area().map_coordinate(&shown);
        // What reaches beyond the plot is cut off.
        let (columns, rows) = chart.plotting_area().get_pixel_range();
        let edge = 10 * PX;
        let place = (
            x_shown.clamp(columns.start + edge, columns.end - edge),
            y_shown.clamp(rows.start + edge, rows.end - edge),
        );
        let mut text = format!(
            "{word}: {}, {}",
            short_with_unit(trade_off, x),
            short_with_unit(&names.minimised, candidate.objective)
        );
        if !inside([x, candidate.objective], ranges) {
            text += ", beyond this picture";
        }
        let right = x > 0.5 * (across.0 + across.1);
        if word == "start" {
            start_mark(&area, place, candidate.feasible)?;
            // Above it, unless that is where the picture ends.
            let above = candidate.objective < up.1 - 0.06 * (up.1 - up.0);
            beside(&area, place, &text, DARK, [right, above])?;
        } else {
            area.draw(&Circle::new(place, 7 * PX, CHOSEN.filled()))?;
            beside(&area, place, &text, CHOSEN_WORDS, [right, false])?;
        }
    }
    Ok(())
}

/// A bold label above or below a mark, ending or beginning there.
fn beside(
    area: &Area<'_>,
    (x, y): (i32, i32),
    text: &str,
    colour: RGBColor,
    [ends, above]: [bool; 2],
) -> Drawn {
    let middle = if above { y - 22 * PX } else { y + 22 * PX };
    label(area, (x, middle), text, colour, (ends, FontStyle::Bold))
}

/// A text on white, so that it can be read on data.
fn label(
    area: &Area<'_>,
    (x, middle): (i32, i32),
    text: &str,
    colour: RGBColor,
    (ends, style): (bool, FontStyle),
) -> Drawn {
    let width = width(text);
    let (anchor, [from, to]) = if ends {
        (HPos::Right, [x - width, x])
    } else {
        (HPos::Left, [x, x + width])
    };
    let corners = [
        (from - 3 * PX, middle - 9 * PX),
        (to + 3 * PX, middle + 9 * PX),
    ];
    area.draw(&Rectangle::new(corners, WHITE.mix(0.8).filled()))?;
    let style = (FONT, TEXT).into_font().style(style).color(&colour);
    let style = style.pos(Pos::new(anchor, VPos::Center));
    area.draw(&Text::new(text.to_owned(), (x, middle), style))
}

/// As [`with_unit`], to four significant digits.
fn short_with_unit(key: &str, value: f64) -> String {
    let shown = format!("{value:.3e}").parse().unwrap_or(value);
    raised(&with_unit(key, shown))
}
