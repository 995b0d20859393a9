//! The layout of a figure, and the painting of its parts.

use std::collections::BTreeSet;

use plotters::style::{Color, RGBColor, ShapeStyle, WHITE};

use super::canvas::{self, Anchor, Canvas, Drawn, fitting, text_width};
use super::trace::{PX, Place, Scale, over_quantity, over_time};
use super::{Figure, FigureError, Horizontal, Panel, Role, Series, Stroke};

const WIDTH: i32 = 960 * PX;
/// Ends of the plots.
const LEFT: i32 = 80 * PX;
const RIGHT: i32 = 940 * PX;
const TITLE_HEIGHT: i32 = 40 * PX;
/// Height of a row of the legend or of marker labels.
const ROW: i32 = 21 * PX;
/// Length of a line in the legend, and the space behind an entry.
const KEY: i32 = 26 * PX;
const KEY_GAP: i32 = 24 * PX;
/// Between a text and what it belongs to.
const SPACE: i32 = 6 * PX;
const TICK: i32 = 4 * PX;
const LARGE: i32 = 18 * PX;
const NORMAL: i32 = 14 * PX;
const SMALL: i32 = 13 * PX;
const FRAME: RGBColor = RGBColor(0x55, 0x55, 0x55);
const EVENT: RGBColor = RGBColor(0x80, 0x80, 0x80);
const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

/// The place of a text: its left end, and its row.
#[derive(Clone, Copy)]
struct Spot {
    left: i32,
    row: i32,
}

/// A panel with everything in its place.
struct Layout<'a> {
    panel: &'a Panel<'a>,
    horizontal: Scale,
    vertical: Scale,
    /// Whether the horizontal axis has its labels here.
    labelled: bool,
    /// Of the legend entries, rows counted from above.
    keys: Vec<Spot>,
    /// Of the markers that have labels, rows counted from the plot upwards.
    labels: Vec<Option<Spot>>,
    /// Upper edge of the panel.
    above: i32,
    /// Edges of its plot.
    top: i32,
    bottom: i32,
}

/// The figure as an SVG document.
pub(super) fn document(figure: &Figure) -> Result<String, FigureError> {
    let layouts = layouts(figure)?;
    let height = layouts.last().map_or(TITLE_HEIGHT, Layout::below);
    let paint = |canvas: &Canvas| {
        let size = fitting(&figure.title, LARGE, WIDTH - 8 * SPACE);
        let middle = (WIDTH / 2, TITLE_HEIGHT / 2);
        canvas.text(&figure.title, middle, size, Anchor::Centre)?;
        layouts.iter().try_for_each(|layout| layout.paint(canvas))
    };
    canvas::document((WIDTH, height), paint).map_err(|reason| FigureError::Drawing {
        figure: figure.title.clone(),
        reason,
    })
}

fn layouts<'a>(figure: &'a Figure) -> Result<Vec<Layout<'a>>, FigureError> {
    let over_time = |panel: &&Panel| panel.horizontal == Horizontal::Time;
    let time = figure.panels.iter().filter(over_time);
    let time = Scale::new(time.flat_map(Panel::places), 0.0, 10.0);
    let mut above = if figure.title.is_empty() {
        SPACE
    } else {
        TITLE_HEIGHT
    };
    let mut layouts = Vec::new();
    for (index, panel) in figure.panels.iter().enumerate() {
        let (horizontal, height) = match panel.horizontal {
            Horizontal::Time => (time.clone(), 180 * PX),
            Horizontal::Quantity(_) => (Scale::new(panel.places(), 0.04, 10.0), 330 * PX),
        };
        let keys = key_spots(panel);
        let labels = label_spots(panel, &horizontal)?;
        let last_key = keys.last().map_or(0, |spot| spot.row + 1);
        let last_label = labels.iter().flatten().map(|spot| spot.row + 1).max();
        let headings = last_key.max(i32::from(!panel.title.is_empty()));
        let top = above + ROW * (headings + last_label.unwrap_or(0)) + TICK;
        let next = figure.panels.get(index + 1);
        layouts.push(Layout {
            vertical: Scale::new(panel.heights(), 0.06, 6.0),
            labelled: !(over_time(&panel) && next.is_some_and(|next| over_time(&next))),
            bottom: top + height,
            panel,
            horizontal,
            keys,
            labels,
            above,
            top,
        });
        above = layouts.last().map_or(0, Layout::below);
    }
    Ok(layouts)
}

/// Legend entries one after the other behind the panel's title, in as many rows as they take.
fn key_spots(panel: &Panel) -> Vec<Spot> {
    let title = match text_width(&panel.title, NORMAL) {
        0 => 0,
        // Bold is wider.
        width => width * 11 / 10 + KEY_GAP,
    };
    let (mut left, mut row) = (LEFT + title, 0);
    let mut spots = Vec::new();
    for (label, _) in panel.keys() {
        let width = KEY + SPACE + text_width(label, NORMAL);
        if left + width > RIGHT && left > LEFT {
            (left, row) = (LEFT, row + 1);
        }
        spots.push(Spot { left, row });
        left += width + KEY_GAP;
    }
    spots
}

/// Marker labels right of their lines, or left where the picture ends. From the last to the first
/// each goes into the lowest row in which it and its line meet no later label.
fn label_spots(panel: &Panel, horizontal: &Scale) -> Result<Vec<Option<Spot>>, FigureError> {
    let mut order: Vec<usize> = (0..panel.markers.len()).collect();
    order.sort_by(|&a, &b| panel.markers[b].at.total_cmp(&panel.markers[a].at));
    let mut spots = vec![None; order.len()];
    let mut taken: Vec<i32> = Vec::new();
    for index in order {
        let marker = &panel.markers[index];
        let (low, high) = (horizontal.low, horizontal.high);
        if !(low <= marker.at && marker.at <= high) {
            let reason = format!(
                "stands at {}, the axis goes from {low} to {high}",
                marker.at
            );
            return Err(panel.misfit("marker", &marker.label, reason));
        }
        if marker.label.is_empty() {
            continue;
        }
        let line = across(horizontal, marker.at);
        let width = text_width(&marker.label, SMALL) + 2 * SPACE;
        let left = if line + width <= WIDTH {
            line
        } else {
            line - width
        };
        let row = taken.iter().position(|&from| left + width <= from);
        let row = row.unwrap_or(taken.len());
        taken.resize(taken.len().max(row + 1), left);
        taken[..=row].fill(left);
        let row = row as i32;
        spots[index] = Some(Spot { left, row });
    }
    Ok(spots)
}

fn across(horizontal: &Scale, value: f64) -> i32 {
    LEFT + (horizontal.share(value) * f64::from(RIGHT - LEFT)).round() as i32
}

impl<'a> Panel<'a> {
    fn places(&self) -> impl Iterator<Item = f64> {
        let series = self.series.iter();
        series.flat_map(|series| series.horizontal.iter().copied())
    }

    fn heights(&self) -> impl Iterator<Item = f64> {
        let values = self
            .series
            .iter()
            .flat_map(|series| series.values.iter().copied());
        values.chain(self.bands.iter().flat_map(|band| [band.from, band.to]))
    }

    /// Texts of the legend, with their series or, for bands, none.
    fn keys(&self) -> impl Iterator<Item = (&str, Option<&Series<'a>>)> {
        let series = self
            .series
            .iter()
            .map(|series| (series.label.as_str(), Some(series)));
        let bands = self.bands.iter().map(|band| (band.label.as_str(), None));
        series.chain(bands).filter(|(label, _)| !label.is_empty())
    }
}

impl Layout<'_> {
    /// Lower edge of the panel.
    fn below(&self) -> i32 {
        self.bottom + if self.labelled { 56 * PX } else { 16 * PX }
    }

    fn up(&self, value: f64) -> i32 {
        let height = f64::from(self.bottom - self.top);
        self.bottom - (self.vertical.share(value) * height).round() as i32
    }

    fn paint(&self, canvas: &Canvas) -> Drawn {
        for band in &self.panel.bands {
            let corners = [(LEFT, self.up(band.to)), (RIGHT, self.up(band.from))];
            canvas.area(corners, Role::Band.colour().mix(0.25))?;
        }
        self.paint_axes(canvas)?;
        self.paint_markers(canvas)?;
        let place = |horizontal, value| (across(&self.horizontal, horizontal), self.up(value));
        for series in &self.panel.series {
            let lines = match self.panel.horizontal {
                Horizontal::Time => over_time(series, place),
                Horizontal::Quantity(_) => over_quantity(series, place),
            };
            series.paint(canvas, &lines, series.style())?;
        }
        self.paint_legend(canvas)
    }

    fn paint_axes(&self, canvas: &Canvas) -> Drawn {
        let (top, bottom) = (self.top, self.bottom);
        let [grid, frame] = [GRID, FRAME].map(|colour| colour.stroke_width(PX as u32));
        let label = match &self.panel.horizontal {
            Horizontal::Time => "time [s]",
            Horizontal::Quantity(label) => label,
        };
        for (tick, text) in self.horizontal.ticks() {
            let x = across(&self.horizontal, tick);
            canvas.line(&[(x, top), (x, bottom)], grid)?;
            canvas.line(&[(x, bottom), (x, bottom + TICK)], frame)?;
            if self.labelled {
                canvas.text(&text, (x, bottom + 14 * PX), NORMAL, Anchor::Centre)?;
            }
        }
        for (tick, text) in self.vertical.ticks() {
            let y = self.up(tick);
            canvas.line(&[(LEFT, y), (RIGHT, y)], grid)?;
            canvas.line(&[(LEFT - TICK, y), (LEFT, y)], frame)?;
            canvas.text(&text, (LEFT - 2 * TICK, y), NORMAL, Anchor::Right)?;
        }
        let corners = [
            (LEFT, top),
            (RIGHT, top),
            (RIGHT, bottom),
            (LEFT, bottom),
            (LEFT, top),
        ];
        canvas.line(&corners, frame)?;
        if self.labelled {
            let middle = ((LEFT + RIGHT) / 2, bottom + 34 * PX);
            canvas.text(label, middle, NORMAL, Anchor::Centre)?;
        }
        let label = &self.panel.vertical_label;
        let size = fitting(label, NORMAL, bottom - self.above);
        canvas.text(
            label,
            (2 * SPACE, (top + bottom) / 2),
            size,
            Anchor::Upwards,
        )
    }

    fn paint_markers(&self, canvas: &Canvas) -> Drawn {
        let placed = self.panel.markers.iter().zip(&self.labels);
        let middle = |spot: Spot| self.top - ROW * spot.row - ROW / 2;
        for (marker, spot) in placed.clone() {
            let x = across(&self.horizontal, marker.at);
            let end = spot.map_or(self.top, |spot| middle(spot) - 8 * PX);
            canvas.line(&[(x, end), (x, self.bottom)], EVENT.stroke_width(12))?;
        }
        for (marker, spot) in placed {
            let Some(spot) = *spot else { continue };
            let x = across(&self.horizontal, marker.at);
            let (y, left) = (middle(spot), spot.left + SPACE);
            if spot.left == x {
                canvas.text(&marker.label, (left, y), SMALL, Anchor::Left)?;
            } else {
                // Lines of earlier markers may pass here.
                canvas.area(
                    [(left, y - ROW / 2), (x - SPACE, y + ROW / 3)],
                    WHITE.mix(1.0),
                )?;
                canvas.text(&marker.label, (x - SPACE, y), SMALL, Anchor::Right)?;
            }
        }
        Ok(())
    }

    fn paint_legend(&self, canvas: &Canvas) -> Drawn {
        canvas.bold_text(&self.panel.title, (LEFT, self.above + ROW / 2), NORMAL)?;
        for ((label, series), spot) in self.panel.keys().zip(&self.keys) {
            let y = self.above + ROW * spot.row + ROW / 2;
            let (left, right) = (spot.left, spot.left + KEY);
            if let Some(series) = series {
                let line = match series.stroke {
                    Stroke::Points => vec![((left + right) / 2, y)],
                    _ => vec![(left, y), (right, y)],
                };
                // Thin lines are hard to tell apart alone.
                let style = series.style();
                let thick = style.stroke_width(style.stroke_width.max(18));
                series.paint(canvas, &[line], thick)?;
            } else {
                let corners = [(left, y - SPACE), (right, y + SPACE)];
                canvas.area(corners, Role::Band.colour().mix(0.25))?;
            }
            canvas.text(label, (right + SPACE, y), NORMAL, Anchor::Left)?;
        }
        Ok(())
    }
}

impl Series<'_> {
    fn style(&self) -> ShapeStyle {
        let (width, opacity) = match self.stroke {
            Stroke::Plain | Stroke::Dashed => (18, 1.0),
            Stroke::Raw => (10, 0.65),
            Stroke::Truth => (32, 1.0),
            Stroke::Points => (0, 0.8),
        };
        self.role.colour().mix(opacity).stroke_width(width)
    }

    fn paint(&self, canvas: &Canvas, lines: &[Vec<Place>], style: ShapeStyle) -> Drawn {
        if self.stroke == Stroke::Points {
            // Of points that hide one another one is enough.
            let mut seen = BTreeSet::new();
            let mut visible = |&&(x, y): &&Place| seen.insert((x / (2 * PX), y / (2 * PX)));
            let mut points = lines.iter().flatten().filter(&mut visible);
            return points.try_for_each(|&point| canvas.dot(point, 35, style));
        }
        lines.iter().try_for_each(|line| match line[..] {
            // As a line it would be invisible.
            [alone] => canvas.dot(alone, style.stroke_width.max(15), style),
            _ if self.stroke == Stroke::Dashed => canvas.dashed(line, style),
            _ => canvas.line(line, style),
        })
    }
}

impl Role {
    fn colour(self) -> RGBColor {
        match self {
            Self::Command => RGBColor(0x00, 0x00, 0x00),
            Self::Regulator | Self::Filtered => RGBColor(0x00, 0x72, 0xB2),
            Self::Chamber1 | Self::Force => RGBColor(0xD5, 0x5E, 0x00),
            Self::Chamber2 | Self::Stroke => RGBColor(0x00, 0x9E, 0x73),
            Self::Measured => RGBColor(0x56, 0xB4, 0xE9),
            Self::Estimate => RGBColor(0xCC, 0x79, 0xA7),
            Self::Band => RGBColor(0xE6, 0x9F, 0x00),
        }
    }
}
